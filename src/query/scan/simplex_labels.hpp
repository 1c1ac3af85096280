// Labels of simplices for queries: named numbers, kept by the places of the corners in pages of
// their own, which are read when the labels of the first simplex are needed.
#pragma once

#include "attributes/attribute_reader.hpp"
#include "keys/domain_of.hpp"
#include "query/locate/behind_facet.hpp"

#include <abacus/simplex.h>

#include <optional>

namespace abacus {

template <int D> class SimplexLabels {
public:
    static constexpr std::size_t default_bytes = std::size_t{2} << 20;

    /// Keeps them in about so many bytes.
    SimplexLabels(const Host &host, const abacus_facts &facts, std::size_t bytes = default_bytes)
        : behind_(host, facts), values_(host) {
        values_.resize(facts.columns.labels);
        std::fill(values_.begin(), values_.end(), null_value);
        if (facts.census.labelled > 0)
            pages_.emplace(host, domain_of<D>(facts.form), facts.columns.labels, bytes);
    }

    /// All labels of a finite simplex, NULL where it has none; valid until the next call.
    const double *of(const abacus_simplex &simplex) {
        std::array<Point<D>, D + 1> points;
        for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, points[i].begin());
        return of(owner_of<D, D + 1>(points));
    }
    const double *of(const Owner<D, D + 1> &simplex) {
        if (pages_) pages_->values_if_any(simplex, values_.data());
        return values_.data();
    }
    /// The same for a simplex of a page; for a ghost the labels of the simplex behind it.
    const double *of_page(const PageView<D> &page, int simplex) {
        if (!pages_) return values_.data();
        std::array<Point<D>, D + 1> points;
        const int finite = D + !page.is_ghost(simplex);
        for (int i = 0; i < finite; ++i) points[i] = page.point(page.corner(simplex, i));
        if (finite > D) return of(owner_of<D, D + 1>(points));
        std::array<Point<D>, D> facet;
        std::copy_n(points.begin(), D, facet.begin());
        std::array<std::int64_t, D> ids;
        for (int i = 0; i < D; ++i) ids[i] = page.id(page.corner(simplex, i));
        return of(behind_.of(facet, ids));
    }

private:
    BehindFacet<D> behind_;
    std::optional<AttributeReader<D, D + 1>> pages_;
    Arena<double> values_;
};

} // namespace abacus
