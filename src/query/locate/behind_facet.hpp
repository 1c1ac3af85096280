// Finds the simplex behind a facet of the boundary, for callers that have only the ghost.
//
// Exactly one of the finite simplices around a corner of the facet has all its corners: on the
// other side of a fault they have other ids.
#pragma once

#include "attributes/attribute_key.hpp"
#include "query/locate/reader.hpp"

namespace abacus {

template <int D> class BehindFacet {
public:
    BehindFacet(const Host &host, const abacus_facts &facts) : host_(host), facts_(facts) {}

    Owner<D, D + 1> of(const std::array<Point<D>, D> &facet,
                       const std::array<std::int64_t, D> &ids) {
        if (!mesh_) mesh_.emplace(host_, facts_, cache_bytes);
        std::optional<Owner<D, D + 1>> behind;
        mesh_->star(facet[0], [&](const abacus_simplex &simplex) {
            std::array<Point<D>, D + 1> points;
            for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, points[i].begin());
            int found = 0;
            for (int i = 0; i < D; ++i)
                for (int k = 0; k <= D; ++k)
                    found += points[k] == facet[i] && simplex.id[k] == ids[i];
            if (found == D) behind = owner_of<D, D + 1>(points);
        });
        if (!behind) throw_corrupted("A facet of the boundary belongs to no simplex.");
        return *behind;
    }

private:
    static constexpr std::size_t cache_bytes = std::size_t{1} << 20;

    const Host &host_;
    const abacus_facts facts_;
    std::optional<Reader<D>> mesh_; // once it is needed
};

} // namespace abacus
