// The faults that abacus_check finds, word for word, with one thread and with several.
#pragma once

#include "support/oracle.hpp"

#include <gtest/gtest.h>

namespace abacus::test {

/// The faults, with the keys of their pages.
template <int D> std::vector<std::string> faults_of(MeshOf<D> &mesh, std::size_t limit = 1000) {
    std::vector<std::string> faults;
    abacus_check *check = nullptr;
    const abacus_status status = abacus_check_open(mesh.host.table(), &mesh.header.facts,
                                                   mesh.cache_bytes, limit, &check, &mesh.error);
    if (status != ABACUS_OK)
        return {"status " + std::to_string(status) + ": " + mesh.error.message};
    abacus_fault fault;
    while (abacus_check_next(check, &fault) == ABACUS_OK)
        faults.push_back(std::to_string(fault.key.code) + " " + std::to_string(fault.key.part) +
                         " " + fault.kind + ": " + fault.message);
    abacus_check_close(check);
    return faults;
}

/// Expects the same faults with several threads, each with a tiny part.
template <int D> void expect_same_faults_by_threads(MeshOf<D> &mesh) {
    const auto alone = faults_of(mesh);
    for (const unsigned threads : {2, 3, 4, 7}) {
        mesh.host.set_threads(threads, true);
        EXPECT_EQ(faults_of(mesh), alone) << threads << " threads";
    }
    EXPECT_EQ(
        faults_of(mesh, 3),
        std::vector(alone.begin(), alone.begin() + std::min<std::ptrdiff_t>(3, std::ssize(alone))));
    mesh.host.set_threads(1, false);
}

} // namespace abacus::test
