// What regions are made of: segments of their outlines, and seeds. Collected in any order, read
// region by region.
#pragma once

#include "geometry/ordered.hpp"
#include "host/error.hpp"
#include "mesh/fixed_facets.hpp"
#include "sort/record_sort.hpp"

#include <cmath>

namespace abacus {

class RegionParts {
public:
    RegionParts(const Host &host, std::size_t memory)
        : sort_(host, words, words, memory / 2), memory_(memory / 2) {}

    /// For what is made of them.
    std::size_t memory() const { return memory_; }

    void add_outline(RegionNumber region, const Point<2> &a, const Point<2> &b) {
        add(region, is_outline, a, b);
    }
    void add_seed(RegionNumber region, const Point<2> &place) {
        add(region, is_seed, place, place);
    }

    /// Ends adding, and goes to the first part; may be called again.
    void rewind() {
        if (is_finished_)
            sort_.rewind();
        else
            sort_.finish();
        is_finished_ = true;
    }
    /// Calls outline(region, a, b) and seed(region, p), region by region, with seeds last.
    template <class Outline, class Seed> void each(Outline outline, Seed seed) {
        rewind();
        while (const std::uint64_t *const record = sort_.next()) {
            const auto region = static_cast<RegionNumber>(record[0]);
            const Point<2> a = point_from_ordered<2>(record + 2);
            if (record[1] == is_outline)
                outline(region, a, point_from_ordered<2>(record + 4));
            else
                seed(region, a);
        }
    }
    void close() { sort_.close(); }

private:
    enum Kind : std::uint64_t { is_outline, is_seed };
    static constexpr std::size_t words = 6; // region, kind, both ends

    void add(RegionNumber region, Kind kind, Point<2> a, Point<2> b) {
        for (Point<2> *const p : {&a, &b})
            for (double &x : *p) {
                if (!std::isfinite(x))
                    throw Error(ABACUS_ERROR_ARGUMENT, "a coordinate of a region is not finite");
                x += 0.0; // 0, not -0
            }
        std::uint64_t *const record = sort_.add();
        record[0] = region;
        record[1] = kind;
        put_ordered(record + 2, a);
        put_ordered(record + 4, b);
    }

    RecordSort sort_;
    const std::size_t memory_;
    bool is_finished_ = false;
};

} // namespace abacus
