#include "delaunay/link_mesh.hpp"

#include "geometry/conflict.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

namespace {

/// With fewer neighbours the order does not matter.
constexpr std::size_t few_neighbours = 24;

/// Half of all numbers are in round 0, the last one, a quarter in round -1, and so on.
int round_of(std::uint64_t n) {
    const std::uint64_t draw = (n + 1) * 0x9e3779b97f4a7c15ull;
    return -std::countl_zero((draw ^ (draw << 32)) | 1);
}

} // namespace

template <int D>
std::size_t LinkMesh<D>::triangulate(const Cache<D> &cache, const Star<D> &star,
                                     const Vertices &independent) {
    list(cache, star, independent);
    start();
    for (std::size_t n = 0; n < order_.size(); ++n) {
        if (n % 256 == 255) host_.poll();
        insert(order_[n].vertex);
    }
    return made_;
}

template <int D>
void LinkMesh<D>::list(const Cache<D> &cache, const Star<D> &star, const Vertices &independent) {
    points_.clear();
    names_.clear();
    order_.clear();
    const auto add = [&](VertexIndex v) {
        names_.push_back(v);
        points_.push_back(cache.point(v));
    };
    names_.push_back(infinite_vertex);
    points_.push_back({});
    add(star.vertex());
    for (const VertexIndex v : independent) add(v);
    for (const VertexIndex v : star.link()) {
        if (v == infinite_vertex ||
            std::find(independent.begin(), independent.end(), v) != independent.end())
            continue;
        const auto number = static_cast<std::uint32_t>(names_.size());
        order_.push_back({round_of(number), cache.vertices()[v].code, VertexIndex{number}});
        add(v);
    }
    const std::size_t n = names_.size();
    most_ = std::min(n * n, std::size_t{1} << 29);
    if (n < few_neighbours) return;
    std::sort(order_.begin(), order_.end(), [](const Place &a, const Place &b) {
        return a.round != b.round ? a.round < b.round : a.code < b.code;
    });
}

template <int D> Handle LinkMesh<D>::create(const Simplex<D> &s) {
    Handle h;
    ++made_;
    if (free_.empty()) {
        if (cells_.size() >= most_) throw_no_triangulation();
        h = Handle{static_cast<std::uint32_t>(cells_.size())};
        cells_.push_back({s, false});
    } else {
        h = free_.back();
        free_.pop_back();
        cells_[h] = {s, false};
    }
    return h;
}

/// The first simplex and its ghosts. The ball keeps some of them; cones replace the others.
template <int D> void LinkMesh<D>::start() {
    made_ = 0;
    cells_.clear();
    free_.clear();
    killed_.clear();
    Vertices first;
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) {
        first[i] = VertexIndex{to_number(apex) + 1 + static_cast<std::uint32_t>(i)};
        corners[i] = &points_[first[i]];
    }
    if (orientation<D>(corners) < 0) std::swap(first[0], first[1]);
    create({first, {}});
    for (int i = 0; i <= D; ++i) create({ghost_on(first, i, infinite_vertex), {}});
    const Handle begin{};
    const Handle end = begin + (D + 2);
    for (Handle a = begin; a != end; a = a + 1)
        for (Handle b = begin; b != end; b = b + 1)
            for (int i = 0; i <= D; ++i)
                for (int j = 0; j <= D; ++j) {
                    const FacetVertices<D, VertexIndex> f(cells_[a].simplex.vertex, i);
                    const FacetVertices<D, VertexIndex> g(cells_[b].simplex.vertex, j);
                    if (a != b && f.vertex == g.vertex) cells_[a].simplex.link[i] = make_link(b, j);
                }
    for (Handle h = begin; h != end; h = h + 1)
        if (!is_in_conflict(cells_[h].simplex, points_[apex])) kill(h);
    fill(apex);
}

template <int D> bool LinkMesh<D>::is_in_conflict(const Simplex<D> &s, const Point<D> &p) const {
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &points_[s.vertex[i]];
    if (apex_of(s) != none) std::swap(corners[0], corners[1]);
    const Side side = s.is_ghost() ? side_of_ghost<D>(corners, p) : side_of_simplex<D>(corners, p);
    return side == Side::inside;
}

/// The cone in which q sees p, or the ghost's cone if p lies beyond its facet at q.
template <int D> Handle LinkMesh<D>::locate(const Point<D> &p) const {
    Handle h = cone_;
    if (cells_[h].simplex.is_ghost()) h = link_simplex(cells_[h].simplex.link[D]);
    int entered = none;
    for (std::size_t steps = 0; steps <= cells_.size(); ++steps) {
        const Simplex<D> &s = cells_[h].simplex;
        if (s.is_ghost()) return h;
        const int at = apex_of(s);
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) corners[i] = &points_[s.vertex[i]];
        int beyond = none;
        for (int i = 0; i <= D && beyond == none; ++i)
            if (i != at && i != entered && facet_side<D>(corners, i, p) > 0) beyond = i;
        if (beyond == none) return h;
        h = link_simplex(s.link[beyond]);
        entered = link_facet(s.link[beyond]);
    }
    throw_no_triangulation();
}

template <int D> void LinkMesh<D>::insert(VertexIndex v) {
    const Point<D> &p = points_[v];
    const Handle first = locate(p);
    if (!is_in_conflict(cells_[first].simplex, p)) throw_no_triangulation();
    killed_.clear();
    kill(first);
    for (std::size_t n = 0; n < killed_.size(); ++n) {
        if (n % 4096 == 4095) host_.poll();
        for (const Link link : cells_[killed_[n]].simplex.link) {
            const Handle h = link_simplex(link);
            if (!cells_[h].is_killed && is_in_conflict(cells_[h].simplex, p)) kill(h);
        }
    }
    fill(v);
}

template <int D> void LinkMesh<D>::fill(VertexIndex v) {
    created_.clear();
    for (const Handle h : killed_) join(h, v);
    if (created_.empty()) throw_no_triangulation();
    for (const Handle h : killed_)
        for (int i = 0; i <= D; ++i)
            if (!cells_[link_simplex(cells_[h].simplex.link[i])].is_killed)
                for (int k = 0; k <= D; ++k)
                    if (k != i) meet(h, i, k);
    for (const Handle h : killed_) {
        cells_[h].simplex.vertex[0] = free_mark;
        free_.push_back(h);
    }
    cone_ = no_handle;
    for (const Handle h : created_)
        if (apex_of(cells_[h].simplex) != none) cone_ = h;
    if (cone_ == no_handle) throw_no_triangulation();
}

/// Creates new simplices on the facets of a killed simplex to neighbours that stay: v replaces the
/// corner opposite.
template <int D> void LinkMesh<D>::join(Handle h, VertexIndex v) {
    for (int i = 0; i <= D; ++i) {
        const Link outer = cells_[h].simplex.link[i];
        if (cells_[link_simplex(outer)].is_killed) continue;
        Simplex<D> s = cells_[h].simplex;
        s.vertex[i] = v;
        const Handle created = create(s);
        cells_[link_simplex(outer)].simplex.link[link_facet(outer)] = make_link(created, i);
        created_.push_back(created);
    }
}

/// Finds the neighbour of the new simplex on facet `rim` of a killed one, across the new one's
/// facet `facet`. Turns around the ridge that both facets share, through killed simplices.
template <int D> void LinkMesh<D>::meet(Handle h, int rim, int facet) {
    const auto created_on = [&](Handle killed, int i) {
        const Link outer = cells_[killed].simplex.link[i];
        return link_simplex(cells_[link_simplex(outer)].simplex.link[link_facet(outer)]);
    };
    const Handle created = created_on(h, rim);
    int front = facet, back = rim; // the corners that are not on the ridge
    for (;;) {
        const Link link = cells_[h].simplex.link[front];
        if (!cells_[link_simplex(link)].is_killed) break;
        const VertexIndex shared = cells_[h].simplex.vertex[back];
        h = link_simplex(link);
        back = link_facet(link);
        front = cells_[h].simplex.index_of(shared);
    }
    cells_[created].simplex.link[facet] = make_link(created_on(h, front), back);
}

template class LinkMesh<2>;
template class LinkMesh<3>;

} // namespace abacus
