// The minimum spanning tree of a mesh's vertices: the Euclidean one, if the mesh is Delaunay.
//
// Edges have ranks, by length, and by their ends among those of one length. So the tree is one
// alone. Kruskal goes through them by rank, with a word or two a vertex. Where there is no room for
// that, vertices become fewer first, chunk by chunk along the curve. All edges at the vertices of a
// chunk are gone through by rank, also those that lead out of it:
//
//   accept   Let no edge so far have led out of a part of the chunk and been left. Then the next
//            one that does is the least of all that leave the part, and belongs to the tree (the
//            cut property, Borůvka 1926). What it joins becomes one part.
//   close    A part that an edge out of the chunk leaves, or one between two closed parts, is
//            closed: its least edge is not known to be accepted.
//   drop     An edge is left for later, unless lesser ones within the chunk have joined its ends
//            already (the cycle property).
//
// Then each part is a vertex. As a chunk is compact, few edges leave it: of m vertices in the plane
// about the square root of m are left. This goes on until Kruskal has room.
//
// All lists of edges are sorted, in bounded memory: by their ends to give these numbers, by chunks,
// and by rank.
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
    // Of an edge with numbered ends: rank, ends.
    static constexpr std::size_t ends_words = 3;
    // ... with its chunk before that
    static constexpr std::size_t chunk_words = 4;
    // ... of which an end gets its new number: that end, rank, the other one
    static constexpr std::size_t renumber_words = 3;
    // Of an edge at first: length, points, ids.
    static constexpr std::size_t length_words = std::tuple_size_v<LengthKey> + 2 * D + 2;
    // Of an end: code, point, rank.
    static constexpr std::size_t end_words = D + 2;
    // Of an edge reported: ids, length.
    static constexpr std::size_t detail_words = 3;

    /// Ranks edges: fills details_ by rank, and `ends`. There are at least `least` of them.
    void rank(LightEdges<D> &edges, RecordSort &ends, double least);
    /// Numbers the vertices along the curve, and lists the edges by rank.
    void number(RecordSort &ends);
    /// Makes vertices, and edges, fewer.
    void contract();
    void sort_by_chunk(RecordSort &by_chunk);
    std::uint64_t chunk_of(std::uint64_t vertex) const { return (vertex + shift_) / room_; }
    void contract_chunks(RecordSort &by_chunk, RecordSort &left, RecordSpool &numbers);
    /// Replaces an end of each by its new number; the other one comes first then.
    void renumber(RecordSort &from, RecordSpool &numbers, RecordSort &to) const;
    void finish();
    void report(const Report &report);

    const Host &host_;
    const std::size_t share_;  // of the memory
    const std::uint64_t room_; // vertices that can be known of at once
    std::uint64_t vertices_ = 0;
    std::uint64_t shift_ = 0;         // of the ends of chunks, each time another one
    std::optional<RecordSort> edges_; // of the vertices there are
    RecordSpool details_;
    RecordSort tree_; // ranks
};

extern template class SpanningTree<2>;
extern template class SpanningTree<3>;

} // namespace abacus
