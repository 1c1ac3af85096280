#include "delaunay/patch.hpp"

#include "delaunay/cached_conflict.hpp"

#include <algorithm>

namespace abacus {

Patch::Patch(Delaunay<2> &mesh)
    : mesh_(mesh), cache_(mesh.cache()), pieces_(cache_.host()), outer_(cache_.host()),
      pairs_(cache_.host()), corners_(cache_.host()), to_test_(cache_.host()),
      created_(cache_.host()) {}

void Patch::begin() {
    pieces_.clear();
    outer_.clear();
    pairs_.clear();
}

Patch::Side Patch::outside(Link edge) {
    outer_.push_back(edge);
    return Side{static_cast<std::uint32_t>(outer_.size() - 1) | outside_bit};
}

std::array<Patch::Side, 2> Patch::inside(bool is_fixed) {
    const Side a = outside(unset), b = outside(unset);
    pairs_.push_back({{a, b}, is_fixed});
    return {a, b};
}

void Patch::join_pairs() {
    if (pairs_.empty()) return;
    Arena<Side> holders(cache_.host()); // of what is outside
    holders.resize(outer_.size());
    std::fill(holders.begin(), holders.end(), unknown);
    for (std::size_t n = 0; n < pieces_.size(); ++n)
        for (int i = 0; i < 3; ++i)
            if (is_outside(pieces_[n].beyond[i]))
                holders[number(pieces_[n].beyond[i])] = side(n, i);
    for (const Pair &pair : pairs_) {
        const Side a = holders[number(pair.side[0])], b = holders[number(pair.side[1])];
        if (a == unknown || b == unknown) throw_no_triangulation();
        join(a, b, pair.is_fixed);
    }
}

// ---- The first triangulation ---------------------------------------------------

Patch::Side Patch::add(const std::array<VertexIndex, 3> &corners,
                       const std::array<Side, 3> &beyond) {
    const std::size_t n = pieces_.size();
    pieces_.push_back({corners, beyond, 0});
    for (int i = 0; i < 3; ++i) join(side(n, i), beyond[i], false);
    return side(n, 1);
}

void Patch::join(Side a, Side b, bool is_fixed) {
    for (const auto &[s, other] : {std::pair(a, b), std::pair(b, a)}) {
        if (is_outside(s) || other == unknown) continue;
        Piece &piece = pieces_[piece_of(s)];
        piece.beyond[facet_of(s)] = other;
        const Link outer = is_outside(other) ? outer_[number(other)] : unset;
        if (is_fixed || (outer != unset && cache_.is_fixed(outer)))
            piece.fixed |= 1u << facet_of(s);
    }
}

Patch::Side Patch::fill_chain(std::span<const VertexIndex> corners, std::span<const Side> beyond) {
    corners_.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const VertexIndex z = corners[i];
        while (corners_.size() > 1) {
            const Corner y = corners_.back();
            Corner &x = corners_[corners_.size() - 2];
            if (turn(x.vertex, y.vertex, z) <= 0) break;
            x.beyond = add({x.vertex, y.vertex, z}, {y.beyond, unknown, x.beyond});
            corners_.pop_back();
        }
        corners_.push_back({z, i < beyond.size() ? beyond[i] : unknown, 0, 0});
        if (i % 4096 == 4095) cache_.poll();
    }
    if (corners_.size() != 2) throw_no_triangulation();
    return corners_[0].beyond;
}

bool Patch::is_ear(const Corner &corner, const Point<2> &inside, bool may_touch) const {
    const VertexIndex before = corners_[corner.previous].vertex,
                      after = corners_[corner.next].vertex;
    if (turn(before, corner.vertex, after) <= 0) return false;
    const int side = orientation(cache_.point(before), cache_.point(after), inside);
    return may_touch ? side >= 0 : side > 0;
}

void Patch::cut_ear(std::uint32_t corner) {
    const Corner y = corners_[corner];
    Corner &x = corners_[y.previous];
    x.beyond = add({x.vertex, y.vertex, corners_[y.next].vertex}, {y.beyond, unknown, x.beyond});
    x.next = y.next;
    corners_[y.next].previous = y.previous;
}

void Patch::fill_star(std::span<const VertexIndex> corners, std::span<const Side> beyond,
                      const Point<2> &inside) {
    corners_.clear();
    const auto size = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t i = 0; i < size; ++i)
        corners_.push_back({corners[i], beyond[i], (i + size - 1) % size, (i + 1) % size});
    std::uint32_t left = size, at = 0, misses = 0;
    while (left > 3) {
        if (is_ear(corners_[at], inside, left == 4)) {
            cut_ear(at);
            at = corners_[at].previous; // it may have become one
            --left;
            misses = 0;
        } else {
            at = corners_[at].next;
            if (++misses > left) throw_no_triangulation();
        }
        if (left % 4096 == 0) cache_.poll();
    }
    const Corner &a = corners_[at], &b = corners_[a.next], &c = corners_[b.next];
    if (turn(a.vertex, b.vertex, c.vertex) <= 0) throw_no_triangulation();
    add({a.vertex, b.vertex, c.vertex}, {b.beyond, c.beyond, a.beyond});
}

void Patch::fill_fan(std::span<const VertexIndex> corners, std::span<const Side> beyond) {
    const std::size_t first = pieces_.size(), ghosts = corners.size() - 2;
    for (std::size_t i = 0; i < ghosts; ++i)
        pieces_.push_back(
            {{corners[i + 1], corners[i + 2], infinite_vertex}, {unknown, unknown, unknown}, 0});
    for (std::size_t i = 0; i < ghosts; ++i) {
        join(side(first + i, 2), beyond[i + 1], false);
        join(side(first + i, 1), i == 0 ? beyond[0] : side(first + i - 1, 0), false);
    }
    join(side(first + ghosts - 1, 0), beyond[corners.size() - 1], false);
}

// ---- Flips ------------------------------------------------------------------------

bool Patch::must_flip(Side s) const {
    const Piece &t = pieces_[piece_of(s)];
    const int i = facet_of(s);
    const Side other = t.beyond[i];
    if (is_outside(other) || (t.fixed >> i & 1) != 0) return false;
    const VertexIndex apex = pieces_[piece_of(other)].vertex[facet_of(other)];
    if (t.vertex[i] == infinite_vertex || apex == infinite_vertex) return false;
    Simplex<2> simplex{t.vertex, {}};
    for (int k = 0; k < 2; ++k)
        if (t.vertex[k] == infinite_vertex)
            std::rotate(simplex.vertex.begin(), simplex.vertex.begin() + k + 1,
                        simplex.vertex.end());
    return side_of<2>(cache_, simplex, cache_.point(apex)) == abacus::Side::inside;
}

void Patch::flip(Side s) {
    const std::uint32_t number_t = piece_of(s);
    const Side other = pieces_[number_t].beyond[facet_of(s)];
    const std::uint32_t number_u = piece_of(other);
    const Piece t = pieces_[number_t], u = pieces_[number_u];
    const int c = facet_of(s), a = (c + 1) % 3, b = (c + 2) % 3;                   // corners of t
    const int d = facet_of(other), beside_a = (d + 1) % 3, beside_b = (d + 2) % 3; // facets of u
    const auto bit = [](const Piece &piece, int from, int to) {
        return (piece.fixed >> from & 1u) << to;
    };
    pieces_[number_t] = {{t.vertex[c], t.vertex[a], u.vertex[d]},
                         {u.beyond[beside_a], side(number_u, 1), t.beyond[b]},
                         bit(u, beside_a, 0) | bit(t, b, 2)};
    pieces_[number_u] = {{u.vertex[d], t.vertex[b], t.vertex[c]},
                         {t.beyond[a], side(number_t, 1), u.beyond[beside_b]},
                         bit(t, a, 0) | bit(u, beside_b, 2)};
    for (const std::uint32_t piece : {number_t, number_u})
        for (const int facet : {0, 2}) {
            const Side beyond = pieces_[piece].beyond[facet];
            if (is_outside(beyond)) continue;
            pieces_[piece_of(beyond)].beyond[facet_of(beyond)] = side(piece, facet);
            to_test_.push_back(side(piece, facet));
        }
}

void Patch::improve() {
    to_test_.clear();
    for (std::size_t n = 0; n < pieces_.size(); ++n)
        for (int i = 0; i < 3; ++i) to_test_.push_back(side(n, i));
    for (std::size_t tested = 0; !to_test_.empty(); ++tested) {
        const Side s = to_test_.back();
        to_test_.pop_back();
        if (must_flip(s)) flip(s);
        if (tested % 4096 == 4095) cache_.poll();
    }
}

// ---- Simplices of the mesh -----------------------------------------------------------

std::size_t Patch::finish() {
    join_pairs();
    improve();
    create_all();
    return pieces_.size();
}

void Patch::create_all() {
    mesh_.forget();
    created_.clear();
    std::int64_t ghosts = 0;
    for (Piece &piece : pieces_) {
        // The point at infinity comes last.
        for (int k = 0; k < 2; ++k) {
            if (piece.vertex[k] != infinite_vertex) continue;
            std::rotate(piece.vertex.begin(), piece.vertex.begin() + k + 1, piece.vertex.end());
            std::rotate(piece.beyond.begin(), piece.beyond.begin() + k + 1, piece.beyond.end());
            piece.fixed = (piece.fixed >> (k + 1) | piece.fixed << (2 - k)) & 7;
            const auto n = static_cast<std::size_t>(&piece - pieces_.data());
            for (int i = 0; i < 3; ++i)
                if (!is_outside(piece.beyond[i]))
                    pieces_[piece_of(piece.beyond[i])].beyond[facet_of(piece.beyond[i])] =
                        side(n, i);
            break;
        }
        ghosts += piece.vertex[2] == infinite_vertex;
        const Handle h = cache_.create(piece.vertex);
        cache_.set_fixed(h, piece.fixed);
        mesh_.remember(created_.size(), h);
        if (mesh_.log != nullptr) mesh_.log->come(cache_, h);
        created_.push_back(h);
        if (created_.size() % 4096 == 0) cache_.poll();
    }
    for (std::size_t n = 0; n < pieces_.size(); ++n)
        for (int i = 0; i < 3; ++i) {
            const Side beyond = pieces_[n].beyond[i];
            const Link here = make_link(created_[n], i);
            if (is_outside(beyond)) {
                cache_.connect(here, outer_[number(beyond)]);
                cache_.mark_dirty(link_simplex(outer_[number(beyond)]));
            } else {
                cache_.point_at(here, make_link(created_[piece_of(beyond)], facet_of(beyond)));
            }
        }
    mesh_.count(static_cast<std::int64_t>(pieces_.size()) - ghosts, ghosts);
}

} // namespace abacus
