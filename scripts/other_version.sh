# Sourced by test.sh: the tests with another version of PostgreSQL, in a Debian that has it (chroot.sh).

# All that a server and the core concerns. Other suites need the programs of Debian 12.
version_suites="build-extension build unit unit-apart regress isolation pgtap tap acceptance"

# other_postgresql N [short|NAME...]: runs test.sh there. It brings along what is compiled and installed
# here: this server, for pg_upgrade from it, and in the short form the core.
other_postgresql() {
    local version=$1 build=$ABACUS_BUILD/chroot-$1/build packages=versions
    shift
    if [[ ${1:-} == short ]]; then packages=server; fi
    if ! scripts/chroot.sh "$version" scripts/install-dependencies.sh "$packages"; then
        echo "There is no Debian with PostgreSQL $version here: see above"
        exit 77
    fi
    if [[ -z ${ABACUS_BUILT:-} ]]; then
        scripts/install-dependencies.sh test && install_extension || fail "The extension does not compile."
    fi
    bring_server "$ABACUS_BUILD/chroot-$version/root" opt/old
    if [[ ${1:-} == short ]]; then
        bring_core "$build"
        set -- env ABACUS_SHORT=1 ABACUS_PACKAGES=$packages scripts/test.sh build-extension regress isolation pgtap tap acceptance
    else
        if [[ -e $build/brought ]]; then rm -r "$build"/{brought,extension,release}; fi
        # shellcheck disable=SC2086 # words
        if ((!$#)); then set -- $version_suites; fi
        set -- env ABACUS_WERROR= scripts/test.sh "$@" # newer compilers warn of other things in the core
    fi
    exec scripts/chroot.sh "$version" "$@"
}

# The core's object files and the oracle, as compiled here, for another build folder. They do not depend on
# PostgreSQL.
bring_core() {
    local oracle=release/test/oracle
    if [[ -z ${ABACUS_BUILT:-} ]]; then
        ABACUS_CORE_OBJECTS=$ABACUS_BUILD/extension build_release oracle_points oracle_compare ||
            fail "It does not compile."
    fi
    mkdir -p "$1/extension" "$1/$oracle"
    touch "$1/brought"
    (cd "$ABACUS_BUILD/extension" && find units \( -name '*.o' -o -name '*.cpp' \) -print0 |
        xargs -0 cp -p --parents -t "$1/extension")
    cp -p "$ABACUS_BUILD/$oracle"/oracle_{points,compare} "$1/$oracle"
}

# bring_server ROOT FOLDER: copies the server of this system, with its extensions and the libraries that the
# Debian in ROOT lacks, into a folder there that everyone can read. The server finds its files relative to its
# own place, so Debian's folders are kept. The query compiler is omitted, since its library is large.
bring_server() {
    local root=$1 folder=$1/$2 server=lib/postgresql/$ABACUS_POSTGRESQL share=share/postgresql/$ABACUS_POSTGRESQL
    local from library path
    from=$("$PG_CONFIG" --bindir)
    from=${from%"/$server/bin"}
    rm -rf "$folder"
    mkdir -p "$folder/libraries" "$folder/$server/lib" "$folder/$share"
    cp -r "$from/$server/bin" "$folder/$server"
    find "$from/$server/lib" -maxdepth 1 -name '*.so' -not -name 'llvmjit*' -exec cp -t "$folder/$server/lib" {} +
    cp -r "$from/$share/." "$folder/$share"
    chroot "$root" ldconfig -p | awk '{ print $1 }' >"$folder/known"
    ldd "$folder/$server"/bin/* "$folder/$server/lib/abacus.so" 2>/dev/null | awk '$3 ~ "^/" { print $1, $3 }' | sort -u |
        while read -r library path; do
            grep -qxF "$library" "$folder/known" || cp -L "$path" "$folder/libraries/$library"
        done
}
