// Octrees as triangles or tetrahedra, behind the C interface.
#include "octree/octree_simplices.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"

#include <abacus/octree.h>

struct abacus_octree_simplices {
    abacus_octree_simplices(const abacus_host *table, const abacus_facts &facts, std::size_t memory)
        : host(*table), simplices(host, facts, memory) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::OctreeSimplices> simplices;
};

abacus_status abacus_octree_simplices_open(const abacus_host *host, const abacus_facts *facts,
                                           size_t memory, abacus_octree_simplices **simplices,
                                           abacus_error *error) {
    return abacus::guard(error, [&] {
        *simplices = abacus::create_handle<abacus_octree_simplices>(host, *facts, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_simplices_next(abacus_octree_simplices *simplices, uint64_t *element,
                                           uint64_t *nodes, abacus_error *error) {
    return abacus::guard(error, [&] {
        return simplices->simplices.visit([&]<int D>(abacus::OctreeSimplices<D> &all) {
            std::array<std::uint64_t, D + 1> corners;
            if (!all.next(*element, corners)) return ABACUS_END;
            std::copy(corners.begin(), corners.end(), nodes);
            return ABACUS_OK;
        });
    });
}

void abacus_octree_simplices_close(abacus_octree_simplices *simplices) {
    abacus::destroy_handle(simplices);
}
