# Sourced: a private throw-away PostgreSQL cluster with default settings, that
# listens on a Unix socket only.
#
#   cluster_start NAME   a fresh one in build/cluster/NAME; exports PGHOST,
#                        PGUSER and PGDATABASE for psql and friends
#   cluster_stop         stops it; also done when the script ends
#   cluster_restart      for the children of that script: settings that need a new start
#
# PostgreSQL refuses to run as root, so root runs the server as user postgres. If that user cannot reach a
# checkout below /root, the cluster lies in a folder of /tmp, and build/cluster/NAME is a link to it. Clients
# run as the caller; the folder is closed to everyone else, so the socket needs no password. A lock keeps two
# runs from sharing a cluster.

cluster_as_server() {
    if ((EUID == 0)); then
        (cd / && runuser -u postgres -- "$@")
    else
        "$@"
    fi
}

cluster_start() {
    cluster_link=$ABACUS_BUILD/cluster/$1
    cluster_bin=$("$PG_CONFIG" --bindir)
    mkdir -p "$ABACUS_BUILD/cluster"
    exec 9>"$cluster_link.lock"
    flock -n 9 || fail "Another run uses $cluster_link; wait until it has ended."
    cluster_remove

    cluster_folder=$cluster_link
    # A socket's path has room for 107 bytes.
    if ((${#cluster_link} > 80)) ||
        ! cluster_as_server test -x "$ABACUS_BUILD/cluster" 2>/dev/null; then
        cluster_folder=$(mktemp -d /tmp/abacus-XXXXXX)
        ln -s "$cluster_folder" "$cluster_link"
    else
        mkdir "$cluster_folder"
    fi
    if ((EUID == 0)); then chown postgres: "$cluster_folder"; fi
    chmod 700 "$cluster_folder"
    trap cluster_stop EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM

    cluster_as_server "$cluster_bin/initdb" -D "$cluster_folder/data" -U postgres -A trust \
        -E UTF8 --locale=C.UTF-8 --no-instructions >/dev/null
    cluster_as_server "$cluster_bin/pg_ctl" start -s -w -D "$cluster_folder/data" \
        -l "$cluster_folder/log" \
        -o "-c listen_addresses='' -c unix_socket_directories='$cluster_folder'" \
        9>&-
    export PGHOST=$cluster_folder PGUSER=postgres PGDATABASE=postgres PGPORT=5432
    export PATH=$cluster_bin:$PATH
    unset PGSERVICE PGPASSWORD PGOPTIONS
}

cluster_stop() {
    local running=$cluster_folder/data/postmaster.pid
    if [[ -e $running ]]; then
        cluster_as_server "$cluster_bin/pg_ctl" stop -s -w -m fast -t 60 -D "$cluster_folder/data" ||
            cluster_as_server "$cluster_bin/pg_ctl" stop -s -w -m immediate -D "$cluster_folder/data"
    fi
    rm -rf "$cluster_folder/data"  # the log stays
}

cluster_restart() {
    cluster_as_server "$("$PG_CONFIG" --bindir)/pg_ctl" restart -s -w -t 600 -D "$PGHOST/data" \
        -l "$PGHOST/log"
}

# Removes what a killed run has left behind.
cluster_remove() {
    [[ -e $cluster_link || -L $cluster_link ]] || return 0
    cluster_folder=$(readlink -f "$cluster_link")
    if [[ -e $cluster_folder/data/postmaster.pid ]]; then
        cluster_as_server "$cluster_bin/pg_ctl" stop -s -w -m immediate \
            -D "$cluster_folder/data" || true
    fi
    rm -rf "$cluster_folder" "$cluster_link"
}

# psql as all scripts need it: stop at the first error, no start-up file.
run_psql() {
    psql -X -q -v ON_ERROR_STOP=1 "$@"
}
