// The border of what is kept of a mesh: for the whole mesh its hull, for a part of it a closer
// outline.
//
// In the plane the border is closed rings (rings.hpp). In space it is triangles, each a ring of
// three, in the order of their corners.
#pragma once

#include "query/shapes/cavities.hpp"
#include "query/shapes/ring_nesting.hpp"

#include <abacus/shapes.h>

namespace abacus {

template <int D> class Outline;

template <> class Outline<2> {
public:
    Outline(const Host &host, const abacus_facts &facts, const abacus_outline_kind &kind,
            std::size_t memory, std::size_t cache_bytes);
    /// False after the last.
    bool next(abacus_outline_row &row);
    void close() { rings_.close(); }

private:
    Reader<2> reader_;
    Rings rings_;
    std::optional<RingNesting> nesting_; // if holes are filled
    std::uint64_t ring_ = 0, last_ = ~0ull;
};

template <> class Outline<3> {
public:
    Outline(const Host &host, const abacus_facts &facts, const abacus_outline_kind &kind,
            std::size_t memory, std::size_t cache_bytes);
    bool next(abacus_outline_row &row);
    void close() { triangles_.close(); }

private:
    struct Corner {
        Point<3> point;
        std::int64_t id;
    };
    // three points, their ids, what part of the rest it is the border to
    static constexpr std::size_t words = 13;

    void add(std::array<Corner, 3> corners, std::uint32_t part);
    /// The hull alone: no other page is read.
    void find_hull(const Host &host, const abacus_facts &facts, Reader<3> &reader);
    void find_border(Reader<3> &reader, const Kept &kept);
    /// Collects the facets of the border, page by page, in borders_; calls end_page() after each
    /// page.
    template <class End> void each_page(Reader<3> &reader, const Kept &kept, End end_page);
    /// Only counts triangles. Throws if spools have no room for them.
    void count(Reader<3> &reader, const Kept &kept);
    void add_borders(Cache<3> &cache);

    Arena<Link> borders_; // of a page: facets of simplices not kept, with kept ones beyond
    std::optional<Cavities> cavities_; // if they are filled
    RecordSort triangles_;
    std::array<std::uint64_t, words> triangle_{};
    std::uint64_t ring_ = 0;
    int position_ = 3;
};

} // namespace abacus
