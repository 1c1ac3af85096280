// The rim of a cavity that is known as a set of rows, without links: the facets that only
// one of them has.
//
// Rows are related only by the places of their corners. So corners are sorted by place
// and numbered, and facets are sorted by the numbers of their corners. A facet between
// two rows comes twice.
#pragma once

#include "geometry/point.hpp"
#include "host/arena.hpp"
#include "mesh/simplex.hpp"

#include <abacus/simplex.h>
#include <algorithm>
#include <span>

namespace abacus {

template <int D> class RimOfRows {
public:
    struct Facet {
        std::array<std::uint32_t, D> number; // of its corners, ascending
        std::uint32_t row;
        int facet;
    };

    explicit RimOfRows(const Host &host) : corners_(host), numbers_(host), facets_(host) {}

    /// The facets of these rows that belong to one of them alone.
    std::span<const Facet> find(std::span<const abacus_simplex *const> rows) {
        number_corners(rows);
        list_facets(rows.size());
        std::size_t kept = 0;
        for (std::size_t i = 0; i < facets_.size();) {
            std::size_t next = i + 1;
            while (next < facets_.size() && facets_[next].number == facets_[i].number) ++next;
            if (next - i > 2) throw_no_triangulation();
            if (next - i == 1) facets_[kept++] = facets_[i];
            i = next;
        }
        return {facets_.data(), kept};
    }

    static constexpr std::uint32_t at_infinity = 0; // number of the point there

private:
    struct Corner {
        Point<D> point;
        std::uint32_t at; // row * (D + 1) + corner
    };

    /// Numbers the corners by place.
    void number_corners(std::span<const abacus_simplex *const> rows) {
        corners_.clear();
        numbers_.resize(rows.size() * (D + 1));
        std::uint32_t at = 0;
        for (const abacus_simplex *row : rows)
            for (int i = 0; i <= D; ++i, ++at) {
                numbers_[at] = at_infinity;
                if (row->ghost && i == D) continue;
                Corner &corner = *corners_.extend(1);
                std::copy_n(row->corner[i], D, corner.point.begin());
                corner.at = at;
            }
        std::sort(corners_.begin(), corners_.end(), [](const Corner &a, const Corner &b) {
            return lexicographically_less<D>(a.point, b.point);
        });
        std::uint32_t number = at_infinity;
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            if (i == 0 || corners_[i].point != corners_[i - 1].point) ++number;
            numbers_[corners_[i].at] = number;
        }
    }

    void list_facets(std::size_t rows) {
        facets_.clear();
        for (std::uint32_t row = 0; row < rows; ++row)
            for (int i = 0; i <= D; ++i) {
                Facet &facet = *facets_.extend(1);
                const FacetVertices<D, std::uint32_t> sorted(numbers_.data() + row * (D + 1), i);
                facet = {sorted.vertex, row, i};
            }
        std::sort(facets_.begin(), facets_.end(),
                  [](const Facet &a, const Facet &b) { return a.number < b.number; });
    }

    Arena<Corner> corners_;
    Arena<std::uint32_t> numbers_;
    Arena<Facet> facets_;
};

} // namespace abacus
