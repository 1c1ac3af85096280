#include "delaunay/pieces.hpp"

#include "delaunay/cached_conflict.hpp"

#include <algorithm>

namespace abacus {

// ---- The first triangulation ---------------------------------------------------

Pieces::Side Pieces::add(const std::array<VertexIndex, 3> &corners,
                         const std::array<Side, 3> &beyond) {
    const std::size_t n = pieces_.size();
    pieces_.push_back({corners, beyond, FixedFacets<2>::from_bits(0, region_)});
    for (int i = 0; i < 3; ++i) join(side(n, i), beyond[i], Fixed::no);
    return side(n, 1);
}

void Pieces::join(Side a, Side b, Fixed how) {
    for (const auto &[s, other] : {std::pair(a, b), std::pair(b, a)}) {
        if (is_outside(s) || other == unknown) continue;
        Piece &piece = pieces_[piece_of(s)];
        piece.beyond[facet_of(s)] = other;
        const Fixed outer = is_outside(other) ? outside_[number(other)] : Fixed::no;
        if (how != Fixed::no || outer != Fixed::no)
            piece.fixed.set(facet_of(s), std::max(how, outer));
    }
}

void Pieces::cut_ears(std::span<const VertexIndex> corners, std::span<const Side> beyond) {
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
}

Pieces::Side Pieces::fill_chain(std::span<const VertexIndex> corners,
                                std::span<const Side> beyond) {
    cut_ears(corners, beyond);
    if (corners_.size() != 2) throw_no_triangulation();
    return corners_[0].beyond;
}

// Both banks bend inwards, so a corner sees the one before the end of the other bank if it lies
// inside of the last edge there; and that is so for one of the two ends.
std::size_t Pieces::fill_funnel(std::span<const VertexIndex> right,
                                std::span<const Side> beyond_right,
                                std::span<const VertexIndex> left,
                                std::span<const Side> beyond_left, Side end) {
    cut_ears(right, beyond_right);
    bank_.swap(corners_);
    Arena<VertexIndex> corners(cache_.host()); // the left bank counterclockwise
    Arena<Side> beyond(cache_.host());
    for (std::size_t i = left.size(); i-- > 0;) corners.push_back(left[i]);
    for (std::size_t i = beyond_left.size(); i-- > 0;) beyond.push_back(beyond_left[i]);
    cut_ears({corners.data(), corners.size()}, {beyond.data(), beyond.size()});
    const std::size_t beside = pieces_.size(), last = corners_.size() - 1; // the first corner
    for (std::size_t i = 0, j = bank_.size() - 1; i < last && j > 0;) {
        const VertexIndex c = corners_[i].vertex, before_c = corners_[i + 1].vertex,
                          d = bank_[j].vertex, before_d = bank_[j - 1].vertex;
        if (i + 1 == last && j == 1) {
            add({before_c, d, c}, {end, corners_[i].beyond, bank_[0].beyond});
            break;
        }
        if (turn(before_d, d, before_c) > 0 && turn(d, c, before_c) > 0) {
            end = add({d, c, before_c}, {corners_[i].beyond, unknown, end});
            ++i;
        } else if (turn(c, before_c, before_d) > 0 && turn(before_d, d, c) > 0) {
            end = add({before_d, d, c}, {end, unknown, bank_[j - 1].beyond});
            --j;
        } else {
            throw_no_triangulation();
        }
        if (pieces_.size() % 4096 == 0) cache_.poll();
    }
    return beside;
}

bool Pieces::is_ear(const Corner &corner, const Point<2> &inside, bool may_touch) const {
    const VertexIndex before = corners_[corner.previous].vertex,
                      after = corners_[corner.next].vertex;
    if (turn(before, corner.vertex, after) <= 0) return false;
    const int side = orientation(cache_.point(before), cache_.point(after), inside);
    return may_touch ? side >= 0 : side > 0;
}

void Pieces::cut_ear(std::uint32_t corner) {
    const Corner y = corners_[corner];
    Corner &x = corners_[y.previous];
    x.beyond = add({x.vertex, y.vertex, corners_[y.next].vertex}, {y.beyond, unknown, x.beyond});
    x.next = y.next;
    corners_[y.next].previous = y.previous;
}

void Pieces::fill_star(std::span<const VertexIndex> corners, std::span<const Side> beyond,
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

void Pieces::fill_fan(std::span<const VertexIndex> corners, std::span<const Side> beyond) {
    const std::size_t first = pieces_.size(), ghosts = corners.size() - 2;
    for (std::size_t i = 0; i < ghosts; ++i)
        pieces_.push_back(
            {{corners[i + 1], corners[i + 2], infinite_vertex}, {unknown, unknown, unknown}, {}});
    for (std::size_t i = 0; i < ghosts; ++i) {
        join(side(first + i, 2), beyond[i + 1], Fixed::no);
        join(side(first + i, 1), i == 0 ? beyond[0] : side(first + i - 1, 0), Fixed::no);
    }
    join(side(first + ghosts - 1, 0), beyond[corners.size() - 1], Fixed::no);
}

// ---- Flips ------------------------------------------------------------------------

bool Pieces::must_flip(Side s) const {
    const Piece &t = pieces_[piece_of(s)];
    const int i = facet_of(s);
    const Side other = t.beyond[i];
    if (is_outside(other) || t.fixed.is_fixed(i)) return false;
    const VertexIndex apex = pieces_[piece_of(other)].vertex[facet_of(other)];
    if (t.vertex[i] == infinite_vertex || apex == infinite_vertex) return false;
    return is_in_circle(piece_of(s), cache_.point(apex));
}

bool Pieces::is_in_circle(std::size_t piece, const Point<2> &p) const {
    Simplex<2> simplex{pieces_[piece].vertex, {}};
    for (int k = 0; k < 2; ++k)
        if (pieces_[piece].vertex[k] == infinite_vertex)
            std::rotate(simplex.vertex.begin(), simplex.vertex.begin() + k + 1,
                        simplex.vertex.end());
    return side_of<2>(cache_, simplex, p) == abacus::Side::inside;
}

void Pieces::flip(Side s) {
    const std::uint32_t number_t = piece_of(s);
    const Side other = pieces_[number_t].beyond[facet_of(s)];
    const std::uint32_t number_u = piece_of(other);
    const Piece t = pieces_[number_t], u = pieces_[number_u];
    const int c = facet_of(s), a = (c + 1) % 3, b = (c + 2) % 3;                   // corners of t
    const int d = facet_of(other), beside_a = (d + 1) % 3, beside_b = (d + 2) % 3; // facets of u
    const auto both = [&](Fixed zeroth, Fixed second) {
        FixedFacets<2> facets = FixedFacets<2>::from_bits(0, t.fixed.region());
        facets.set(0, zeroth);
        facets.set(2, second);
        return facets;
    };
    pieces_[number_t] = {{t.vertex[c], t.vertex[a], u.vertex[d]},
                         {u.beyond[beside_a], side(number_u, 1), t.beyond[b]},
                         both(u.fixed[beside_a], t.fixed[b])};
    pieces_[number_u] = {{u.vertex[d], t.vertex[b], t.vertex[c]},
                         {t.beyond[a], side(number_t, 1), u.beyond[beside_b]},
                         both(t.fixed[a], u.fixed[beside_b])};
    for (const std::uint32_t piece : {number_t, number_u})
        for (const int facet : {0, 2}) {
            const Side beyond = pieces_[piece].beyond[facet];
            if (is_outside(beyond)) continue;
            pieces_[piece_of(beyond)].beyond[facet_of(beyond)] = side(piece, facet);
            to_test_.push_back(side(piece, facet));
        }
}

void Pieces::improve() {
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

// ---- The point at infinity --------------------------------------------------------

void Pieces::bring_infinity_last(std::size_t n) {
    Piece &piece = pieces_[n];
    const auto at =
        static_cast<int>(std::find(piece.vertex.begin(), piece.vertex.end(), infinite_vertex) -
                         piece.vertex.begin());
    if (at >= 2) return;
    const FixedFacets<2> fixed = piece.fixed;
    std::rotate(piece.vertex.begin(), piece.vertex.begin() + at + 1, piece.vertex.end());
    std::rotate(piece.beyond.begin(), piece.beyond.begin() + at + 1, piece.beyond.end());
    for (int i = 0; i < 3; ++i) {
        piece.fixed.set(i, fixed[(i + at + 1) % 3]);
        if (!is_outside(piece.beyond[i]))
            pieces_[piece_of(piece.beyond[i])].beyond[facet_of(piece.beyond[i])] = side(n, i);
    }
}

} // namespace abacus
