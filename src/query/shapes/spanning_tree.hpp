// The minimum spanning tree of a mesh's vertices: the Euclidean one, if the mesh is Delaunay.
//
// Edges are ranked by length, and by their ends among those of one length. So the tree is unique.
// Kruskal's algorithm visits them by rank, with a word or two per vertex. If there is no room for
// that, vertices are first joined, chunk by chunk along the curve. All edges at the vertices of a
// chunk are visited by rank, including those that lead out of it:
//
//   accept   Suppose no edge so far leads out of a part of the chunk without having been accepted.
//            Then the next edge that leads out is the least of all that leave the part, and belongs
//            to the tree (the cut property, Borůvka 1926). The parts that it joins become one.
//   close    A part that an edge out of the chunk leaves, or one between two closed parts, is
//            closed: its least edge is not known to be accepted.
//   drop     An edge is dropped if lesser ones within the chunk have already joined its ends (the
//            cycle property); otherwise it is left for later.
//
// Then each part becomes a vertex. As a chunk is compact, few edges leave it: about the square root
// of m vertices remain of m in the plane. This is repeated until Kruskal's algorithm has room.
//
// All lists of edges are sorted in bounded memory: by their ends, to number these, by chunks, and
// by rank.
#pragma once

#include "query/shapes/length_key.hpp"
#include "query/shapes/light_edges.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

#include <functional>
#include <optional>

namespace abacus {

template <int D> class SpanningTree {
public:
    /// Ids of an edge's ends, the lesser one first, and its length.
    using Report = std::function<void(const std::int64_t *ids, double length)>;

    /// Reports all edges, the shortest first. Sorts and what is known of vertices take `memory`
    /// bytes. Throws if vertices become no fewer, and there is no room for all of them.
    SpanningTree(const Host &host, const abacus_facts &facts, std::size_t memory,
                 std::size_t cache_bytes, const Report &report);

private:
    // An edge with numbered ends: rank, ends.
    static constexpr std::size_t ends_words = 3;
    // ... with its chunk before that
    static constexpr std::size_t chunk_words = 4;
    // ... while an end gets its new number: that end, rank, the other one
    static constexpr std::size_t renumber_words = 3;
    // An edge at first: length, points, ids.
    static constexpr std::size_t length_words = std::tuple_size_v<LengthKey> + 2 * D + 2;
    // An end: code, point, rank.
    static constexpr std::size_t end_words = D + 2;
    // A reported edge: ids, length.
    static constexpr std::size_t detail_words = 3;

    /// Ranks edges: fills details_ by rank, and `ends`. There are at least `least` of them.
    void rank(LightEdges<D> &edges, RecordSort &ends, double least);
    /// Numbers the vertices along the curve, and lists the edges by rank.
    void number(RecordSort &ends);
    /// Reduces the vertices and the edges.
    void contract();
    void sort_by_chunk(RecordSort &by_chunk);
    std::uint64_t chunk_of(std::uint64_t vertex) const { return (vertex + shift_) / room_; }
    void contract_chunks(RecordSort &by_chunk, RecordSort &left, RecordSpool &numbers);
    /// Replaces an end of each edge by its new number; then the other end comes first.
    void renumber(RecordSort &from, RecordSpool &numbers, RecordSort &to) const;
    void finish();
    void report(const Report &report);

    const Host &host_;
    const std::size_t share_;  // of the memory
    const std::uint64_t room_; // the vertices that fit in memory
    std::uint64_t vertices_ = 0;
    std::uint64_t shift_ = 0;         // of the ends of chunks, different each time
    std::optional<RecordSort> edges_; // of the vertices there are
    RecordSpool details_;
    RecordSort tree_; // ranks
};

extern template class SpanningTree<2>;
extern template class SpanningTree<3>;

} // namespace abacus
