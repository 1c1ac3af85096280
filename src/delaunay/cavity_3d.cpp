#include "delaunay/cavity.hpp"
#include "delaunay/conflict.hpp"

namespace abacus {

Cavity<3>::Cavity(Delaunay<3> &mesh)
    : CavityInside(mesh), ridges_(cache_.host()), rim_vertices_(cache_.host()),
      rim_(cache_.host()), stack_(cache_.host()) {}

void Cavity<3>::find(const Point<3> &p, Handle first) {
    inside_.clear();
    rim_.clear();
    stack_.clear();
    add(first);
    mesh_.marks.set(first, Marks::inside);
    Link *top = stack_.extend(4);
    for (int i = 3; i >= 0; --i) *top++ = make_link(first, i);
    while (!stack_.empty()) {
        // The inner side of a facet: the outer one is asked for anew, since loading for an
        // earlier facet may have linked it.
        const Link inner = stack_.back();
        stack_.pop_back();
        const Link outer = cache_.cross(link_simplex(inner), link_facet(inner));
        const Handle h = link_simplex(outer);
        Marks::Mark mark = mesh_.marks.get(h);
        if (mark == Marks::inside) continue; // came back to the cavity from within
        if (mark == Marks::none) {
            mark = side_of<3>(cache_, cache_.simplex(h), p) == Side::inside ? Marks::inside
                                                                            : Marks::outside;
            mesh_.marks.set(h, mark);
        }
        if (mark == Marks::inside) {
            add(h);
            top = stack_.extend(3);
            for (int i = 3, facet = link_facet(outer); i > 0; --i) {
                facet = facet == 0 ? 3 : facet - 1;
                *top++ = make_link(h, facet);
            }
        } else {
            rim_.push_back({outer, link_facet(inner), cache_.simplex(link_simplex(inner)).vertex});
        }
    }
}

void Cavity<3>::fill(VertexIndex v) {
    std::int64_t ghosts = -hollow_out();
    for (const Handle h : inside_) mesh_.marks.set(h, Marks::none);
    ridges_.reset(rim_.size() * 3);
    rim_vertices_.clear();
    for (std::size_t n = 0; n < rim_.size(); ++n) {
        Rim<3> &rim = rim_[n];
        mesh_.marks.set(link_simplex(rim.outer), Marks::none);
        ghosts += rim.vertex[3] == infinite_vertex && rim.facet != 3;
        // v lies on the same side as the vertex in whose place it comes, so the orientation
        // stays, and a ghost's point at infinity stays last.
        rim.vertex[rim.facet] = v;
        const Handle h = cache_.create(rim.vertex);
        mesh_.remember(n, h);
        cache_.connect(make_link(h, rim.facet), rim.outer);
        cache_.mark_dirty(link_simplex(rim.outer));
        // The facets besides the rim's: each has v and one edge of that.
        std::array<std::uint32_t, 3> number;
        std::array<Link, 3> link;
        for (int i = 0, k = 0; i <= 3; ++i) {
            if (i == rim.facet) continue;
            number[k] = cache_.number(rim_vertices_, rim.vertex[i]);
            link[k++] = make_link(h, i);
        }
        for (int i = 0; i < 3; ++i) {
            const Link other = ridges_.match(number[(i + 1) % 3], number[(i + 2) % 3], link[i]);
            if (other != Ridges::unmatched) cache_.connect(other, link[i]);
        }
    }
    mesh_.count(static_cast<std::int64_t>(rim_.size() - inside_.size()) - ghosts, ghosts);
}

} // namespace abacus
