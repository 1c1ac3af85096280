#include "delaunay/cached_conflict.hpp"
#include "delaunay/cavity.hpp"

#include <algorithm>

namespace abacus {

namespace {

/// The slots of the corners a, b, c, u in a tetrahedron whose corner u is in slot [u]. The second
/// index says whether a is in the first, second or third of the other slots, in their
/// counterclockwise order as seen from u. Seen from outside, across the facet, a, b, c are
/// counterclockwise, so u sees them clockwise.
constexpr std::array<std::array<std::array<std::uint8_t, 4>, 3>, 4> slots_beyond = [] {
    constexpr std::uint8_t others[4][3] = {{2, 1, 3}, {0, 2, 3}, {1, 0, 3}, {0, 1, 2}};
    std::array<std::array<std::array<std::uint8_t, 4>, 3>, 4> slots{};
    for (std::uint8_t u = 0; u < 4; ++u)
        for (int a = 0; a < 3; ++a)
            slots[u][a] = {others[u][a], others[u][(a + 2) % 3], others[u][(a + 1) % 3], u};
    return slots;
}();

} // namespace

Cavity<3>::Cavity(Delaunay<3> &mesh)
    : CavityInside(mesh), corners_(cache_.host()), seen_(cache_.host()), codes_(cache_.host()),
      edges_(cache_.host()), facets_(cache_.host()), rim_(cache_.host()), created_(cache_.host()),
      ridges_(cache_.host()) {
    make_room();
}

void Cavity<3>::make_room() {
    const std::size_t room = 2 * corners_.size() + 64;
    corners_.reserve(room + 1);
    seen_.reserve(room);
    codes_.reserve(room);
}

inline std::uint32_t Cavity<3>::add_corner(VertexIndex v, const SeenPoint<3> &point) {
    // Whether it is new is hard to predict, so its values are written in either case.
    const std::uint32_t number = cache_.number_in_room(corners_, v);
    if (number >= seen_.capacity()) [[unlikely]]
        make_room();
    seen_[number] = point;
    codes_[number] = cache_.vertices()[v].code;
    return number;
}

inline LiftedPlane Cavity<3>::plane(const Facet &facet) const {
    const auto &[s, t, u] = facet.corner;
    const auto &[st, su, tu] = facet.edge;
    return lifted_plane(seen_[s], seen_[t], seen_[u], edges_[st], edges_[su], edges_[tu],
                        facet.sign);
}

bool Cavity<3>::is_exactly_inside(Handle h, const Point<3> &p) const {
    return side_of<3>(cache_, cache_.simplex(h), p) == Side::inside;
}

void Cavity<3>::find(const Point<3> &p, Handle first) {
    begin(p, first);
    Batch batch;
    for (std::size_t at = 1; at < facets_.size();) {
        at += look_beyond(at, batch);
        test(batch, p);
        sort_out(batch);
        for (std::size_t n = 0; n < batch.entered; ++n) enter(batch.beyond[batch.to_enter[n]]);
    }
}

inline std::size_t Cavity<3>::look_beyond(std::size_t at, Batch &batch) {
    const std::size_t facets = std::min(Batch::most, facets_.size() - at);
    // Links are read again, since loading for another facet may have set them.
    std::array<Link, Batch::most> outer;
    std::uint32_t all = 0;
    for (std::size_t n = 0; n < facets; ++n) {
        const Link inner = facets_[at + n].inner;
        outer[n] = cache_.simplex(link_simplex(inner)).link[link_facet(inner)];
        all |= to_bits(outer[n]);
    }
    if (is_absent(Link{all})) [[unlikely]]
        load_beyond(at, facets, outer.data());
    else
        cache_.counters.steps += facets;
    batch.size = 0;
    for (std::size_t n = 0; n < facets; ++n) {
        const Handle h = link_simplex(outer[n]);
        Beyond &beyond = batch.beyond[batch.size]; // overwritten if it does not count
        beyond.outer = outer[n];
        beyond.facet = static_cast<std::uint32_t>(at + n);
        beyond.vertex = cache_.simplex(h).vertex[link_facet(outer[n])];
        __builtin_prefetch(&cache_.point(beyond.vertex));
        batch.size += mesh_.marks.get(h) != Marks::inside; // otherwise the way leads back inside
    }
    return facets;
}

void Cavity<3>::load_beyond(std::size_t at, std::size_t facets, Link *outer) {
    const std::uint64_t loads = cache_.counters.loads;
    for (std::size_t n = 0; n < facets; ++n) {
        const Link inner = facets_[at + n].inner;
        outer[n] = cache_.cross(link_simplex(inner), link_facet(inner));
    }
    if (cache_.counters.loads != loads) cache_.renumber(corners_);
}

inline void Cavity<3>::test(Batch &batch, const Point<3> &p) {
    bool are_sure = true;
    for (std::size_t n = 0; n < batch.size; ++n) {
        Beyond &beyond = batch.beyond[n];
        beyond.apex = seen(cache_.point(beyond.vertex), p);
        beyond.test = in_sphere(plane(facets_[beyond.facet]), beyond.apex);
        are_sure &= beyond.test.is_sure;
    }
    if (!are_sure) [[unlikely]]
        test_exactly(batch, p);
}

void Cavity<3>::test_exactly(Batch &batch, const Point<3> &p) {
    for (std::size_t n = 0; n < batch.size; ++n) {
        Beyond &beyond = batch.beyond[n];
        if (beyond.test.is_sure) continue;
        // Several facets of this batch and of earlier ones may lead to this tetrahedron. The test
        // is expensive, so it is not repeated.
        const Handle h = link_simplex(beyond.outer);
        const Beyond *same = batch.beyond.data();
        while (link_simplex(same->outer) != h) ++same;
        if (same != &beyond)
            beyond.test.is_inside = same->test.is_inside;
        else
            beyond.test.is_inside = mesh_.marks.get(h) == Marks::none && is_exactly_inside(h, p);
    }
}

inline void Cavity<3>::sort_out(Batch &batch) {
    RimFacet *const rim = rim_.extend(batch.size);
    std::size_t outside = 0;
    batch.entered = 0;
    for (std::size_t n = 0; n < batch.size; ++n) {
        const Beyond &beyond = batch.beyond[n];
        const Handle h = link_simplex(beyond.outer);
        const bool is_inside = beyond.test.is_inside;
        // Two facets may lead to one tetrahedron.
        const bool is_new = mesh_.marks.get(h) != Marks::inside;
        mesh_.marks.set(h, is_inside ? Marks::inside : Marks::outside);
        rim[outside] = {beyond.outer, beyond.facet};
        outside += !is_inside;
        batch.to_enter[batch.entered] = static_cast<std::uint32_t>(n);
        batch.entered += is_inside & is_new;
    }
    rim_.resize(rim_.size() - batch.size + outside);
}

void Cavity<3>::begin(const Point<3> &p, Handle first) {
    inside_.clear();
    corners_.clear();
    edges_.clear();
    facets_.clear();
    rim_.clear();
    mesh_.marks.set(first, Marks::inside);
    const std::array<VertexIndex, 4> &vertex = cache_.simplex(first).vertex;
    for (int i = 0; i < 3; ++i) add_corner(vertex[i], seen(cache_.point(vertex[i]), p));
    Cross *const edge = edges_.extend(3);
    edge[0] = cross(seen_[0], seen_[1]);
    edge[1] = cross(seen_[0], seen_[2]);
    edge[2] = cross(seen_[1], seen_[2]);
    // One facet from both sides, as if the search had entered the tetrahedron across it.
    Facet *const facet = facets_.extend(2);
    facet[0] = {unset, {}, -1, {1, 0, 2}, {0, 2, 1}};
    facet[1] = {make_link(first, 3), {0, 1, 2}, 1, {0, 1, 2}, {0, 1, 2}};
    enter({make_link(first, 3), 0, vertex[3], {}, seen(cache_.point(vertex[3]), p)});
}

// A call would cost some 20 instructions, some 20 times a point.
[[gnu::always_inline]] inline void Cavity<3>::enter(const Beyond &beyond) {
    const SeenPoint<3> &apex = beyond.apex;
    const Handle h = link_simplex(beyond.outer);
    const int in_u = link_facet(beyond.outer);
    add(h);
    const std::array<VertexIndex, 4> &vertex = cache_.simplex(h).vertex;
    const std::uint32_t u = add_corner(beyond.vertex, apex);
    Facet *const created = facets_.extend(3);
    const Facet &f = facets_[beyond.facet];
    const auto &[a, b, c] = f.corner;
    const auto &[ab, ac, bc] = f.edge;
    const auto au = static_cast<std::uint32_t>(edges_.size()), bu = au + 1, cu = au + 2;
    Cross *const edge = edges_.extend(3);
    edge[0] = cross(seen_[a], apex);
    edge[1] = cross(seen_[b], apex);
    edge[2] = cross(seen_[c], apex);
    const auto &orders = slots_beyond[in_u];
    const VertexIndex first = corners_[a];
    const auto &in = orders[(vertex[orders[1][0]] == first) + 2 * (vertex[orders[2][0]] == first)];
    created[0] = {make_link(h, in[2]), {in[0], in[1], in[3]}, f.sign, {a, b, u}, {ab, au, bu}};
    created[1] = {make_link(h, in[0]), {in[1], in[2], in[3]}, 1, {b, c, u}, {bc, bu, cu}};
    created[2] = {make_link(h, in[1]), {in[2], in[0], in[3]}, -1, {c, a, u}, {ac, cu, au}};
}

/// Removes the marks, and empties the lists: a search that has found nothing yet may still have the
/// lists of the one before.
void Cavity<3>::give_up() {
    for (const Handle h : inside_) mesh_.marks.set(h, Marks::none);
    for (const RimFacet &facet : rim_) mesh_.marks.set(link_simplex(facet.outer), Marks::none);
    inside_.clear();
    rim_.clear();
}

void Cavity<3>::fill(VertexIndex v) {
    std::int64_t ghosts = -hollow_out();
    for (const Handle h : inside_) mesh_.marks.set(h, Marks::none);
    created_.resize(rim_.size());
    const std::uint64_t code = cache_.vertices()[v].code;
    cache_.acquire(v, static_cast<std::uint32_t>(rim_.size()));
    ridges_.pair(rim_.size() * 3, corners_.size(), [&](const auto ridges) {
        for (std::size_t n = 0; n < rim_.size(); ++n) {
            created_[n] = create(rim_[n], v, code, ridges);
            mesh_.remember(n, created_[n]);
            ghosts += cache_.simplex(created_[n]).is_ghost();
        }
        for (std::size_t n = 0; n < rim_.size(); ++n) {
            const Facet &facet = facets_[rim_[n].facet];
            const auto &corner = facet.corner;
            for (int i = 0; i < 3; ++i)
                cache_.point_at(created_[n], facet.slot[i],
                                ridges.across(corner[(i + 1) % 3], corner[(i + 2) % 3]));
        }
    });
    mesh_.count(static_cast<std::int64_t>(rim_.size() - inside_.size()) - ghosts, ghosts);
    log_created(created_, created_.size());
}

template <class View>
inline Handle Cavity<3>::create(const RimFacet &rim, VertexIndex v, std::uint64_t code,
                                const View &ridges) {
    const Facet &facet = facets_[rim.facet];
    const auto corner = facet.corner;
    const Handle h =
        cache_.allot(std::max({code, codes_[corner[0]], codes_[corner[1]], codes_[corner[2]]}));
    // v lies on the same side as the vertex that it replaces, so the orientation stays, and a
    // ghost's point at infinity stays last.
    const int opposite = link_facet(facet.inner);
    cache_.set_corner(h, opposite, v);
    for (int i = 0; i < 3; ++i) {
        cache_.set_corner(h, facet.slot[i], corners_[corner[i]]);
        cache_.acquire(corners_[corner[i]], 1);
        // The facets besides the rim's: each has v and one edge of the rim's facet.
        ridges.add(corner[(i + 1) % 3], corner[(i + 2) % 3], make_link(h, facet.slot[i]));
    }
    cache_.connect(make_link(h, opposite), rim.outer);
    cache_.mark_dirty(link_simplex(rim.outer));
    mesh_.marks.set(link_simplex(rim.outer), Marks::none);
    return h;
}

} // namespace abacus
