#include "delaunay/removal.hpp"

#include <algorithm>
#include <cstring>

namespace abacus {

namespace {
constexpr Link nowhere = unset;
} // namespace

template <int D> Link Removal<D>::find(const Point<D> &p) {
    if (mesh_.simplices() == 0) return nowhere;
    Handle recent = no_handle;
    for (const Handle h : mesh_.recent()) {
        if (!cache_.is_live(h)) continue;
        const int corner = mesh_.corner_at(h, p);
        if (corner >= 0) return make_link(h, corner);
        recent = h;
    }
    const Handle h = mesh_.locate(p, cache_.domain().code(p), recent);
    const int corner = mesh_.corner_at(h, p);
    return corner < 0 ? nowhere : make_link(h, corner);
}

template <int D> bool Removal<D>::collapses() const {
    // If a finite simplex remains, so do its vertices. If none does, the other vertices are the
    // link.
    const std::size_t finite = star_.simplices().size() - star_.ghosts();
    std::array<VertexIndex, D + 1> independent;
    return static_cast<std::int64_t>(finite) == mesh_.simplices() && star_.is_flat(independent);
}

template <int D> Link Removal<D>::find(const Point<D> &p, Leaving *want) {
    const Link corner = find(p);
    if (corner == nowhere || want == nullptr) return corner;
    const VertexIndex v = vertex_of(corner);
    return want->takes(cache_.vertices().id(v), attributes_of(v, want->compares_attributes()))
               ? corner
               : nowhere;
}

template <int D> const double *Removal<D>::attributes_of(VertexIndex v, bool are_compared) {
    if (attributes_ == nullptr) return cache_.vertices().attributes(v);
    if (!are_compared) return nullptr;
    const Vertex<D> &vertex = cache_.vertices()[v];
    attributes_->get(vertex.point, vertex.code, values_.data());
    return values_.data();
}

template <int D> bool Removal<D>::finds(const Point<D> &p, Leaving *want) {
    const Link corner = find(p, want);
    mesh_.finish(mesh_.anywhere);
    return corner != nowhere;
}

template <int D> Removed Removal<D>::remove(const Point<D> &p, Leaving *want) {
    if (!find_star(p, want)) {
        mesh_.finish(mesh_.anywhere);
        return Removed::no_such_vertex;
    }
    if (fixed_edges() > 0) require_removable();
    if (collapses()) return Removed::collapses;
    take_out();
    mesh_.finish(mesh_.anywhere);
    return Removed::removed;
}

template <int D> std::optional<bool> Removal<D>::remove_within(const Point<D> &p, Leaving &want) {
    bool found;
    try {
        found = find_star(p, &want);
    } catch (const Foreign &) {
        star_.give_up();
        mesh_.finish(mesh_.anywhere);
        return {};
    }
    // Lines are the session's concern.
    const bool leaves = found && !collapses() && stays_within() && fixed_edges() == 0;
    if (leaves) take_out();
    mesh_.finish(mesh_.anywhere);
    if (found && !leaves) return {};
    return found;
}

template <int D> bool Removal<D>::find_star(const Point<D> &p, Leaving *want) {
    const Link corner = find(p, want);
    if (corner == nowhere) return false;
    star_.collect(link_simplex(corner), link_facet(corner));
    return true;
}

// The hole's simplices have D + 1 corners from the link. None of their codes is above the interval,
// as no code of the star's simplices is. So it is enough if no more than D are below it.
template <int D> bool Removal<D>::stays_within() const {
    int below = 0;
    for (const VertexIndex v : star_.link()) below += !cache_.keeps(cache_.vertices()[v].code);
    return below <= D;
}

template <int D> std::size_t Removal<D>::fixed_edges() {
    if constexpr (D == 2)
        if (mesh_.is_constrained) return refill_.look_at(star_);
    return 0;
}

template <int D> void Removal<D>::require_removable() {
    if constexpr (D == 2) refill_.require_removable(star_, lines_);
}

template <int D> void Removal<D>::take_out() {
    const auto ghosts = static_cast<std::int64_t>(star_.ghosts());
    const auto simplices = static_cast<std::int64_t>(star_.simplices().size()) - ghosts;
    for (const Handle h : star_.simplices()) {
        if (mesh_.log != nullptr) mesh_.log->go(cache_, h);
        cache_.destroy(h);
    }
    mesh_.count(-simplices, -ghosts);
    effort_ += star_.simplices().size() + fill_hole();
    cache_.destroy_vertex(star_.vertex());
    ++cache_.counters.removals;
}

template <int D> std::uint64_t Removal<D>::fill_hole() {
    if constexpr (D == 2)
        if (mesh_.is_constrained) return refill_.fill(star_);
    return hole_.fill(star_);
}

template <int D> std::optional<bool> Removal<D>::offer(const Point<D> &p, Leaving &leaving) {
    const Link corner = find(p);
    std::optional<bool> more;
    if (corner != nowhere) {
        const VertexIndex v = vertex_of(corner);
        more = leaving.offer(cache_.vertices().id(v),
                             attributes_of(v, leaving.compares_attributes()), 0);
    }
    mesh_.finish(mesh_.anywhere);
    return more;
}

template <int D>
bool Removal<D>::rename(const Point<D> &p, std::int64_t id, const double *attributes) {
    const Link corner = find(p);
    const bool is_same = corner != nowhere && cache_.vertices().attribute_count() == 0 &&
                         cache_.vertices().id(vertex_of(corner)) == id;
    if (corner != nowhere && !is_same) rewrite(corner, id, attributes);
    mesh_.finish(mesh_.anywhere);
    return corner != nowhere;
}

template <int D> void Removal<D>::rewrite(Link corner, std::int64_t id, const double *attributes) {
    star_.collect(link_simplex(corner), link_facet(corner));
    for (const Handle h : star_.simplices()) {
        cache_.mark_dirty(h);
        if (mesh_.log != nullptr) mesh_.log->go(cache_, h);
    }
    cache_.rename_vertex(star_.vertex(), id, attributes);
    if (mesh_.log != nullptr) // the ids of its vertices identify a simplex
        for (const Handle h : star_.simplices()) mesh_.log->come(cache_, h);
}

template <int D>
std::optional<std::int64_t> Removal<D>::id_at(const Point<D> &p, std::span<double> attributes) {
    const Link corner = find(p);
    std::optional<std::int64_t> id;
    if (corner != nowhere) {
        const VertexIndex v = vertex_of(corner);
        id = cache_.vertices().id(v);
        if (!attributes.empty())
            std::copy_n(attributes_of(v, true), attributes.size(), attributes.begin());
    }
    mesh_.finish(mesh_.anywhere);
    return id;
}

template <int D>
bool Removal<D>::set_attributes(const Point<D> &p, std::span<const std::uint32_t> which,
                                const double *values) {
    const Link corner = find(p);
    if (corner != nowhere) {
        const VertexIndex v = vertex_of(corner);
        const double *now = cache_.vertices().attributes(v);
        const auto count = static_cast<std::size_t>(cache_.vertices().attribute_count());
        std::copy_n(now, count, values_.begin());
        for (std::size_t i = 0; i < which.size(); ++i) values_[which[i]] = values[i];
        if (std::memcmp(now, values_.data(), count * sizeof *now) != 0)
            rewrite(corner, cache_.vertices().id(v), values_.data());
    }
    mesh_.finish(mesh_.anywhere);
    return corner != nowhere;
}

template class Removal<2>;
template class Removal<3>;

} // namespace abacus
