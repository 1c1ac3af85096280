# PostgreSQL with Abacus: docker build -t abacus --build-arg POSTGRESQL=17 .
ARG POSTGRESQL=17

FROM postgres:${POSTGRESQL} AS build
ARG POSTGRESQL
RUN apt-get update && apt-get install -y --no-install-recommends \
    g++ make pkg-config libcairo2-dev libcgal-dev libgeos-dev libgmp-dev libmpfr-dev libpq-dev libxxhash-dev libprotozero-dev \
    "postgresql-server-dev-${POSTGRESQL}"
COPY . /abacus
RUN mkdir /build && cd /build && make -j"$(nproc)" -f /abacus/Makefile.pgxs && \
    make -f /abacus/Makefile.pgxs install DESTDIR=/installed

FROM postgres:${POSTGRESQL}
RUN apt-get update && apt-get install -y --no-install-recommends libcairo2 '^libgeos-c1(v5|t64)$' libgmp10 libmpfr6 libpq5 && \
    rm -rf /var/lib/apt/lists/*
COPY --from=build /installed /
