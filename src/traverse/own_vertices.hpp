// Visits every vertex once. A vertex is in all pages that have a simplex around it; it
// belongs to the first of them.
//
// What is loaded around a vertex may be needed again for the next one: where both are
// corners of many simplices, much of its star lies in the same pages.
#pragma once

#include "mesh/cache.hpp"
#include "traverse/flood.hpp"

namespace abacus {

template <int D> class OwnVertices {
public:
    explicit OwnVertices(Cache<D> &cache)
        : cache_(cache), numbered_(cache.host()), corners_(cache.host()), own_(cache.host()),
          star_(cache.host()) {}

    /// Lists the vertices that belong to the page that owns the key; returns the lower key
    /// of the next page, end_key after the last.
    Key collect(const Key &key) {
        return collect(key, [](VertexIndex, const Arena<Handle> &) {});
    }
    /// The same; calls visit(vertex, star) for each, with all simplices around it.
    template <class Visit> Key collect(const Key &key, Visit visit) {
        // First all vertices of the page: loading others numbers vertices in its own way.
        numbered_.clear();
        corners_.clear();
        own_.clear();
        const Key next = cache_.visit(key, [&](Handle h) {
            const Simplex<D> &s = cache_.simplex(h);
            for (int i = 0; i < s.finite_vertices(); ++i)
                if (cache_.number(numbered_, s.vertex[i]) == corners_.size())
                    corners_.push_back(make_link(h, i));
        });
        for (const Link corner : corners_) {
            if (!is_own(link_simplex(corner), link_facet(corner))) continue;
            own_.push_back(cache_.simplex(link_simplex(corner)).vertex[link_facet(corner)]);
            visit(own_.back(), star_.met());
        }
        return next;
    }
    const Arena<VertexIndex> &list() const { return own_; }

private:
    /// Whether no simplex around this corner of h is in an earlier page.
    bool is_own(Handle h, int corner) {
        const Key page = cache_.lower(h);
        return star_.around(cache_, h, cache_.simplex(h).vertex[corner], [&](Handle met) {
            cache_.use(met);
            return page <= cache_.lower(met);
        });
    }

    Cache<D> &cache_;
    typename VertexHeap<D>::Numbering numbered_;
    Arena<Link> corners_; // of the page: one for each vertex
    Arena<VertexIndex> own_;
    Flood<D> star_;
};

/// Calls visit(vertex) for every vertex of the mesh. What is no longer needed may leave the cache
/// meanwhile.
template <int D, class Visit> void each_vertex(Cache<D> &cache, Visit visit) {
    OwnVertices<D> own(cache);
    for (Key page = first_key; page < end_key;) {
        cache.trim();
        cache.poll();
        page = own.collect(page);
        for (const VertexIndex v : own.list()) visit(v);
    }
}

} // namespace abacus
