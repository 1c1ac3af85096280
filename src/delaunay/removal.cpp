#include "delaunay/removal.hpp"

namespace abacus {

namespace {
// Removals come in any order, so what lies before a vertex on the curve is not finished: a
// block that is full after all is cut at its median, not at the vertex.
constexpr std::uint64_t anywhere = 0;
} // namespace

template <int D> bool Removal<D>::find(const Point<D> &p, std::uint64_t code) {
    if (mesh_.simplices() == 0) return false;
    Handle recent = no_handle;
    for (const Handle h : mesh_.recent()) {
        if (!cache_.is_live(h)) continue;
        const int corner = mesh_.corner_at(h, p);
        if (corner >= 0) {
            star_.collect(h, corner);
            return true;
        }
        recent = h;
    }
    const Handle h = mesh_.locate(p, code, recent);
    const int corner = mesh_.corner_at(h, p);
    if (corner >= 0) star_.collect(h, corner);
    return corner >= 0;
}

template <int D> bool Removal<D>::collapses() const {
    // If a finite simplex is left, its vertices are. If none is, the others are the link.
    const std::size_t finite = star_.simplices().size() - star_.ghosts();
    std::array<VertexIndex, D + 1> independent;
    return static_cast<std::int64_t>(finite) == mesh_.simplices() && star_.is_flat(independent);
}

template <int D> Removed Removal<D>::remove(const Point<D> &p) {
    const std::uint64_t code = cache_.domain().code(p);
    if (!find(p, code)) {
        mesh_.finish(anywhere);
        return Removed::no_such_vertex;
    }
    if (collapses()) return Removed::collapses;
    const auto ghosts = static_cast<std::int64_t>(star_.ghosts());
    const auto simplices = static_cast<std::int64_t>(star_.simplices().size()) - ghosts;
    for (const Handle h : star_.simplices()) cache_.destroy(h);
    mesh_.count(-simplices, -ghosts);
    hole_.fill(star_);
    cache_.destroy_vertex(star_.vertex());
    ++cache_.counters.removals;
    mesh_.finish(anywhere);
    return Removed::removed;
}

template <int D> std::optional<std::int64_t> Removal<D>::id_at(const Point<D> &p) {
    if (!find(p, cache_.domain().code(p))) return std::nullopt;
    return cache_.vertices().id(star_.vertex());
}

template <int D>
bool Removal<D>::rename(const Point<D> &p, std::int64_t id, const double *attributes) {
    const std::uint64_t code = cache_.domain().code(p);
    const bool found = find(p, code);
    if (found) {
        for (const Handle h : star_.simplices()) cache_.mark_dirty(h);
        cache_.rename_vertex(star_.vertex(), id, attributes);
    }
    mesh_.finish(anywhere);
    return found;
}

template class Removal<2>;
template class Removal<3>;

} // namespace abacus
