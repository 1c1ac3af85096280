// Edges between a region and others. Those on the region's outlines are known; a flood from inside
// must meet the same ones. Where it meets another edge, the other region lies within this one.
#pragma once

#include "geometry/ordered.hpp"
#include "mesh/fixed_facets.hpp"
#include "sort/record_sort.hpp"

#include <algorithm>
#include <optional>

namespace abacus {

class TouchingEdges {
public:
    TouchingEdges(const Host &host, std::size_t memory) : host_(host), memory_(memory) {}

    void begin() { edges_.reset(); }
    /// An edge on an outline of the region, with another region beyond.
    void add_known(const Point<2> &a, const Point<2> &b) { add(a, b, is_known, no_region); }
    void add_met(const Point<2> &a, const Point<2> &b, RegionNumber beyond) {
        add(a, b, is_met, beyond);
    }

    struct Overlap {
        RegionNumber other;
        Point<2> a, b; // both ends of the edge
    };
    /// The first edge that has been met and is not known. No more edges can be added.
    std::optional<Overlap> overlap() {
        if (!edges_) return {};
        edges_->finish();
        std::array<std::uint64_t, end_words> known{};
        bool is_any = false;
        std::optional<Overlap> found;
        while (const std::uint64_t *const record = edges_->next()) {
            if (record[end_words] == is_known) {
                std::copy_n(record, end_words, known.begin());
                is_any = true;
            } else if (!is_any || !std::equal(known.begin(), known.end(), record)) {
                found = {static_cast<RegionNumber>(record[end_words + 1]),
                         point_from_ordered<2>(record), point_from_ordered<2>(record + 2)};
                break;
            }
        }
        edges_->close();
        return found;
    }

private:
    enum Source : std::uint64_t { is_known, is_met };
    static constexpr std::size_t end_words = 4, words = end_words + 2;

    void add(const Point<2> &a, const Point<2> &b, Source source, RegionNumber beyond) {
        if (!edges_) edges_.emplace(host_, words, words, memory_);
        std::uint64_t *const record = edges_->add();
        put_ordered(record, std::min(a, b));
        put_ordered(record + 2, std::max(a, b));
        record[end_words] = source;
        record[end_words + 1] = beyond;
    }

    const Host &host_;
    const std::size_t memory_;
    std::optional<RecordSort> edges_;
};

} // namespace abacus
