#include "delaunay/hole.hpp"

#include "delaunay/cached_conflict.hpp"

#include <algorithm>
#include <utility>

namespace abacus {

namespace {

/// Puts the point at infinity in the place of a corner and brings it to the end of the simplex by
/// two exchanges, which keep the orientation.
template <int D>
std::array<VertexIndex, D + 1> with_infinity(std::array<VertexIndex, D + 1> vertices, int corner) {
    vertices[corner] = infinite_vertex;
    if (corner != D) {
        std::swap(vertices[corner], vertices[D]);
        std::swap(vertices[0], vertices[1]);
    }
    return vertices;
}

/// Whether p and q, in one plane with a and b, lie on different sides of the line through
/// a and b. p does not lie on it.
bool are_apart(const Point<3> &a, const Point<3> &b, const Point<3> &p, const Point<3> &q) {
    for (int i = 0; i < 3; ++i) { // in the first projection where the plane does not become a line
        const int j = (i + 1) % 3;
        const Point<2> a2{a[i], a[j]}, b2{b[i], b[j]};
        const int side = orientation(a2, b2, {p[i], p[j]});
        if (side != 0) return orientation(a2, b2, {q[i], q[j]}) == -side;
    }
    return false;
}

} // namespace

template <int D> std::uint64_t Hole<D>::fill(const Star<D> &star) {
    created_ = ghosts_ = 0;
    mesh_.forget();
    for (const Rim<D> &rim : star.rim()) cache_.mark_dirty(link_simplex(rim.outer));
    std::size_t tried = 0; // simplices that do not belong to the mesh
    if (star.link().size() >= large)
        tried = 2 * sew(star);
    else if constexpr (D == 2)
        cut(star);
    else
        wrap(star);
    mesh_.count(static_cast<std::int64_t>(created_ - ghosts_), static_cast<std::int64_t>(ghosts_));
    // For each simplex, cutting looks at some of the neighbours and wrapping at all of them.
    constexpr std::size_t looks = D == 2 ? 4 : 2; // this many cost as much as a simplex
    return created_ + (tried > 0 ? tried : created_ * star.link().size() / looks);
}

template <int D> Handle Hole<D>::create(const Vertices &vertices) {
    const Handle h = cache_.create(vertices);
    mesh_.remember(created_++, h);
    ghosts_ += vertices[D] == infinite_vertex;
    if (mesh_.log != nullptr) mesh_.log->come(cache_, h);
    if (created_ % 4096 == 0) cache_.poll();
    return h;
}

template <int D> void Hole<D>::add(const Vertices &vertices) {
    const Handle h = create(vertices);
    for (int i = 0; i <= D; ++i) facets_.meet(cache_, h, i);
}

template <int D> void Hole<D>::open_rim(const Star<D> &star) {
    facets_.clear();
    for (const Rim<D> &rim : star.rim()) facets_.add(rim);
}

template <int D> void Hole<D>::require_filled() const {
    if (facets_.open() > 0) throw_no_triangulation();
}

// ---- Cutting a polygon ------------------------------------------------------

template <int D> void Hole<D>::cut(const Star<D> &star) requires(D == 2) {
    const Arena<VertexIndex> &link = star.link();
    chains_.clear();
    const auto last = static_cast<std::uint32_t>(link.size() - 1);
    chains_.push_back({0, last, star.rim()[last].outer});
    while (!chains_.empty()) {
        const Chain chain = chains_.back();
        chains_.pop_back();
        const std::uint32_t middle = apex(link, chain);
        const VertexIndex a = link[chain.first], b = link[middle], c = link[chain.last];
        // The point at infinity is first in its polygon, but last in its triangle.
        const bool ghost = a == infinite_vertex;
        const Handle h = create(ghost ? Vertices{b, c, a} : Vertices{a, b, c});
        const int at_a = ghost ? 2 : 0, at_b = ghost ? 0 : 1, at_c = ghost ? 1 : 2;
        cache_.connect(make_link(h, at_b), chain.closing);
        close(star, {chain.first, middle, make_link(h, at_c)});
        close(star, {middle, chain.last, make_link(h, at_a)});
    }
}

template <int D> void Hole<D>::close(const Star<D> &star, const Chain &chain) requires(D == 2) {
    if (chain.last == chain.first + 1)
        cache_.connect(chain.closing, star.rim()[chain.first].outer);
    else
        chains_.push_back(chain);
}

template <int D>
std::uint32_t Hole<D>::apex(const Arena<VertexIndex> &link, const Chain &chain) const
    requires(D == 2) {
    const std::uint32_t first = chain.first, last = chain.last;
    if (last - first == 2 && link[first] == infinite_vertex) return first + 1;
    Corners<D> corners;
    corners[0] = &cache_.point(link[first]);
    corners[2] = &cache_.point(link[last]);
    if (link[first] == infinite_vertex) {
        // The next vertex of the hull: no other vertex lies beyond the edge to it.
        std::uint32_t best = last - 1;
        for (std::uint32_t n = last - 2; n > first; --n) {
            const Simplex<D> edge{{link[best], link[last], infinite_vertex}, {}};
            if (side_of<D>(cache_, edge, cache_.point(link[n])) == Side::inside) best = n;
        }
        return best;
    }
    std::uint32_t best = first;
    for (std::uint32_t n = first + 1; n < last; ++n) {
        const Point<D> &p = cache_.point(link[n]);
        if (best != first) {
            corners[1] = &cache_.point(link[best]);
            if (in_sphere(corners, p) <= 0) continue;
        }
        corners[1] = &p;
        if (orientation<D>(corners) > 0) best = n;
    }
    if (best == first) throw_no_triangulation();
    return best;
}

// ---- Gift wrapping ------------------------------------------------------------

template <int D> void Hole<D>::wrap(const Star<D> &star) requires(D == 3) {
    candidates_.clear();
    for (const VertexIndex v : star.link())
        if (v != infinite_vertex) candidates_.push_back({cache_.point(v), v});
    open_rim(star);
    // There are not more simplices than pairs of vertices.
    const std::size_t most = star.link().size() * star.link().size();
    for (std::size_t n = 0; n < facets_.size(); ++n) {
        if (!facets_[n].open) continue;
        if (created_ > most) throw_no_triangulation();
        const Facet &facet = facets_[n];
        add(facet.is_finite() ? best_on_finite(facet) : best_on_infinite(facet));
    }
    require_filled();
}

template <int D>
typename Hole<D>::Vertices Hole<D>::best_on_finite(const Facet &facet) const requires(D == 3) {
    const Rim<D> &rim = facet.rim;
    Corners<D> corners{};
    for (int i = 0; i <= D; ++i)
        if (i != rim.facet) corners[i] = &cache_.point(rim.vertex[i]);
    const auto &on_facet = facet.vertices.vertex;
    const Candidate *best = nullptr; // null: the point at infinity
    for (const Candidate &candidate : candidates_) {
        if (std::find(on_facet.begin(), on_facet.end(), candidate.vertex) != on_facet.end())
            continue;
        if (best != nullptr) {
            corners[rim.facet] = &best->point;
            if (in_sphere(corners, candidate.point) <= 0) continue;
        }
        corners[rim.facet] = &candidate.point;
        if (orientation<D>(corners) > 0) best = &candidate;
    }
    if (best == nullptr) return with_infinity<D>(rim.vertex, rim.facet);
    Vertices vertices = rim.vertex;
    vertices[rim.facet] = best->vertex;
    return vertices;
}

// The candidates around an edge of the hull have an order as long as they lie within less than a
// half turn. Candidates in the plane of the hull facet beyond the edge, on its own side, are a half
// turn away.
template <int D>
typename Hole<D>::Vertices Hole<D>::best_on_infinite(const Facet &facet) const requires(D == 3) {
    const Rim<D> &rim = facet.rim;
    Corners<D> corners{};
    Simplex<D> ghost{rim.vertex, {}};
    for (int i = 0; i < D; ++i)
        if (i != rim.facet) corners[i] = &cache_.point(rim.vertex[i]);
    const Simplex<D> &beyond = cache_.simplex(link_simplex(rim.outer));
    const VertexIndex opposite = beyond.vertex[link_facet(rim.outer)];
    corners[D] = &cache_.point(opposite);
    const int i = rim.facet == 0 ? 1 : 0, j = rim.facet == 2 ? 1 : 2;
    bool found = false;
    for (const Candidate &candidate : candidates_) {
        const VertexIndex v = candidate.vertex;
        if (v == rim.vertex[i] || v == rim.vertex[j] || v == opposite) continue;
        if (found && side_of<D>(cache_, ghost, candidate.point) != Side::inside) continue;
        corners[rim.facet] = &candidate.point;
        if (orientation<D>(corners) == 0 &&
            !are_apart(*corners[i], *corners[j], cache_.point(opposite), candidate.point))
            continue;
        ghost.vertex[rim.facet] = v;
        found = true;
    }
    if (!found) throw_no_triangulation();
    return ghost.vertex;
}

// ---- Sewing ---------------------------------------------------------------------

template <int D> std::size_t Hole<D>::sew(const Star<D> &star) {
    std::size_t made = star.link().size();
    open_rim(star);
    std::array<VertexIndex, D + 1> independent;
    if (star.is_flat(independent)) {
        const std::size_t rim = facets_.size();
        for (std::size_t n = 0; n < rim; ++n) {
            const Facet &facet = facets_[n];
            if (facet.is_finite()) add(with_infinity<D>(facet.rim.vertex, facet.rim.facet));
        }
    } else {
        made = link_.triangulate(cache_, star, independent);
        filled_.resize(link_.cells());
        const Handle begin{};
        const Handle end = begin + static_cast<std::uint32_t>(link_.cells());
        for (Handle cell = begin; cell != end; cell = cell + 1)
            if (link_.is_inside(cell)) filled_[cell] = create(link_.vertices(cell));
        for (Handle cell = begin; cell != end; cell = cell + 1)
            if (link_.is_inside(cell)) connect(cell);
    }
    require_filled();
    return made;
}

/// Gives the simplex of a cell its neighbours, in the hole or beyond the rim.
template <int D> void Hole<D>::connect(Handle cell) {
    for (int i = 0; i <= D; ++i) {
        const Link beyond = link_.beyond(cell, i);
        const Handle other = link_simplex(beyond);
        if (link_.is_inside(other))
            cache_.point_at(filled_[cell], i, make_link(filled_[other], link_facet(beyond)));
        else
            facets_.meet(cache_, filled_[cell], i);
    }
}

// Not the whole class, since some members exist for one dimension only.
template std::uint64_t Hole<2>::fill(const Star<2> &);
template std::uint64_t Hole<3>::fill(const Star<3> &);

} // namespace abacus
