// The simplex behind a facet of the boundary, for those who meet the ghost alone.
//
// Of the finite simplices around a corner of the facet, exactly one has all its corners.
#pragma once

#include "attributes/attribute_key.hpp"
#include "query/reader.hpp"

namespace abacus {

template <int D> class BehindFacet {
public:
    BehindFacet(const Host &host, const abacus_header &header) : host_(host), header_(header) {}

    Owner<D, D + 1> of(const std::array<Point<D>, D> &facet) {
        if (!mesh_) mesh_.emplace(host_, header_, cache_bytes);
        std::optional<Owner<D, D + 1>> behind;
        mesh_->star(facet[0], [&](const abacus_simplex &simplex) {
            std::array<Point<D>, D + 1> points;
            for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, points[i].begin());
            const auto has = [&](const Point<D> &p) {
                return std::find(points.begin(), points.end(), p) != points.end();
            };
            if (std::all_of(facet.begin(), facet.end(), has)) behind = owner_of<D, D + 1>(points);
        });
        if (!behind) throw_corrupted("A facet of the boundary is one of no simplex.");
        return *behind;
    }

private:
    static constexpr std::size_t cache_bytes = std::size_t{1} << 20;

    const Host &host_;
    const abacus_header header_;
    std::optional<Reader<D>> mesh_; // once it is needed
};

} // namespace abacus
