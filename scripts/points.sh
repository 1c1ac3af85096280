# Sourced after cluster.sh by the scripts that build meshes from generated points.

# The columns of points of dimension $1: x, y and perhaps z.
coordinates() {
    case $1 in
    2) echo "x, y" ;;
    3) echo "x, y, z" ;;
    *) fail "no points of dimension $1" ;;
    esac
}

# Fills a fresh table `points` (id and coordinates, dimension $1) from file $2 in binary COPY format.
create_points() {
    local columns
    columns=$(coordinates "$1")
    run_psql -c "CREATE TABLE points (id bigint, ${columns//,/ float8,} float8)"
    run_psql -c "COPY points FROM STDIN (FORMAT binary)" <"$2"
}

# A cache size in MB: a number, or one of the server's: the smallest or largest possible (the largest is
# practically unlimited), or its default.
cache_size() {
    local column
    case $1 in
    smallest) column=min_val ;;
    largest) column=max_val ;;
    default) column=boot_val ;;
    *) echo "$1"; return ;;
    esac
    run_psql -A -t -c "LOAD 'abacus'" \
        -c "SELECT $column FROM pg_settings WHERE name = 'abacus.cache_size'"
}
