cd /work/u/build/extension; CCACHE_DISABLE=1 make -k -s -f ../../Makefile.pgxs PG_CONFIG=/usr/lib/postgresql/15/bin/pg_config ABACUS_WERROR=1 "$@"
