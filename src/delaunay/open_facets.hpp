// The facets around the rest of a hole while it is being filled: those of its rim, and those of new
// simplices that have no neighbour yet. A facet is found by its vertices.
//
// It is a hash table of numbers into a list. A facet is entered when the first of its two
// simplices is known, and closed when the second comes. It never returns, so nothing is removed. An
// entry is valid only in the hole that made it, so the table is empty at once for the next hole.
#pragma once

#include "delaunay/delaunay.hpp"

#include <utility>

namespace abacus {

template <int D> class OpenFacets {
public:
    using Vertices = FacetVertices<D, VertexIndex>;

    struct Facet {
        Rim<D> rim; // as seen from the hole: the vertex opposite it is still to be found
        Vertices vertices;
        bool open;

        /// None of its vertices is at infinity.
        bool is_finite() const { return vertices.vertex[0] != infinite_vertex; }
    };

    explicit OpenFacets(const Host &host) : facets_(host), table_(host) { clear(); }

    void clear() {
        facets_.clear();
        open_ = 0;
        resize(128);
    }
    /// How many are open; how many there have been.
    std::size_t open() const { return open_; }
    std::size_t size() const { return facets_.size(); }
    const Facet &operator[](std::size_t n) const { return facets_[n]; }

    void add(const Rim<D> &rim) {
        if (2 * (facets_.size() + 1) > mask_) resize(2 * (mask_ + 1));
        facets_.push_back({rim, Vertices(rim.vertex, rim.facet), true});
        ++open_;
        table_[slot(facets_.back().vertices)] = {epoch_,
                                                 static_cast<std::uint32_t>(facets_.size() - 1)};
    }
    /// The open facet with these vertices on this side, or null.
    const Facet *find(const Vertices &vertices) const {
        const Entry &entry = table_[slot(vertices)];
        if (entry.epoch != epoch_) return nullptr;
        const Facet &facet = facets_[entry.facet];
        return facet.open && facet.vertices.odd == vertices.odd ? &facet : nullptr;
    }
    /// Joins facet i of a new simplex to its neighbour, if this is known; otherwise opens its other
    /// side.
    void meet(Cache<D> &cache, Handle h, int i) {
        const Simplex<D> &s = cache.simplex(h);
        const Vertices vertices(s.vertex, i);
        const Entry &entry = table_[slot(vertices)];
        if (entry.epoch == epoch_) {
            Facet &facet = facets_[entry.facet];
            if (!facet.open || facet.vertices.odd != vertices.odd) throw_no_triangulation();
            facet.open = false;
            --open_;
            cache.connect(make_link(h, i), facet.rim.outer);
            return;
        }
        // From the other side the orientation is the opposite one.
        Rim<D> rim{make_link(h, i), i < 2 ? 1 - i : i, s.vertex};
        std::swap(rim.vertex[0], rim.vertex[1]);
        add(rim);
    }

private:
    struct Entry {
        std::uint32_t epoch;
        std::uint32_t facet;
    };

    std::size_t slot(const Vertices &vertices) const {
        std::uint64_t h = 0;
        for (const VertexIndex v : vertices.vertex) h = (h ^ to_number(v)) * 0x9e3779b97f4a7c15ull;
        std::size_t at = (h >> 32) & mask_;
        while (table_[at].epoch == epoch_ &&
               facets_[table_[at].facet].vertices.vertex != vertices.vertex)
            at = (at + 1) & mask_;
        return at;
    }
    void resize(std::size_t size) {
        mask_ = size - 1;
        if (table_.size() < size) {
            table_.resize(size);
            epoch_ = 0xffffffffu;
        }
        if (++epoch_ == 0) { // this also happens once in four billion holes
            std::fill(table_.begin(), table_.end(), Entry{});
            epoch_ = 1;
        }
        for (std::size_t n = 0; n < facets_.size(); ++n)
            table_[slot(facets_[n].vertices)] = {epoch_, static_cast<std::uint32_t>(n)};
    }

    Arena<Facet> facets_;
    Arena<Entry> table_;
    std::size_t mask_ = 0;
    std::size_t open_ = 0;
    std::uint32_t epoch_ = 0;
};

} // namespace abacus
