# What the scripts of this folder share: a folder of their own, packages, a server. Read by them.
tmp=$(mktemp -d)
trap 'stop_server; rm -rf "$tmp"' EXIT
server=
libraries=$tmp/usr/lib/$(uname -m)-linux-gnu
libraries=$libraries:$libraries/blas:$libraries/lapack:$tmp/lib/$(uname -m)-linux-gnu

# unpack NAME=VERSION...: these packages of Debian 12, and what they need that is not installed here, below $tmp.
# Nothing is installed. 77 says that the packages cannot be had here.
unpack() {
    local missing
    missing=$(apt-get -s --no-install-recommends --allow-downgrades install "$@" |
        awk -v "pinned=$*" '/^Inst/ && index(" " pinned, " " $2 "=") == 0 { print $2 }') || exit 77
    # shellcheck disable=SC2086  # the names are words
    (cd "$tmp" && apt-get -qq download "$@" $missing 2>errors || { cat errors >&2; exit 77; })
    for package in "$tmp"/*.deb; do
        dpkg -x "$package" "$tmp"
        rm "$package"
    done
}

# unpack_postgis [NAME=VERSION...]: PostgreSQL 15 with PostGIS 3.3.2, and these packages. An installation links the control files.
unpack_postgis() {
    unpack postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1 \
        postgresql-15-postgis-3=3.3.2+dfsg-1+b1 postgresql-15-postgis-3-scripts=3.3.2+dfsg-1 "$@"
    for control in "$tmp"/usr/share/postgresql/15/extension/*-3.control; do
        mv "$control" "${control%-3.control}.control"
    done
}

# unpack_gdal: GDAL 3.6.2, whose programs are in $tmp/usr/bin.
unpack_gdal() {
    unpack gdal-bin=3.6.2+dfsg-1+b2 libgdal32=3.6.2+dfsg-1+b2 gdal-data=3.6.2+dfsg-1
    unset CPL_DEBUG
    export GDAL_DATA=$tmp/usr/share/gdal LD_LIBRARY_PATH=$libraries
}

# unpack_grass: GRASS GIS 8.2.1, started by PATH=$tmp/usr/bin:$PATH grass.
unpack_grass() {
    unpack grass-core=8.2.1-1
    export GISBASE=$tmp/usr/lib/grass82 GRASS_PYTHON=/usr/bin/python3 HOME=$tmp
    export LD_LIBRARY_PATH=$GISBASE/lib:$libraries PROJ_DATA=$tmp/usr/share/proj GDAL_DATA=$tmp/usr/share/gdal
}

# unpack_r [NAME=VERSION...]: R 4.2.2 and these packages of it, for `run_r FILE`. R is told where it lies.
unpack_r() {
    unpack r-base-core=4.2.2.20221110-2 "$@"
    rm -r "$tmp/usr/lib/R/etc"
    cp -rL "$tmp/etc/R" "$tmp/usr/lib/R/etc"
    touch "$tmp/usr/lib/R/etc/Renviron"
    sed -i "s:/usr/lib/R:$tmp/usr/lib/R:; s:/usr/share/R:$tmp/usr/share/R:" "$tmp/usr/lib/R/bin/R"
}
run_r() {
    EDITOR=vi PAGER=cat R_HOME=$tmp/usr/lib/R LD_LIBRARY_PATH=$libraries:$tmp/usr/lib/R/lib \
        R_LIBS=$tmp/usr/lib/R/site-library:$tmp/usr/lib/R/library "$tmp/usr/lib/R/bin/R" --vanilla --no-echo -f "$1" 2>"$tmp/errors" |
        sed 's/ *$//'
}

# start_server: a server of the PostgreSQL 15 in $tmp, whose socket is there; no root may run it.
start_server() {
    PATH=$tmp/usr/lib/postgresql/15/bin:$PATH
    export PGHOST=$tmp PGDATA=$tmp/data PGUSER=owner LD_LIBRARY_PATH=$libraries
    as=()
    if ((EUID == 0)); then
        chown -R nobody "$tmp"
        as=(runuser -u nobody --)
    fi
    "${as[@]}" "$(command -v initdb)" -U owner -A trust -E UTF8 --locale=C --no-sync >"$tmp/initdb.log"
    server=started
    "${as[@]}" "$(command -v pg_ctl)" -s -w -l "$tmp/server.log" \
        -o "-k '$tmp' -c listen_addresses= -c fsync=off" start
}

# value EXPRESSION: what the server makes of it.
value() {
    psql -XqAtd postgres -c "SELECT $1"
}

stop_server() {
    [[ -z $server ]] || "${as[@]}" "$(command -v pg_ctl)" -s -m immediate stop || true
}

# expect WHAT EXPECTED FOUND: ends with 1 if the behaviour is another one.
expect() {
    if [[ $2 != "$3" ]]; then
        printf 'CHANGED: %s\n  it was: %s\n  it is:  %s\n' "$1" "$2" "$3" >&2
        exit 1
    fi
    printf '%s: %s\n' "$1" "$3"
}
