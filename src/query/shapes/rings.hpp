// The border of what is kept of a mesh in the plane, as closed rings of vertices.
//
// Rings are walked from edge to edge across the mesh (border.hpp), each from its first edge on. So
// visited edges need not be remembered. But such a ring may pass through a vertex more than once:
// where a hole touches another one, or the outline. Rings do not cross. So the part between two
// visits of a vertex is a ring of its own, except for parts between two visits of another vertex
// within it. These pieces nest, and a stack of the open pieces shows to which one a visit belongs.
// The remaining ring passes through each place once, and is a polygon; or it is both sides of an
// edge of a fault, which is left out. So a fault that ends within the mesh leaves no trace.
//
// A ring goes counterclockwise around what is kept, or clockwise around a hole. It begins with its
// lexicographically least vertex, and rings come in the order of these vertices; rings that share
// one come counterclockwise.
//
// Vertices and rings are sorted several times, in bounded memory. The only other memory is for the
// open pieces of a ring, two words each.
#pragma once

#include "query/locate/reader.hpp"
#include "query/shapes/border.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

namespace abacus {

class Rings {
public:
    /// A vertex of a ring, from which an edge leads to the next one.
    struct Visit {
        std::uint64_t ring, position; ///< from 0 on
        std::int64_t id;
        Point<2> point;
        Key page; ///< of the triangle at the edge
        bool is_hole;
    };

    /// Sorts take `memory` bytes.
    Rings(Reader<2> &reader, const Kept &kept, std::size_t memory);

    /// The next vertex of a ring; false after the last.
    bool next(Visit &visit);
    /// Goes back to the first.
    void rewind() { rows_.rewind(); }
    std::uint64_t count() const { return count_; }
    /// The number of edges of the border; all rings together have no more vertices.
    std::uint64_t edges() const { return edges_; }
    void close() { rows_.close(); }

private:
    // ring, position, id, x, y, code and part of the page, 1 for a hole
    static constexpr std::size_t words = 8;
    // of a ring: its least vertex, the one after it, its name, where it begins, its size, 1 for a
    // hole
    static constexpr std::size_t least_words = 8;

    void find_starts(RecordSort &starts);
    /// Calls look(key) for the pages in which something may be kept, in their order.
    template <class Look> void each_page(Look look);
    void find_hull(RecordSort &starts);
    /// Returns how many simplices the page has.
    std::size_t find_starts_of_page(const Key &page, Arena<Border::Edge> &edges);
    void add_start(RecordSort &starts, const Border::Edge &edge);
    /// Writes all vertices of all rings, and sorts them by ring and place.
    void walk(RecordSort &starts, RecordSpool &visits, RecordSort &by_place);
    /// Adds the pieces between two visits of a vertex: ring, first position, end.
    static void find_pieces(RecordSort &by_place, RecordSort &pieces);
    /// Gives each piece a ring of its own.
    void split(RecordSpool &visits, RecordSort &pieces, RecordSort &rings);
    /// Where each ring begins, in their order.
    void find_least(RecordSort &rings, RecordSort &least) const;
    /// Among rings that share their least vertex the ones to the right come first.
    void number_rings(RecordSort &least, RecordSort &numbers) const;
    void put_in_order(RecordSort &rings, RecordSort &numbers);

    const Host &host_;
    Reader<2> &reader_;
    Cache<2> &cache_;
    const Kept kept_;
    Border border_;
    const std::size_t share_; // of the memory
    RecordSort rows_;
    std::uint64_t count_ = 0, edges_ = 0;
};

} // namespace abacus
