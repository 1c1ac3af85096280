#include "query/shapes/voronoi.hpp"

#include "query/locate/require_delaunay.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/shapes/ridge_turn.hpp"

#include <algorithm>

namespace abacus {

namespace {

/// Whether the ball around a simplex may meet the box. True if it does, whatever is rounded.
template <int D> bool ball_may_meet(const Corners<D> &corners, const Box<D> &box) {
    const Point<D> centre = circumcentre<D>(corners, Rounding::whenever);
    // The error of the centre is at most 1e-10 of its distance from the corners.
    const double radius = distance<D>(centre, *corners[0]);
    return !(distance<D>(centre, box.nearest(centre)) > radius * (1 + 1e-8));
}

/// The same for the half-space beyond the facet of a ghost, whose last corner is not read.
template <int D> bool half_space_may_meet(const Corners<D> &corners, const Box<D> &box) {
    for (int i = 0; i < 1 << D; ++i)
        if (facet_side<D>(corners, D, box.corner(i)) >= 0) return true;
    return false;
}

template <int D> bool may_meet(const Corners<D> &corners, bool is_ghost, const Box<D> &box) {
    return is_ghost ? half_space_may_meet<D>(corners, box) : ball_may_meet<D>(corners, box);
}

} // namespace

template <int D>
Voronoi<D>::Voronoi(const Host &host, const abacus_facts &facts, const abacus_window &window,
                    std::size_t cache_bytes)
    : host_(host), facts_(facts), reader_(host, facts, cache_bytes), cache_(reader_.cache()),
      open_(host), numbers_(host), star_(host), neighbours_(host), labels_(host), centres_(host),
      shape_(host) {
    require_delaunay(reader_, "Voronoi cells need", "Load the mesh with retriangulate => true.");
    if (window.kind == ABACUS_BOX_WINDOW) {
        box_.emplace();
        std::copy_n(window.lower, D, box_->lower.begin());
        std::copy_n(window.upper, D, box_->upper.begin());
    }
    if (reader_.is_empty()) page_ = end_key;
    if (reader_.is_empty() || !box_) return;
    const BoxRegion<D> region(*box_);
    if (region.has_much_of(cache_.domain())) return;
    flood_.emplace(host_, facts_);
    flood_->reach(reader_.page_around(region.inside(cache_.domain()))->page);
}

// ---- Pages ------------------------------------------------------------------------------

template <int D> bool Voronoi<D>::next_page() {
    if (!flood_) return page_ < end_key;
    if (!flood_->advance()) return false;
    const PageView<D> &page = flood_->page();
    flood_->spread([&](int simplex, int) {
        const bool is_ghost = page.is_ghost(simplex);
        Corners<D> corners{};
        for (int i = 0; i < D + !is_ghost; ++i) corners[i] = &page.point(page.corner(simplex, i));
        return may_meet<D>(corners, is_ghost, *box_);
    });
    page_ = page.lower();
    return true;
}

template <int D> bool Voronoi<D>::is_in_zone(Handle h) const {
    if (!box_) return true;
    const Simplex<D> &s = cache_.simplex(h);
    return may_meet<D>(cache_.corners(s), s.is_ghost(), *box_);
}

template <int D> void Voronoi<D>::list_corners() {
    cache_.trim();
    cache_.poll();
    numbers_.clear();
    page_ = cache_.visit(page_, [&](Handle h) {
        if (!is_in_zone(h)) return;
        const Simplex<D> &s = cache_.simplex(h);
        for (int i = 0; i < s.finite_vertices(); ++i)
            if (cache_.number(numbers_, s.vertex[i]) == open_.size())
                open_.push_back(make_link(h, i));
    });
}

template <int D> bool Voronoi<D>::is_own(Link corner) {
    const Handle h = link_simplex(corner);
    const Key own = cache_.lower(h);
    bool is_first = true;
    star_.clear();
    reader_.flood().around(cache_, h, cache_.simplex(h).vertex[link_facet(corner)],
                           [&](Handle met) {
                               cache_.use(met);
                               star_.push_back(met);
                               is_first = own <= cache_.lower(met) || !is_in_zone(met);
                               return is_first;
                           });
    return is_first;
}

template <int D> bool Voronoi<D>::advance() {
    for (;;) {
        while (open_.empty()) {
            if (!next_page()) return false;
            list_corners();
        }
        const Link corner = open_.back();
        open_.pop_back();
        if (is_own(corner) && make_cell(corner)) return true;
    }
}

// ---- Cells ------------------------------------------------------------------------------

template <int D> Point<D> Voronoi<D>::centre(Handle h) {
    std::array<Point<D>, D + 1> points;
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) {
        points[i] = cache_.point(cache_.simplex(h).vertex[i]);
        corners[i] = &points[i];
    }
    const Point<D> centre = circumcentre<D>(corners, Rounding::whenever);
    const double radius = distance<D>(centre, points[0]);
    for (int i = 0; i <= D; ++i) {
        const Link beyond = cache_.cross(h, i);
        const VertexIndex apex = cache_.simplex(link_simplex(beyond)).vertex[link_facet(beyond)];
        if (apex == infinite_vertex) continue;
        const Point<D> &p = cache_.point(apex);
        // Nearly always ten correct digits are enough to show that a point is not on the sphere.
        if (std::abs(distance<D>(centre, p) - radius) > 1e-7 * radius) continue;
        if (exact::unperturbed_in_sphere<D>(corners, p) == 0)
            return circumcentre<D>(corners, Rounding::at_the_end);
    }
    return centre;
}

template <int D> void Voronoi<D>::collect_centres() {
    is_bounded_ = true;
    centres_.clear();
    for (std::size_t n = 0; n < star_.size(); ++n) {
        if (n % 1024 == 1023) cache_.poll();
        if (cache_.simplex(star_[n]).is_ghost())
            is_bounded_ = false;
        else
            centres_.push_back({star_[n], centre(star_[n])});
    }
    std::sort(centres_.begin(), centres_.end(),
              [](const Centre &a, const Centre &b) { return a.simplex < b.simplex; });
}

template <int D> void Voronoi<D>::collect_neighbours(VertexIndex v) {
    numbers_.clear();
    neighbours_.clear();
    for (const Handle h : star_) {
        const Simplex<D> &s = cache_.simplex(h);
        for (int i = 0; i < s.finite_vertices(); ++i) {
            const VertexIndex w = s.vertex[i];
            if (w != v && cache_.number(numbers_, w) == neighbours_.size())
                neighbours_.push_back({cache_.point(w), cache_.vertices().id(w), w, h});
        }
    }
    std::sort(neighbours_.begin(), neighbours_.end(), [](const Neighbour &a, const Neighbour &b) {
        return lexicographically_less<D>(a.point, b.point);
    });
    labels_.resize(neighbours_.size());
    for (std::size_t n = 0; n < neighbours_.size(); ++n) {
        labels_[cache_.number(numbers_, neighbours_[n].vertex)] = static_cast<std::uint32_t>(n);
        shape_.add_neighbour(neighbours_[n].point);
    }
}

template <int D> int Voronoi<D>::label(VertexIndex v) {
    if (v == infinite_vertex) return Shape::no_label;
    return static_cast<int>(labels_[cache_.number(numbers_, v)]);
}

template <int D>
void Voronoi<D>::add_ring(Handle first, const std::array<VertexIndex, D - 1> &ridge) {
    turn_around<D>(cache_, first, ridge, [&](Handle h, VertexIndex kept) {
        if (cache_.simplex(h).is_ghost()) {
            shape_.add_corner_at_infinity(label(kept));
            return;
        }
        const Centre *const found =
            std::lower_bound(centres_.begin(), centres_.end(), h,
                             [](const Centre &c, Handle wanted) { return c.simplex < wanted; });
        shape_.add_corner(found->at, label(kept));
    });
}

template <int D> void Voronoi<D>::shape_by_mesh(VertexIndex v) {
    if constexpr (D == 2) {
        shape_.add_face(Shape::no_label);
        add_ring(star_[0], {v});
    } else {
        for (std::size_t n = 0; n < neighbours_.size(); ++n) {
            shape_.add_face(static_cast<int>(n));
            add_ring(neighbours_[n].simplex, {v, neighbours_[n].vertex});
        }
    }
}

template <int D> bool Voronoi<D>::make_cell(Link corner) {
    const VertexIndex v = cache_.simplex(link_simplex(corner)).vertex[link_facet(corner)];
    vertex_ = cache_.point(v);
    id_ = cache_.vertices().id(v);
    shape_.begin(vertex_);
    collect_centres(); // loads everything around the vertex
    collect_neighbours(v);
    const bool is_whole =
        !box_ ||
        (is_bounded_ && std::all_of(centres_.begin(), centres_.end(),
                                    [&](const Centre &c) { return box_->contains(c.at); }));
    if (is_whole) {
        shape_by_mesh(v);
    } else {
        shape_.fill(*box_);
        for (std::size_t n = 0; n < neighbours_.size() && !shape_.is_empty(); ++n) {
            if (n % 64 == 63) cache_.poll();
            shape_.cut(static_cast<int>(n));
        }
    }
    shape_.tidy();
    return !box_ || !shape_.is_empty();
}

template class Voronoi<2>;
template class Voronoi<3>;

} // namespace abacus
