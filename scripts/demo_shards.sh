#!/bin/bash
# One mesh over several servers: the shorelines, borders and rivers of the world over four clusters of this
# machine, each in a network namespace of its own if root may make some, so that what travels is counted. Then one
# query, one picture and one check over all of them. The picture is left in build/demo.
#
#   demo_shards.sh          14.35 million points
#   demo_shards.sh quick    a fifth of the resolution
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

resolution=f
case "$*" in
"") ;;
quick) resolution=h ;;
*) fail "usage: $0 [quick]" ;;
esac
shards=4
pictures=$ABACUS_BUILD/demo
prefix=abacus$$ # of the names of network namespaces and devices
network=10.231

value() { run_psql -A -t -c "$1"; }

# ---- Clusters ---------------------------------------------------------------------------------------------

# Whether each cluster can have a network namespace.
make_networks() {
    local i
    ((EUID == 0)) && command -v ip >/dev/null || return 1
    for ((i = 1; i <= shards; i++)); do
        ip netns add "$prefix-$i" 2>/dev/null &&
            ip link add "${prefix}v$i" type veth peer name inside netns "$prefix-$i" 2>/dev/null &&
            ip addr add "$network.$i.1/30" dev "${prefix}v$i" && ip link set "${prefix}v$i" up &&
            ip -n "$prefix-$i" addr add "$network.$i.2/30" dev inside && ip -n "$prefix-$i" link set inside up &&
            ip -n "$prefix-$i" link set lo up || return 1
    done
}

remove_networks() {
    local i
    for ((i = 1; i <= shards; i++)); do
        ip link del "${prefix}v$i" 2>/dev/null || true
        ip netns del "$prefix-$i" 2>/dev/null || true
    done
}

in_network() {
    local i=$1
    shift
    if [[ -n $has_networks ]]; then ip netns exec "$prefix-$i" "$@"; else "$@"; fi
}

start_shard() {
    local i=$1 data=$cluster_folder/shard$1
    cluster_as_server "$cluster_bin/initdb" -D "$data" -U postgres -A trust -E UTF8 --locale=C.UTF-8 --no-instructions >/dev/null
    echo "host all all $network.0.0/16 trust" | cluster_as_server tee -a "$data/pg_hba.conf" >/dev/null
    (cd / && in_network "$i" "${as_server[@]}" "$cluster_bin/pg_ctl" start -s -w -D "$data" -l "$data.log" \
        -o "-c listen_addresses='${hosts[i]}' -c port=${ports[i]} -c unix_socket_directories='' -c max_wal_size=4GB" 9>&-)
}

stop_all() {
    local i
    for ((i = 1; i <= shards; i++)); do
        if [[ -e $cluster_folder/shard$i/postmaster.pid ]]; then
            cluster_as_server "$cluster_bin/pg_ctl" stop -s -w -m immediate -D "$cluster_folder/shard$i" || true
        fi
        rm -rf "$cluster_folder/shard$i"
    done
    if [[ -n $has_networks ]]; then remove_networks; fi
    cluster_stop
}

# ---- What travels -----------------------------------------------------------------------------------------

# Bytes to and from each server so far.
traffic() {
    local i
    for ((i = 1; i <= shards; i++)); do
        cat "/sys/class/net/${prefix}v$i/statistics/tx_bytes" "/sys/class/net/${prefix}v$i/statistics/rx_bytes"
    done | paste -sd ' '
}

# counted LABEL COMMAND...: runs it, and says how long it took and what travelled.
counted() {
    local label=$1 start before=() after=() i to=0 from=0
    shift
    start=$(date +%s.%N)
    if [[ -n $has_networks ]]; then read -ra before <<<"$(traffic)"; fi
    "$@"
    if [[ -n $has_networks ]]; then
        read -ra after <<<"$(traffic)"
        for ((i = 0; i < shards; i++)); do
            ((to += after[2 * i] - before[2 * i], from += after[2 * i + 1] - before[2 * i + 1])) || true
        done
        summary+=("$(awk -v l="$label" -v a="$start" -v b="$(date +%s.%N)" -v t=$to -v f=$from \
            'BEGIN {printf "%-44s %8.2f s %10.1f kB to servers %10.1f kB from them", l, b - a, t / 1000, f / 1000}')")
    else
        summary+=("$(awk -v l="$label" -v a="$start" -v b="$(date +%s.%N)" 'BEGIN {printf "%-44s %8.2f s", l, b - a}')")
    fi
}

load_points() {
    run_psql -c "CREATE TABLE points (id bigint, lon float8, lat float8)"
    scripts/gshhg_points.py "$resolution" | run_psql -c "COPY points FROM STDIN (FORMAT binary)"
}

# Builds in one session while another one shows how far it is.
build() {
    local client line
    run_psql -c "CALL abacus_shard_build('shorelines', 'SELECT id, lon, lat FROM points')" &
    client=$!
    while kill -0 "$client" 2>/dev/null; do
        line=$(value "SELECT format('  %-13s %9s of %-9s%s', phase, done, coalesce(total::text, '?'), '  round ' || rounds)
                      FROM abacus_progress WHERE mesh = 'shorelines'::regclass")
        if [[ -n $line ]]; then echo "$line"; fi
        sleep 1
    done
    wait "$client"
}

draw() {
    value "SELECT encode(abacus_draw('shorelines', width => 1200), 'base64')" | base64 -d >"$pictures/shards.png"
    echo "  build/demo/shards.png  $(stat -c %s "$pictures/shards.png") bytes"
}

check() {
    local faults
    faults=$(value "SELECT count(*) FROM abacus_check('shorelines')")
    echo "  $faults faults"
    ((faults == 0))
}

# ---- The demonstration ------------------------------------------------------------------------------------

scripts/install-dependencies.sh demo
heading "Building and installing the extension"
install_extension
mkdir -p "$pictures"
summary=() hosts=() ports=() as_server=() has_networks=1
if ((EUID == 0)); then as_server=(runuser -u postgres --); fi
cluster_start demo_shards
trap stop_all EXIT
if ! make_networks; then
    remove_networks 2>/dev/null || true
    has_networks=
    echo "  Network namespaces cannot be made here: the clusters use ports of this machine, and what travels is not counted."
fi
heading "A coordinator and $shards clusters"
run_psql -c "CREATE EXTENSION abacus" -c "CREATE EXTENSION postgres_fdw"
for ((i = 1; i <= shards; i++)); do
    if [[ -n $has_networks ]]; then
        hosts[i]=$network.$i.2 ports[i]=5432
    else
        hosts[i]=127.0.0.1 ports[i]=$((20000 + $$ % 10000 + i))
    fi
    start_shard "$i"
    psql -X -q -h "${hosts[i]}" -p "${ports[i]}" -U postgres -d postgres -c "CREATE EXTENSION abacus"
    run_psql -c "CREATE SERVER shard$i FOREIGN DATA WRAPPER postgres_fdw
                 OPTIONS (host '${hosts[i]}', port '${ports[i]}', dbname 'postgres')" \
        -c "CREATE USER MAPPING FOR CURRENT_USER SERVER shard$i OPTIONS (user 'postgres')"
    echo "  shard$i: ${hosts[i]}, port ${ports[i]}"
done

heading "The shorelines of the world"
load_points
run_psql -c "SELECT abacus_shard_create('shorelines', '{shard1,shard2,shard3,shard4}')"
counted "$(value "SELECT count(*) FROM points") points over $shards servers" build
value "SELECT format('  %s points, %s vertices sent in %s rounds, %s triangles', points, sent, rounds, simplices) FROM shorelines"
counted "what each server has" run_psql -c \
    "SELECT shard, server, state, points, guests, pg_size_pretty(bytes) AS size FROM abacus_shards('shorelines')"

heading "One query: which triangle holds the harbour of Bergen?"
counted "one place" run_psql -c "SELECT * FROM abacus_locate('shorelines', 5.3185, 60.3990)"
counted "a thousand places" run_psql -c "SELECT count(*) AS located FROM abacus_locate('shorelines',
    'SELECT id, lon + 0.001, lat + 0.001 FROM points WHERE id % 1000 = 0 LIMIT 1000')"

heading "One picture of the world"
counted "one picture" draw

heading "One check over all servers"
counted "one check" check

heading "Times, and what travelled"
printf '%s\n' "${summary[@]}"
