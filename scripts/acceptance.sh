#!/bin/bash
# Are meshes equal to CGAL's triangulation, simplex by simplex, whatever the
# input, its order and the size of the cache? Goes through SQL from end to end:
# points with COPY into a table, abacus_triangulate, abacus_check, simplices
# with COPY out, oracle_compare.
#
#   acceptance.sh [quick|full|threads|goose|shards] [2d|3d] [DATA SET...]
#
# quick takes two or three minutes, full (up to 14 M points a set) two hours; threads builds the sets of full
# with 2, 3, 4 and 7 threads, in 40 minutes; goose does the same with abacus_goose and few points, in a
# minute; shards builds the sets of quick, and shorelines, over 1, 2, 4 and 7 databases, in some minutes. 2d and 3d choose a dimension, names choose data sets; without any, all are compared.
# ABACUS_SHARE=K/N runs every Nth run of each set, different ones in each set.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh
. scripts/points.sh

usage="usage: $0 [quick|full|threads|goose|shards] [2d|3d] [DATA SET...]"
mode=${1:-quick}
shift $(($# > 0))
# dimension:data set:points, and cache (MB or a word for cache_size):order.
case $mode in
quick | shards)
    sets=(2:uniform:100000 2:grid:100000 2:circle:20000 2:rounded_circle:20000 2:wheel:20000
        2:lines:50000 2:flat_but_one:20000 2:clusters:100000 2:exponents:5000
        2:duplicates:100000 2:octree:50000
        3:uniform:20000 3:grid:15625 3:sphere:5000 3:rounded_sphere:5000 3:wheel:5001
        3:skew_lines:500 3:flat:5000 3:flat_but_one:5000 3:clusters:10000 3:exponents:500
        3:duplicates:50000 3:octree:10000 3:quake:10000)
    runs=(smallest:made default:shuffled largest:sorted smallest:reversed smallest:grown
        smallest:threads)
    if [[ $mode == shards ]]; then
        sets+=(2:shorelines:0 2:one_line:20000 2:one_shard:50000 3:one_line:5000 3:one_shard:10000)
        runs=(default:1shards default:2shards smallest:4shards default:7shards default:4shuffled default:4threaded)
    fi
    ;;
full | threads)
    sets=(2:uniform:1000000 2:grid:4000000 2:circle:100000 2:rounded_circle:100000
        2:wheel:100000 2:lines:1000000 2:flat_but_one:100000 2:clusters:1000000
        2:exponents:20000 2:duplicates:1000000 2:octree:1000000 2:shorelines:0
        2:curves:1000000 2:uniform:10000000
        3:uniform:1000000 3:quake:1000000 3:grid:1000000 3:sphere:50000 3:rounded_sphere:50000
        3:wheel:50001 3:skew_lines:2000 3:flat:50000 3:flat_but_one:50000 3:clusters:200000
        3:exponents:5000 3:duplicates:1000000 3:octree:1000000 3:curves:200000)
    runs=(smallest:made 8:made 64:made largest:made default:shuffled smallest:sorted 8:reversed
        8:grown smallest:threads default:threads)
    if [[ $mode == threads ]]; then runs=(smallest:threads default:2threads 8:3threads 64:4threads); fi
    ;;
goose)
    sets=(2:uniform:5000 2:grid:4900 2:circle:300 2:rounded_circle:300 2:wheel:301 2:lines:2000
        2:flat_but_one:300 2:clusters:3000 2:exponents:1000 2:duplicates:5000 2:octree:3000
        3:uniform:1000 3:grid:729 3:sphere:150 3:rounded_sphere:150 3:wheel:151 3:skew_lines:40
        3:flat:1000 3:flat_but_one:200 3:clusters:500 3:exponents:100 3:duplicates:2000
        3:octree:500 3:quake:1000)
    runs=(default:goose)
    ;;
*) fail "$usage" ;;
esac

# Keeps in `sets` only those that the words on the command line choose.
choose_sets() {
    local word dimensions=" " names=" " set dimension name chosen=()
    for word in "$@"; do
        case $word in
        2d | 3d) dimensions+="${word%d} " ;;
        *) names+="$word " ;;
        esac
    done
    for set in "${sets[@]}"; do
        IFS=: read -r dimension name _ <<<"$set"
        if [[ $dimensions == " " || $dimensions == *" $dimension "* ]] &&
            [[ $names == " " || $names == *" $name "* ]]; then
            chosen+=("$set")
        fi
    done
    ((${#chosen[@]})) || fail "No such data set. $usage"
    sets=("${chosen[@]}")
}
choose_sets "$@"

folder=$ABACUS_BUILD/acceptance-$mode
oracle=$ABACUS_BUILD/release/test/oracle
compared=0 differing=0

# Makes databases, each with a shard; they are reached over the socket.
most_shards=7
make_servers() {
    local i
    run_psql -c "CREATE EXTENSION postgres_fdw"
    for ((i = 1; i <= most_shards; i++)); do
        run_psql -c "CREATE DATABASE shard$i"
        run_psql -d "shard$i" -c "CREATE EXTENSION abacus"
        run_psql -c "CREATE SERVER shard$i FOREIGN DATA WRAPPER postgres_fdw
                     OPTIONS (host '$PGHOST', port '$PGPORT', dbname 'shard$i')" \
            -c "CREATE USER MAPPING FOR CURRENT_USER SERVER shard$i OPTIONS (user '$PGUSER')"
    done
}

# The mesh over $1 databases; `Nthreaded`: each with many threads, of which each has a tiny part.
build_over() {
    local i servers=() threads=1 tiny=off
    if [[ $2 == *threaded ]]; then threads=3 tiny=on; fi
    for ((i = 1; i <= $1; i++)); do
        servers+=("shard$i")
        run_psql -c "ALTER DATABASE shard$i SET abacus.threads = $threads" \
            -c "ALTER DATABASE shard$i SET abacus.tiny_intervals = $tiny" \
            -c "ALTER DATABASE shard$i SET abacus.cache_size = '${cache}MB'"
    done
    run_psql -o /dev/null -c "SET client_min_messages = warning" \
        -c "SELECT abacus_shard_create('mesh', '{$(IFS=, && echo "${servers[*]}")}', $dimension)" \
        -c "CALL abacus_shard_build('mesh', '$query')"
}

# Builds the mesh of the table points, with its rows in order $1; `grown`: all points except the last one
# first, and that one in a second step; `Nthreads`: with N threads; `threads`: with many, each with a tiny
# part; `Nshards`, `Nshuffled`, `Nthreaded`: over N databases; `goose`: with abacus_goose.
build_mesh() {
    local query="SELECT id, $columns FROM points" grow=() settings=()
    case $1 in
    made) ;;
    ?shards | ?shuffled | ?threaded)
        if [[ $1 == *shuffled ]]; then query+=" ORDER BY hashint8(id), id"; fi
        build_over "${1:0:1}" "$1" "$query"
        return
        ;;
    goose)
        run_psql -o /dev/null -c "SELECT abacus_goose('mesh', '$query', dimension => $dimension)"
        return
        ;;
    shuffled) query+=" ORDER BY hashint8(id), id" ;;
    sorted) query+=" ORDER BY $columns, id" ;;
    reversed) query+=" ORDER BY ${columns//,/ DESC,} DESC, id" ;;
    grown)
        grow=(-c "SELECT abacus_stage('mesh', '$query WHERE id = $count')"
            -c "SELECT abacus_triangulate('mesh')")
        query+=" WHERE id < $count"
        ;;
    ?threads) settings=(-c "SET abacus.threads = ${1%threads}") ;;
    threads) settings=(-c "SET abacus.threads = 7" -c "SET abacus.tiny_intervals = on") ;;
    esac
    run_psql -o /dev/null "${settings[@]}" -c "SET abacus.cache_size = '${cache}MB'" \
        -c "SELECT abacus_triangulate('mesh', '$query', dimension => $dimension)" "${grow[@]}"
}

# One mesh of the table points: faults of abacus_check, then the comparison.
compare() {
    local cache=$1 order=$2 corners="v0, v1, v2" first_ids=0 faults result start built checked
    local faults_of="abacus_check('mesh') LIMIT 3" simplices="abacus_simplices('mesh')"
    local drop="DROP TABLE mesh, mesh_vertices"
    if [[ $order == goose ]]; then
        faults_of="mesh WHERE v$dimension IS NULL"
        simplices="(SELECT 0::bigint AS code, * FROM mesh) AS m"
        drop="DROP TABLE mesh"
    elif [[ $mode == shards ]]; then
        drop="SELECT abacus_shard_drop('mesh')"
    fi
    if ((dimension == 3)); then corners+=", v3"; fi
    # Equal points are one vertex, with the id of the first one; in these orders that is the first in the file.
    case $order in made | grown | *threads | *shards | *threaded | goose) first_ids=1 ;; esac
    start=${EPOCHREALTIME/./}
    build_mesh "$order"
    built=${EPOCHREALTIME/./}
    faults=$(run_psql -A -t -c "SELECT * FROM $faults_of")
    checked=${EPOCHREALTIME/./}
    result=$(run_psql -c "COPY (SELECT code, $corners FROM $simplices)
                          TO STDOUT (FORMAT binary)" |
        ABACUS_ORACLE_FIRST_IDS=$first_ids \
            "$oracle/oracle_compare" "$dimension" "$folder/points.copy" - "$folder/kept") || true
    run_psql -o /dev/null -c "$drop"
    compared=$((compared + 1))
    printf '%dD %-15s cache %8s MB  %-8s  built in %6d ms, checked in %6d ms  %s\n' "$dimension" \
        "$name" "$cache" "$order" $(((built - start) / 1000)) $(((checked - built) / 1000)) \
        "${result##*$'\n'}"
    if [[ ${result##*$'\n'} != equal:* || -n $faults ]]; then
        differing=$((differing + 1))
        printf '%s\n%s\n' "$result" "$faults"
    fi
}

if [[ ! -x $oracle/oracle_compare ]] || [[ -z ${ABACUS_BUILT:-} ]]; then
    scripts/install-dependencies.sh test
    build_release oracle_points oracle_compare
    install_extension
fi
cluster_start "acceptance-$mode"
run_psql -c "CREATE EXTENSION abacus" -c "CREATE EXTENSION abacus_lab" -c "CREATE EXTENSION cube"
mkdir -p "$folder"
if [[ $mode == shards ]]; then make_servers; fi

# Two sets of this mode: all points on one line; all but one in a small part of the domain.
shard_points() {
    local third=
    if (($1 == 3)); then third=", $([[ $2 == one_line ]] && echo "5 * (i % 1000)" || echo "1 + (i * 0.4142135623730951) % 1 / 1e6")::float8"; fi
    if [[ $2 == one_line ]]; then
        run_psql -c "COPY (SELECT i::bigint, (i % 1000)::float8, (3 * (i % 1000))::float8$third FROM generate_series(1, $3) AS i) TO STDOUT (FORMAT binary)"
    else
        run_psql -c "COPY (SELECT i::bigint, CASE i WHEN 1 THEN 0 ELSE 1 + (i * 0.7548776662466927) % 1 / 1e6 END::float8,
                     CASE i WHEN 1 THEN 0 ELSE 1 + (i * 0.5698402909980532) % 1 / 1e6 END::float8$third FROM generate_series(1, $3) AS i) TO STDOUT (FORMAT binary)"
    fi
}

for set in "${sets[@]}"; do
    IFS=: read -r dimension name size <<<"$set"
    columns=$(coordinates "$dimension")
    rm -f "$folder/kept"
    if [[ $name == shorelines ]]; then
        scripts/gshhg_points.py "$([[ $mode == shards ]] && echo h || echo f)" >"$folder/points.copy"
    elif [[ $name == one_* ]]; then
        shard_points "$dimension" "$name" "$size" >"$folder/points.copy"
    else
        "$oracle/oracle_points" "$dimension" "$name" "$size" copy >"$folder/points.copy"
    fi
    create_points "$dimension" "$folder/points.copy"
    count=$(run_psql -A -t -c "SELECT max(id) FROM points")
    sets_done=$((${sets_done:--1} + 1))
    for number in "${!runs[@]}"; do
        if [[ -n ${ABACUS_SHARE:-} ]] && (((number + sets_done) % ${ABACUS_SHARE#*/} != ${ABACUS_SHARE%/*})); then continue; fi
        run=${runs[number]}
        compare "$(cache_size "${run%:*}")" "${run#*:}"
    done
    run_psql -c "DROP TABLE points"
done
rm -rf "$folder"
printf '%d meshes compared with CGAL, %d differ\n' "$compared" "$differing"
((compared && differing == 0))
