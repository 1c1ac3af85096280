#include "constrain/fixing.hpp"

#include "geometry/in_words.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace abacus {

namespace {

[[noreturn]] void throw_no_vertex(const Point<2> &p) {
    throw Error(ABACUS_ERROR_ARGUMENT, "mesh has no vertex at " + in_words(p),
                "A line may only have vertices of the mesh.");
}

} // namespace

Fixing::Fixing(Delaunay<2> &mesh, std::size_t most_crossed)
    : mesh_(mesh), cache_(mesh.cache()), patch_(mesh), crossed_(cache_.host()),
      left_(cache_.host()), right_(cache_.host()), left_sides_(cache_.host()),
      right_sides_(cache_.host()), dangling_(cache_.host()), most_crossed_(most_crossed) {}

void Fixing::go(const Point<2> &a, const Point<2> &b, Fixed how) {
    how_ = how;
    limit_ = most_crossed_;
    for (Point<2> at = a; at != b;) {
        cache_.poll();
        at = advance(at, b);
        mesh_.finish(mesh_.anywhere);
    }
}

void Fixing::fix(const Point<2> &a, const Point<2> &b, Fixed how) {
    stays_within_ = false;
    go(a, b, how);
    if (beside_) restore();
}

bool Fixing::fix_within(const Point<2> &a, const Point<2> &b, Fixed how) {
    stays_within_ = true;
    try {
        go(a, b, how);
        return true;
    } catch (const Foreign &) {
    } catch (const Error &error) {
        if (error.kind != ABACUS_ERROR_CROSSING) throw;
    }
    mesh_.finish(mesh_.anywhere);
    return false;
}

Point<2> Fixing::advance(const Point<2> &from, const Point<2> &b) {
    const Link corner = vertex_at(mesh_, from);
    if (corner == unset) throw_no_vertex(from);
    const Way way = straight_on(cache_, corner, b);
    if (way.triangle == no_handle) throw_no_vertex(b);
    return way.is_edge ? fix_edge(way, from, b) : force_edge(way, b);
}

Point<2> Fixing::fix_edge(const Way &way, const Point<2> &from, const Point<2> &b) {
    const Point<2> end = cache_.point(cache_.simplex(way.triangle).vertex[(way.corner + 1) % 3]);
    if (is_behind(from, b, end)) throw_no_vertex(b);
    const Link inner = make_link(way.triangle, (way.corner + 2) % 3);
    if (cache_.fixed(inner) >= how_) return end;
    const Link outer = cache_.cross(way.triangle, (way.corner + 2) % 3);
    for (const Link side : {inner, outer}) {
        cache_.set_fixed(side, how_);
        cache_.mark_dirty(link_simplex(side));
    }
    return end;
}

void Fixing::require_free(Link edge, const Point<2> &from, const Point<2> &b) const {
    const auto &vertex = cache_.simplex(link_simplex(edge)).vertex;
    const Point<2> &x = cache_.point(vertex[(link_facet(edge) + 1) % 3]),
                   &y = cache_.point(vertex[(link_facet(edge) + 2) % 3]);
    if (orientation(x, y, b) >= 0) throw_no_vertex(b); // it is not beyond the edge
    if (cache_.is_fixed(edge))
        throw Error(ABACUS_ERROR_CROSSING, "lines cross",
                    "The segment from " + in_words(from) + " to " + in_words(b) +
                        " crosses a fixed edge from " + in_words(x) + " to " + in_words(y) + ".",
                    "Find all crossings with abacus_crossings().");
}

VertexIndex Fixing::cross(const Way &way, const Point<2> &b) {
    const auto &vertex = cache_.simplex(way.triangle).vertex;
    const int right = (way.corner + 1) % 3, left = (way.corner + 2) % 3;
    const VertexIndex v = vertex[way.corner];
    const Point<2> from = cache_.point(v);
    crossed_.clear();
    left_.begin(v);
    left_.add(make_link(way.triangle, right), vertex[left]);
    right_.begin(v);
    right_.add(make_link(way.triangle, left), vertex[right]);
    const VertexIndex end = go_across(
        cache_, way, b,
        [&](Link edge) {
            crossed_.push_back(link_simplex(edge));
            require_free(edge, from, b);
            if (crossed_.size() < limit_) return true;
            if (stays_within_) throw Foreign{};
            cache_.cross(link_simplex(edge), link_facet(edge));
            closing_ = edge;
            return false;
        },
        [&](Handle h, int apex, int turn) {
            const VertexIndex z = cache_.simplex(h).vertex[apex];
            if (turn >= 0) left_.add(make_link(h, (apex + 2) % 3), z);
            if (turn <= 0) right_.add(make_link(h, (apex + 1) % 3), z);
            if (turn == 0) crossed_.push_back(h);
        });
    if (end == infinite_vertex) throw_no_vertex(b);
    for (const Bank *bank : {&left_, &right_})
        for (const Link edge : bank->edges) cache_.cross(link_simplex(edge), link_facet(edge));
    for (const Bank *bank : {&left_, &right_}) require_within(*bank);
    return end;
}

// The new triangles have corners from a bank. None of their codes is above the interval, as no code
// of the triangles crossed is. So it is enough if no more than two are below it.
void Fixing::require_within(const Bank &bank) const {
    int below = 0;
    for (const VertexIndex v : bank.vertices) below += !cache_.keeps(cache_.vertices()[v].code);
    if (below > 2) throw Foreign{};
}

void Fixing::cut_out() {
    for (const Handle h : crossed_) {
        if (mesh_.log != nullptr) mesh_.log->go(cache_, h);
        cache_.destroy(h);
    }
    mesh_.count(-static_cast<std::int64_t>(crossed_.size()), 0);
}

void Fixing::meet(const Bank &bank, Arena<Patch::Side> &sides) {
    sides.resize(bank.edges.size());
    for (std::size_t i = 0; i < bank.edges.size(); ++i) {
        const Link inner = bank.edges[i],
                   outer = cache_.simplex(link_simplex(inner)).link[link_facet(inner)];
        if (mesh_.marks.get(link_simplex(outer)) == Marks::none)
            sides[i] = patch_.outside(outer);
        else
            dangling_.push_back({inner, outer, &sides[i]});
    }
}

void Fixing::pair_up() {
    const auto comes_before = [](const Dangling &a, const Dangling &b) {
        return a.inner < b.inner;
    };
    std::sort(dangling_.begin(), dangling_.end(), comes_before);
    for (const Dangling &one : dangling_) {
        if (one.outer < one.inner) continue;
        const Dangling *const other =
            std::lower_bound(dangling_.begin(), dangling_.end(),
                             Dangling{one.outer, one.inner, nullptr}, comes_before);
        if (other == dangling_.end() || other->inner != one.outer) throw_no_triangulation();
        const auto sides = patch_.inside(cache_.fixed(one.inner));
        *one.side = sides[0];
        *other->side = sides[1];
    }
}

Point<2> Fixing::force_edge(const Way &way, const Point<2> &b) {
    const VertexIndex from = cache_.simplex(way.triangle).vertex[way.corner], end = cross(way, b);
    const Point<2> next = cache_.point(end);
    if (end == from)
        make_funnel();
    else
        fill_sides();
    return next;
}

void Fixing::begin_patch() {
    patch_.begin();
    patch_.set_region(cache_.region(crossed_[0])); // all are in the same
    dangling_.clear();
    for (const Handle h : crossed_) mesh_.marks.set(h, Marks::inside);
    meet(left_, left_sides_);
    meet(right_, right_sides_);
    for (const Handle h : crossed_) mesh_.marks.set(h, Marks::none);
    pair_up();
}

void Fixing::make_funnel() {
    begin_patch();
    const Patch::Side end =
        patch_.outside(cache_.simplex(link_simplex(closing_)).link[link_facet(closing_)]);
    cut_out();
    const std::size_t beside = patch_.fill_funnel({right_.vertices.data(), right_.vertices.size()},
                                                  {right_sides_.data(), right_sides_.size()},
                                                  {left_.vertices.data(), left_.vertices.size()},
                                                  {left_sides_.data(), left_sides_.size()}, end);
    if (!beside_) beside_.emplace(cache_.host(), 4);
    patch_.finish_as_is(beside, [&](VertexIndex a, VertexIndex b) {
        std::uint64_t *const record = beside_->add();
        std::memcpy(record, cache_.point(a).data(), sizeof(Point<2>));
        std::memcpy(record + 2, cache_.point(b).data(), sizeof(Point<2>));
    });
    limit_ = std::max(limit_, 4 * (crossed_.size() - beside));
}

void Fixing::restore() {
    Restoring restoring(mesh_);
    beside_->rewind();
    while (const std::uint64_t *const record = beside_->next()) {
        Point<2> a, b;
        std::memcpy(a.data(), record, sizeof a);
        std::memcpy(b.data(), record + 2, sizeof b);
        restoring.restore(a, b);
    }
    beside_->close();
    beside_.reset();
}

void Fixing::fill_sides() {
    begin_patch();
    cut_out();
    const Patch::Side right = patch_.fill_chain({right_.vertices.data(), right_.vertices.size()},
                                                {right_sides_.data(), right_sides_.size()});
    // The left bank counterclockwise.
    std::reverse(left_.vertices.begin(), left_.vertices.end());
    std::reverse(left_sides_.begin(), left_sides_.end());
    const Patch::Side left = patch_.fill_chain({left_.vertices.data(), left_.vertices.size()},
                                               {left_sides_.data(), left_sides_.size()});
    patch_.join(left, right, how_);
    patch_.finish();
}

} // namespace abacus
