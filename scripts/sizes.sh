# Sourced by test.sh: which parts of the suites run in a size, from the table test/sizes and a seed.

# The table: the suites in its order, the size of each, and its turns.
size_suites=()
declare -A size_of=() turns_of=()
while read -r suite_name suite_size suite_turns; do
    if [[ -z $suite_name || $suite_name == \#* ]]; then continue; fi
    size_suites+=("$suite_name")
    size_of[$suite_name]=$suite_size turns_of[$suite_name]=$suite_turns
done <test/sizes

# The seed for all that takes turns: a number computed from the tree, unless ABACUS_SEED gives one.
tree_seed() {
    local tree=${ABACUS_SEED:-}
    if [[ -z $tree ]]; then
        tree=$({ git rev-parse 'HEAD^{tree}' && git diff HEAD; } 2>/dev/null | sha1sum | cut -c 1-7)
        tree=$((16#$tree))
    fi
    [[ $tree =~ ^(0|[1-9][0-9]{0,17})$ ]] || fail "ABACUS_SEED must be a whole number, not $tree."
    echo "$tree"
}

# Sets `turn` to the text after a prefix in the table: turn_of SUITE PREFIX, `4` for 1/ and 1/4; empty if
# there is none.
turn_of() {
    local word
    turn=
    for word in ${turns_of[$1]}; do
        if [[ $word == "$2"* ]]; then turn=${word#"$2"}; fi
    done
}

# The suites of a size; the seed chooses among those that take turns: suites_of SIZE SEED.
suites_of() {
    local size=$1 seed=$2 name other turn group members chosen=" "
    [[ $size == @(quick|usual|everything) ]] || fail "There is no size $size: choose quick, usual or everything."
    for name in "${size_suites[@]}"; do
        if [[ $size == quick && ${size_of[$name]} != quick ]]; then continue; fi
        if [[ $size == usual && ${size_of[$name]} == everything ]]; then continue; fi
        if [[ $size != everything ]]; then
            turn_of "$name" with:
            if [[ -n $turn && $chosen != *" $turn "* ]]; then continue; fi
            turn_of "$name" one:
            if [[ -n $turn ]]; then
                group=$turn members=()
                for other in "${size_suites[@]}"; do
                    turn_of "$other" one:
                    if [[ $turn == "$group" ]]; then members+=("$other"); fi
                done
                if [[ ${members[seed % ${#members[@]}]} != "$name" ]]; then continue; fi
            fi
        fi
        chosen+="$name "
        echo "$name"
    done
}

# share_of SUITE SEED: `K/N`, the part of it whose turn it is; empty for the whole suite. Each suite has a
# hash of its own, since otherwise the choice in a group would always coincide with the same part.
share_of() {
    local turn hash
    turn_of "$1" 1/
    if [[ -z $turn ]]; then return; fi
    hash=$(sha1sum <<<"$1 $2")
    echo "$((16#${hash:0:7} % turn))/$turn"
}
