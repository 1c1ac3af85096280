// The edges of a mesh that may be in its minimum spanning tree: those that are not the longest of a
// triangle. In the plane and in space that leaves little more than an edge a vertex.
//
// Edges are ordered by length, and those of one length by their ends. The last edge of a cycle,
// such as a triangle, is in no minimum spanning tree. In a Delaunay mesh the edges contain the
// minimum spanning tree of all points.
//
// An edge is reported by the simplex into which a fixed direction leads from it, or by a ghost;
// some edges of the hull are reported more than once.
#pragma once

#include "query/locate/reader.hpp"
#include "sort/pacer.hpp"

namespace abacus {

template <int D> class LightEdges {
public:
    struct Edge {
        Point<D> point[2]; ///< in lexicographic order
        std::int64_t id[2];
    };

    LightEdges(const Host &host, const abacus_facts &facts, std::size_t cache_bytes)
        : reader_(host, facts, cache_bytes), cache_(reader_.cache()), pacer_(host), handles_(host),
          simplices_(facts.census.simplices + facts.census.ghosts) {}

    /// Calls visit(edge) for all of them.
    template <class Visit> void each(Visit visit) {
        if (reader_.is_empty()) return;
        std::uint64_t seen = 0; // simplices
        pacer_.begin(ABACUS_PHASE_SCANNING, simplices_);
        for (Key page = first_key; page < end_key;) {
            cache_.trim();
            pacer_.reached(seen += handles_.size());
            handles_.clear();
            page = cache_.visit(page, [&](Handle h) { handles_.push_back(h); });
            for (const Handle h : handles_)
                for (int i = 0; i <= D; ++i)
                    for (int j = 0; j < i; ++j)
                        if (is_handed_out(h, i, j) && !is_longest(h, i, j)) visit(edge(h, i, j));
        }
    }
    const Domain<D> &domain() const { return cache_.domain(); }

private:
    bool is_handed_out(Handle h, int i, int j) const;
    /// Whether it is the longest of a triangle.
    bool is_longest(Handle h, int i, int j);
    bool is_longest(VertexIndex a, VertexIndex b, VertexIndex apex) const;
    Edge edge(Handle h, int i, int j) const;

    Reader<D> reader_;
    Cache<D> &cache_;
    Pacer pacer_;
    Arena<Handle> handles_;         // of a page
    const std::uint64_t simplices_; // of the mesh, ghosts included
};

extern template class LightEdges<2>;
extern template class LightEdges<3>;

} // namespace abacus
