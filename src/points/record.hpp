// A point on its way: words of eight bytes, as in abacus_stage_add.
//
//   id (int64_t), D coordinates (double), the attributes (double)
#pragma once

#include "geometry/point.hpp"

#include <abacus/host_functions.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace abacus {

/// Words of a record.
constexpr std::size_t record_words(unsigned dimension, unsigned attributes) {
    return 1 + dimension + attributes;
}

/// How many of so many words each a page holds besides a header. It has ABACUS_PAGE_BYTES at most,
/// unless a single one with very many attributes takes more.
constexpr std::size_t records_in_page(std::size_t words, std::size_t header_words) {
    const std::size_t fit = (ABACUS_PAGE_BYTES / 8 - header_words) / words;
    return fit > 0 ? fit : 1;
}

inline std::int64_t record_id(const std::uint64_t *record) {
    return std::bit_cast<std::int64_t>(record[0]);
}

template <int D> Point<D> record_point(const std::uint64_t *record) {
    Point<D> point;
    std::memcpy(point.data(), record + 1, sizeof point);
    return point;
}

/// The attributes, where they lie.
template <int D> const double *record_attributes(const std::uint64_t *record) {
    return reinterpret_cast<const double *>(record + 1 + D);
}

/// Writes a record with n attributes.
template <int D>
void fill_record(std::uint64_t *record, std::int64_t id, const Point<D> &point,
                 const double *attributes, std::size_t n) {
    record[0] = std::bit_cast<std::uint64_t>(id);
    std::memcpy(record + 1, point.data(), sizeof point);
    if (n > 0) std::memcpy(record + 1 + D, attributes, n * sizeof *attributes);
}

} // namespace abacus
