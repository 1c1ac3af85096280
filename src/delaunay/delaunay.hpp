// A Delaunay mesh that is being changed: the state that insertion and removal share, so that both
// can work on one mesh in turns. It knows how many simplices there are, where the last change was,
// and the way from there to the next point.
#pragma once

#include "delaunay/simplex_log.hpp"
#include "mesh/cache.hpp"
#include "traverse/marks.hpp"
#include "traverse/walk.hpp"

namespace abacus {

/// A facet between simplices that are replaced and one that stays: the side of the one
/// that stays, and the vertices of the simplex inside. The new simplex gets its
/// orientation when the new vertex takes the place of the old one opposite the facet.
template <int D> struct Rim {
    Link outer;
    int facet; // of the simplex inside
    std::array<VertexIndex, D + 1> vertex;
};

template <int D> class Delaunay {
public:
    /// `simplices` and `ghosts` are what the mesh has already.
    Delaunay(const Host &host, Cache<D> &cache, std::int64_t simplices, std::int64_t ghosts)
        : marks(host), cache_(cache), walk_(cache), simplices_(simplices), ghosts_(ghosts) {
        forget();
    }
    Delaunay(const Delaunay &) = delete;
    Delaunay &operator=(const Delaunay &) = delete;

    Cache<D> &cache() { return cache_; }

    /// Finite simplices and ghosts of the whole mesh.
    std::int64_t simplices() const { return simplices_; }
    std::int64_t ghosts() const { return ghosts_; }
    /// Adds to the counts; negative if there are fewer.
    void count(std::int64_t simplices, std::int64_t ghosts) {
        simplices_ += simplices;
        ghosts_ += ghosts;
    }

    // The application cache (§4.12.4): simplices created last; the next point is likely to
    // lie in the circumsphere of one of them, or to be a corner.
    static constexpr int recent_size = D == 2 ? 8 : 24;
    const std::array<Handle, recent_size> &recent() const { return recent_; }
    void forget() { recent_.fill(no_handle); }
    /// One of them that is still there, or no_handle.
    Handle any_recent() const {
        for (const Handle h : recent_)
            if (cache_.is_live(h)) return h;
        return no_handle;
    }
    /// The n-th simplex that this operation has created.
    void remember(std::size_t n, Handle h) {
        if (n < recent_.size()) recent_[n] = h;
    }

    /// The simplex that contains p in its closure, or a ghost beyond whose facet p lies.
    /// `recent`: a live simplex, or no_handle.
    Handle locate(const Point<D> &p, std::uint64_t code, Handle recent) {
        // Walk from the last change if p is in its neighbourhood, measured by the size of
        // the simplices there; else from the block that owns p's code.
        Handle from = recent;
        if (from != no_handle && !walk_.is_close(from, p) && !cache_.near(from, code))
            from = no_handle;
        if (from == no_handle) from = cache_.start(code, p);
        if (from == no_handle) throw_corrupted("The mesh has no simplices.");
        return walk_.to(
            p, from,
            longest_walk(static_cast<std::uint64_t>(simplices_ + ghosts_), is_constrained));
    }

    /// The simplex's corner at p, or -1.
    int corner_at(Handle h, const Point<D> &p) const {
        const Simplex<D> &s = cache_.simplex(h);
        for (int i = 0; i < s.finite_vertices(); ++i)
            if (cache_.point(s.vertex[i]) == p) return i;
        return -1;
    }

    /// Whether the simplices around the point inserted last share one code with more than a page
    /// takes.
    bool is_crowded() const {
        const Handle h = recent_[0];
        return cache_.is_live(h) && !cache_.near(h, cache_.code(cache_.simplex(h)));
    }

    /// For changes that come in any order, so that the curve before them is not finished: a full
    /// block is cut at its median, not at the change.
    static constexpr std::uint64_t anywhere = 0;
    /// Ends an operation at a point with this code: simplices go home, the cache is trimmed.
    void finish(std::uint64_t code) {
        if (cache_.settle(code))
            for (Handle &h : recent_) h = cache_.follow(h);
        cache_.trim();
    }

    /// Whether edges may be fixed. Then a simplex in conflict with a point need not belong to its
    /// cavity, which ends at fixed edges.
    bool is_constrained = false;
    Marks marks;
    /// The log of created and removed simplices, if there is one.
    SimplexLog<D> *log = nullptr;

private:
    Cache<D> &cache_;
    Walk<D, Cache<D>> walk_;
    std::array<Handle, recent_size> recent_;
    std::int64_t simplices_;
    std::int64_t ghosts_;
};

/// A triangle with a vertex at p, and the corner, as a link; `unset` if there is none.
inline Link vertex_at(Delaunay<2> &mesh, const Point<2> &p) {
    if (mesh.simplices() == 0) return unset;
    const Handle h = mesh.locate(p, mesh.cache().domain().code(p), mesh.any_recent());
    const int corner = mesh.corner_at(h, p);
    return corner < 0 ? unset : make_link(h, corner);
}

} // namespace abacus
