#!/bin/bash
# The development loop: builds the changes and runs the tests that concern them, in less than two minutes on a
# built tree.
#
#   dev.sh unit [FILTER]      unit tests: all, or those of a GoogleTest filter
#   dev.sh sql [TEST...]      regression tests in a server of their own: all, or sql/TEST.sql
#   dev.sh format             formats all C++ with clang-format
#   dev.sh tidy [FILE...]     clang-tidy over C++ that differs from branch main, or over the files
#   dev.sh one NAME...        all tests of that name, or the file of that path: a regression or
#                             isolation test, a pgTAP or TAP file, a page of the documentation, a
#                             file of unit tests or of Python's; any other name is a part of
#                             a unit test's name, or a filter
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh
. scripts/suites.sh

usage() {
    sed -n 's/^#   \(dev.sh\)/usage: \1/p; s/^#    */       /p' "$0" >&2
    exit 2
}

unit() {
    build_unit_tests || fail "The unit tests do not compile."
    if (($#)); then unit_filter "$1"; else unit_tests build/release; fi
}

# A filter that matches no test is also an error.
unit_filter() {
    local tests=build/release/test/abacus_unit_tests listed
    listed=$("$tests" --gtest_filter="$1" --gtest_list_tests)
    [[ $listed == *$'\n  '* ]] || fail "No test is named $1."
    "$tests" --gtest_filter="$1" --gtest_brief=1
}

# The filter for all tests of a file.
filter_of_file() {
    grep -oP '^(TYPED_)?TEST(_F|_P)?\(\K\w+' "$1" | sort -u |
        sed 's/.*/&.*:*\/&.*:&\/*.*:*\/&\/*.*/' | paste -sd :
}

begin_server() {
    install_extension || fail "The extension does not compile."
    cluster_start dev
}

sql() {
    begin_server
    regression_tests "$@"
}

format() {
    git ls-files -z --cached --others --exclude-standard '*.cpp' '*.hpp' | xargs -0 clang-format -i
}

# Files that differ from where the branch left main; headers are checked in the files that include them.
changed_sources() {
    local from file
    from=$(git merge-base HEAD main 2>/dev/null || echo HEAD)
    {
        git diff --name-only --diff-filter=d "$from" -- '*.cpp' '*.hpp'
        git ls-files --others --exclude-standard '*.cpp' '*.hpp'
    } | while read -r file; do
        case $file in
        *.hpp) git grep -l "\"${file#*/}\"" -- '*.cpp' || true ;;
        *) echo "$file" ;;
        esac
    done | sort -u
}

tidy() {
    local files
    if ((!$#)); then
        mapfile -t files < <(changed_sources)
        set -- "${files[@]}"
    fi
    if (($#)); then tidy_check "$@"; fi
}

# The files for a name.
files_named() {
    local file
    if [[ -f $1 ]]; then
        echo "$1"
        return
    fi
    for file in "sql/$1.sql" "test/isolation/specs/$1.spec" "test/pgtap/$1.sql" "test/tap/$1.pl" \
        "docs/$1.md" "docs/cookbook/$1.md" "docs/reference/$1.md" "$1.md" "test/unit/${1%_test}_test.cpp" "test/suite/${1%_test}_test.py" \
        "test/oracle/${1%_test}_test.py" "test/viewer/$1.test.js"; do
        if [[ -f $file ]]; then echo "$file"; fi
    done
}

run_file() {
    local name=${1##*/}
    heading "$1"
    case $1 in
    sql/*.sql) regression_tests "${name%.*}" ;;
    test/isolation/*.spec) isolation_tests "${name%.*}" ;;
    test/pgtap/*.sql) pgtap_tests "$1" ;;
    test/tap/*.pl) tap_tests "$name" ;;
    *.md) documentation_examples "$1" ;;
    test/unit/*.cpp) unit "$(filter_of_file "$1")" ;;
    test/suite/*.py) report_tests "$name" ;;
    test/oracle/*.py)
        build_release oracle_constrained && oracle_tests "$name"
        ;;
    test/viewer/*.js) viewer_tests "${name%.test.js}" ;;
    *) fail "$1 is not a test." ;;
    esac
}

one() {
    local files file failed=0
    mapfile -t files < <(files_named "$1")
    if ((!${#files[@]})); then
        if [[ $1 == *[.*:]* ]]; then unit "$1"; else unit "*$1*"; fi
        return
    fi
    if [[ " ${files[*]}" == *@(.sql|.spec|.pl|.md|test/oracle/|test/viewer/)* && -z ${cluster_folder:-} ]]; then
        begin_server
        trap 'tap_end; cluster_stop' EXIT
    fi
    if [[ " ${files[*]}" == *.pl* && -z ${tap_folder:-} ]]; then tap_begin; fi
    for file in "${files[@]}"; do
        (run_file "$file") || failed=1
    done
    return "$failed"
}

case ${1:-} in
unit | sql | format | tidy) "$@" ;;
one)
    (($# > 1)) || usage
    shift
    status=0
    for name in "$@"; do one "$name" || status=1; done
    exit "$status"
    ;;
*) usage ;;
esac
