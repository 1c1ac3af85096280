// On which side of its edges the inside of outlines lies: a place is inside if a ray from it
// crosses an odd number of edges (the even-odd rule).
//
// An edge that outlines have an even number of times counts as none. Those left cross nowhere and
// meet in vertices. A line sweeps over them, vertex by vertex in lexicographic order, and keeps
// those that it crosses, from the lowest up. Inside and outside alternate along it. So the place of
// an edge in that order, which has the same parity as long as the line crosses it, says on which
// side the inside is. At each vertex an even number of edges meets, or an outline is open there.
#pragma once

#include "geometry/point.hpp"
#include "mesh/fixed_facets.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

#include <functional>
#include <optional>

namespace abacus {

class OutlineSides {
public:
    /// Edges are sorted in `memory` bytes; those that the line crosses at a time are in memory.
    OutlineSides(const Host &host, std::size_t memory);

    /// Of a mesh; the same one may come several times.
    void add(RegionNumber region, const Point<2> &a, const Point<2> &b);

    /// An edge with the inside of a region on its left.
    using Visit = std::function<void(const Point<2> &from, const Point<2> &to)>;
    /// The next region, and its edges; 0 after the last. No more edges can be added. If an outline
    /// is open, `open` is an end of it, and only some edges come.
    RegionNumber next(const Visit &visit, std::optional<Point<2>> &open);
    void close();

private:
    struct Edge {
        Point<2> left, right; // its lesser end, and the greater one
    };
    using Number = std::uint32_t; // of an edge in crossed_

    /// Collects the edges of the next region that it has an odd number of times.
    RegionNumber collect();
    void sweep(const Visit &visit, std::optional<Point<2>> &open);
    /// How many of the edges that the line crosses are below p.
    std::size_t below(const Point<2> &p) const;
    /// Drops the edges that end at p, which are above that many others; returns how many.
    std::size_t drop(std::size_t below, const Point<2> &p);
    /// Inserts the edges of fresh_, which begin at one vertex.
    void insert(std::size_t below, const Visit &visit);

    RecordSort edges_;               // region, left, right
    std::optional<RecordSpool> odd_; // of one region: left, right
    std::optional<RecordSort> ends_; // ... of these: right
    const Host &host_;
    const std::size_t share_;
    const std::uint64_t *next_ = nullptr;
    bool is_begun_ = false;
    Arena<Edge> crossed_;
    Arena<Number> free_;  // of crossed_
    Arena<Number> order_; // of the edges that the line crosses, from the lowest up
    Arena<Edge> fresh_;
};

} // namespace abacus
