# Sourced by test.sh: what of the suites runs in a size, by the table test/sizes and a seed.

# The seed of all that takes turns: a number made of the tree as it is, unless ABACUS_SEED is one.
tree_seed() {
    local tree=${ABACUS_SEED:-}
    if [[ -z $tree ]]; then
        tree=$({ git rev-parse 'HEAD^{tree}' && git diff HEAD; } 2>/dev/null | sha1sum | cut -c 1-7)
        tree=$((16#$tree))
    fi
    echo "$tree"
}

# Rows of the table: sizes_rows SIZE, a suite and its turns a line.
sizes_rows() {
    local known=quick size=$1
    case $size in usual) known="quick usual" ;; everything) known="quick usual everything" ;; esac
    awk -v known=" $known " '!/^#/ && NF && index(known, " " $2 " ") {
        printf "%s", $1; for (i = 3; i <= NF; ++i) printf " %s", $i; print "" }' test/sizes
}

# turns_of SUITE PREFIX: what the table has behind it, `4` for 1/ and 1/4; nothing if nothing.
turns_of() {
    awk -v suite="$1" -v prefix="$2" '$1 == suite { for (i = 3; i <= NF; ++i)
        if (index($i, prefix) == 1) print substr($i, length(prefix) + 1) }' test/sizes
}

# The suites of a size, those that take turns chosen by the seed.
suites_of() {
    local size=$1 seed=$2 name turns group with members chosen=()
    while read -r name turns; do
        group=$(grep -oP '\bone:\K\w+' <<<"$turns")
        with=$(grep -oP '\bwith:\K\S+' <<<"$turns")
        if [[ $size == everything || -z $group$with ]]; then
            echo "$name"
        elif [[ -n $with ]]; then
            if [[ " ${chosen[*]} " == *" $with "* ]]; then echo "$name"; fi
        elif [[ " ${chosen[*]} " != *" $group "* ]]; then
            mapfile -t members < <(sizes_rows "$size" | awk -v group="one:$group" '{
                for (i = 2; i <= NF; ++i) if ($i == group) print $1 }')
            chosen+=("$group" "${members[seed % ${#members[@]}]}")
            echo "${chosen[-1]}"
        fi
    done < <(sizes_rows "$size")
}

# share_of SUITE SEED: `K/N`, the part of it that has its turn; nothing if all of it has.
share_of() {
    local parts
    parts=$(turns_of "$1" 1/)
    if [[ -n $parts ]]; then echo "$(($2 % parts))/$parts"; fi
}
