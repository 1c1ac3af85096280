// Verification behind the C interface.
#include "query/check/check.hpp"
#include "octree/octree_check.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/check.h>

struct abacus_check {
    abacus_check(const abacus_host *table, const abacus_facts &facts, std::size_t cache_bytes,
                 std::size_t limit)
        : host(*table) {
        if (facts.form.type == ABACUS_OCTREE)
            octree.emplace(host, facts, limit);
        else
            mesh.emplace(host, facts, cache_bytes, limit);
    }
    template <class Visit> abacus_status visit(Visit visit) {
        return octree ? octree->visit(visit) : mesh->visit(visit);
    }

    const abacus::Host host;
    std::optional<abacus::ByDimension<abacus::Check>> mesh;
    std::optional<abacus::ByDimension<abacus::OctreeCheck>> octree;
};

abacus_status abacus_check_open(const abacus_host *host, const abacus_facts *facts,
                                size_t cache_bytes, size_t limit, abacus_check **check,
                                abacus_error *error) {
    return abacus::guard(error, [&] {
        *check = abacus::create_handle<abacus_check>(host, *facts, cache_bytes, limit);
        return ABACUS_OK;
    });
}

abacus_status abacus_check_next(abacus_check *check, abacus_fault *fault) {
    return check->visit([&](auto &faults) { return faults.next(*fault) ? ABACUS_OK : ABACUS_END; });
}

uint64_t abacus_check_fixed(const abacus_check *check, uint64_t *soft) {
    *soft = check->mesh ? check->mesh->visit([](const auto &mesh) { return mesh.soft(); }) : 0;
    return check->mesh ? check->mesh->visit([](const auto &mesh) { return mesh.fixed(); }) : 0;
}

uint64_t abacus_check_flat(const abacus_check *check) {
    return check->mesh ? check->mesh->visit([](const auto &mesh) { return mesh.flat(); }) : 0;
}

void abacus_check_close(abacus_check *check) { abacus::destroy_handle(check); }
