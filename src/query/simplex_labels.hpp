// Labels of simplices for those who query: named numbers, kept by the places of the corners in
// pages of their own, which are read when the first simplex is asked about.
#pragma once

#include "attributes/attribute_reader.hpp"
#include "keys/domain_of.hpp"

#include <abacus/read.h>

#include <optional>

namespace abacus {

template <int D> class SimplexLabels {
public:
    static constexpr std::size_t default_bytes = std::size_t{2} << 20;

    /// Keeps them in about so many bytes.
    SimplexLabels(const Host &host, const abacus_header &header, std::size_t bytes = default_bytes)
        : values_(host) {
        values_.resize(header.labels);
        std::fill(values_.begin(), values_.end(), null_value);
        if (header.labelled > 0) pages_.emplace(host, domain_of<D>(header), header.labels, bytes);
    }

    /// All labels of a finite simplex, NULL where it has none; valid until the next call.
    const double *of(const abacus_simplex &simplex) {
        if (!pages_) return values_.data();
        std::array<Point<D>, D + 1> points;
        for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, points[i].begin());
        pages_->values_if_any(owner_of<D, D + 1>(points), values_.data());
        return values_.data();
    }

private:
    std::optional<AttributeReader<D, D + 1>> pages_;
    Arena<double> values_;
};

} // namespace abacus
