#!/bin/bash
# The core and its unit tests, compiled for arm64 by a cross compiler, and run by an emulator, in a
# Debian that has arm64's libraries (chroot.sh). Takes about an hour on two cores, so CI leaves it out.
#
#   arm64_test.sh [FILTER]      all unit tests, or those of a GoogleTest filter
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/suites.sh

if [[ ${ABACUS_CHROOT:-} != arm64 ]]; then # not in there yet
    exec scripts/chroot.sh arm64 scripts/arm64_test.sh "$@"
fi

packages=(cmake make pkg-config g++-aarch64-linux-gnu qemu-user libxxhash-dev:arm64 libprotozero-dev libcgal-dev
    {libgmp,libmpfr,libcairo2,libgtest,libgmock,libpng}-dev:arm64)
if ! dpkg-query -W "${packages[@]}" >/dev/null 2>&1; then
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -q
    apt-get install -q -y --no-install-recommends "${packages[@]}"
fi
export PKG_CONFIG_LIBDIR=/usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig
cmake -S . -B build/arm64 -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DABACUS_WERROR=ON \
    -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ \
    -DCMAKE_LIBRARY_ARCHITECTURE=aarch64-linux-gnu -DABACUS_BENCH=OFF -DCMAKE_CXX_FLAGS=-Wno-psabi \
    -DCMAKE_CROSSCOMPILING_EMULATOR=qemu-aarch64 >/dev/null
cmake --build build/arm64 -j "$ABACUS_JOBS" --target abacus_unit_tests
if (($#)); then
    qemu-aarch64 build/arm64/test/abacus_unit_tests --gtest_filter="$1" --gtest_brief=1
else
    unit_tests build/arm64
fi
