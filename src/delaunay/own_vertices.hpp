// Every vertex once. A vertex is in all pages with a simplex around it; it belongs to
// the first of them.
//
// All that is loaded around a vertex may be wanted again for the next one, which has a good
// part of its star in the same pages where both are corners of many simplices.
#pragma once

#include "delaunay/marks.hpp"
#include "mesh/cache.hpp"

namespace abacus {

template <int D> class OwnVertices {
public:
    explicit OwnVertices(Cache<D> &cache)
        : cache_(cache), numbered_(cache.host()), corners_(cache.host()), own_(cache.host()),
          open_(cache.host()), seen_(cache.host()) {}

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
            visit(own_.back(), open_);
        }
        return next;
    }
    const Arena<VertexIndex> &list() const { return own_; }

private:
    /// Whether no simplex around this corner of h is in an earlier page.
    bool is_own(Handle h, int corner) {
        const VertexIndex v = cache_.simplex(h).vertex[corner];
        const Key page = cache_.lower(h);
        bool own = true;
        open_.clear();
        open_.push_back(h);
        seen_.set(h, Marks::inside);
        for (std::size_t n = 0; own && n < open_.size(); ++n) {
            if (n % 4096 == 4095) cache_.poll();
            for (int i = 0; own && i <= D; ++i) {
                if (cache_.simplex(open_[n]).vertex[i] == v) continue;
                const Handle neighbour = link_simplex(cache_.cross(open_[n], i));
                if (seen_.get(neighbour) == Marks::inside) continue;
                seen_.set(neighbour, Marks::inside);
                open_.push_back(neighbour);
                cache_.use(neighbour);
                own = page <= cache_.lower(neighbour);
            }
        }
        for (const Handle seen : open_) seen_.set(seen, Marks::none);
        return own;
    }

    Cache<D> &cache_;
    typename VertexHeap<D>::Numbering numbered_;
    Arena<Link> corners_; // of the page: one for each vertex
    Arena<VertexIndex> own_;
    Arena<Handle> open_; // around a vertex
    Marks seen_;
};

} // namespace abacus
