#include "query/lines/line_scan.hpp"

#include "query/locate/preferred.hpp"
#include "query/values/barycentric.hpp"
#include "query/values/weighted_mean.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace abacus {

namespace {

/// Of a parameter; if the error is larger, the parameter is computed in rational numbers.
constexpr double most_error = 1e-9;
/// More than what a parameter loses where something underflows.
constexpr double underflow = std::numeric_limits<double>::min();

} // namespace

// ---- Crossings -------------------------------------------------------------------------

template <int D> Point<D> Crossing<D>::place() const {
    Point<D> place;
    for (int axis = 0; axis < D; ++axis)
        place[axis] = weighted_mean(
            D, [&](std::size_t i) { return weight[i]; },
            [&](std::size_t i) { return corner[i][axis]; });
    return place;
}

template <int D> double Crossing<D>::mean() const {
    return weighted_mean(
        D, [&](std::size_t i) { return weight[i]; }, [&](std::size_t i) { return value[i]; });
}

template <int D> bool Crossing<D>::is_same_place(const Crossing &other) const {
    if (is_end || other.is_end) return is_end && other.is_end && at == other.at;
    const auto has = [](const Crossing &crossing, const Point<D> &p) {
        for (int i = 0; i < D; ++i)
            if (crossing.weight[i] > 0 && crossing.corner[i] == p) return true;
        return false;
    };
    for (int i = 0; i < D; ++i)
        if ((weight[i] > 0 && !has(other, corner[i])) ||
            (other.weight[i] > 0 && !has(*this, other.corner[i])))
            return false;
    return true;
}

template <int D> bool Crossing<D>::has_values_of(const Crossing &other) const {
    for (int i = 0; i < D; ++i)
        for (int k = 0; k < D; ++k)
            if (weight[i] > 0 && other.weight[k] > 0 && corner[i] == other.corner[k] &&
                std::bit_cast<std::uint64_t>(value[i]) !=
                    std::bit_cast<std::uint64_t>(other.value[k]))
                return false;
    return true;
}

// ---- Pieces ----------------------------------------------------------------------------

template <int D>
void LineScan<D>::fill(Crossing<D> &crossing, Handle h, const FacetPlace<D> &place) const {
    const Simplex<D> &s = cache_.simplex(h);
    double least = INFINITY, greatest = -INFINITY;
    crossing.is_end = false;
    crossing.at = 0;
    // In the order of the points: sums do not depend on that of a simplex's corners.
    std::array<int, D> order;
    std::iota(order.begin(), order.end(), 0);
    const auto point = [&](int i) -> const Point<D> & {
        return cache_.point(s.vertex[place.corner[i]]);
    };
    std::sort(order.begin(), order.end(),
              [&](int i, int j) { return lexicographically_less<D>(point(i), point(j)); });
    for (int i = 0; i < D; ++i) {
        const int from = order[i];
        const VertexIndex v = s.vertex[place.corner[from]];
        crossing.corner[i] = cache_.point(v);
        crossing.value[i] =
            attribute_ < 0 ? 0 : reader_.vertex_values().value(cache_.vertices(), v, attribute_);
        crossing.weight[i] = place.weight[from];
        if (crossing.weight[i] == 0) continue;
        const double along = line_.along(crossing.corner[i]);
        crossing.at += crossing.weight[i] * along;
        least = std::min(least, along);
        greatest = std::max(greatest, along);
    }
    crossing.at = std::clamp(crossing.at, least, greatest);
    crossing.error = D * place.error * (greatest - least) +
                     1e-14 * std::max(std::fabs(least), std::fabs(greatest)) + underflow;
    if (std::isfinite(crossing.at) && crossing.error <= most_error * std::fabs(crossing.at))
        [[likely]]
        return;
    crossing.at = exact::parameter<D>(line_, crossing.corner);
    crossing.error = 1e-15 * std::fabs(crossing.at) + underflow;
}

template <int D> std::optional<LinePiece<D>> LineScan<D>::piece_in(Handle h) const {
    const Simplex<D> &s = cache_.simplex(h);
    if (s.is_ghost()) return std::nullopt;
    const Corners<D> corners = cache_.corners(s);
    const std::optional<Passage<D>> passage = abacus::passage<D>(line_, corners);
    if (!passage) return std::nullopt;
    const int in = passage->enters.facet, out = passage->leaves.facet;
    if (facet_side<D>(corners, out, line_.from) <= 0) return std::nullopt; // before the line begins
    if (line_.to && facet_side<D>(corners, in, *line_.to) <= 0) return std::nullopt;
    Piece piece;
    if (facet_side<D>(corners, in, line_.from) < 0) fill(piece.enters, h, passage->enters);
    if (line_.to && facet_side<D>(corners, out, *line_.to) >= 0)
        piece.leaves.at = 1;
    else
        fill(piece.leaves, h, passage->leaves);
    if (area_ == nullptr || attribute_ < 0) {
        reader_.describe(h, piece.simplex);
        return piece;
    }
    const auto attribute = static_cast<std::uint32_t>(attribute_);
    CornerValues values(&attribute, 1);
    reader_.describe(h, piece.simplex, &values);
    for (int i = 0; i <= D; ++i) piece.value[i] = values.value(i, 0);
    return piece;
}

template <int D> void LineScan<D>::consider(Handle h, const Crossing<D> &enters) {
    const std::optional<Piece> piece = piece_in(h);
    if (!piece || !piece->enters.is_same_place(enters)) return;
    if (found_ && !is_preferred<D>(piece->simplex, found_->simplex, extent_)) return;
    found_ = piece;
    at_ = h;
}

template <int D> bool LineScan<D>::hand_out(Piece &piece) {
    if (!is_in<D>(extent_, piece.simplex)) return true;
    return area_ == nullptr ? hand_out_whole(piece) : hand_out_parts(piece);
}

template <int D> bool LineScan<D>::hand_out_whole(Piece &piece) {
    piece.follows = left_ && left_->is_same_place(piece.enters);
    piece.jumps = piece.follows && !piece.enters.is_end && !piece.enters.has_values_of(*left_);
    // Rounding must not change the order.
    const double before = left_ ? left_->at : 0, end = line_.to ? 1.0 : INFINITY;
    piece.enters.at = piece.follows ? before : std::clamp(piece.enters.at, before, end);
    piece.leaves.at = std::clamp(piece.leaves.at, piece.enters.at, end);
    left_ = piece.leaves;
    return (*visit_)(piece);
}

// ---- Polygons --------------------------------------------------------------------------

template <int D> void LineScan<D>::cut_line() {
    if constexpr (D == 2)
        if (area_ != nullptr && line_.to)
            area_->polygon.cut(line_.from, *line_.to,
                               [this](const Polygon::Stretch &s) { stretches_.push_back(s); });
}

/// A place in the interior of a piece's simplex.
template <int D>
Crossing<D> LineScan<D>::crossing_at(const Piece &piece, double at, const Point<D> &place) const {
    Crossing<D> crossing;
    crossing.is_end = false;
    crossing.at = at;
    crossing.error = 1e-15 * std::fabs(at) + underflow;
    crossing.corner.fill(place);
    crossing.weight.fill(0);
    crossing.weight[0] = 1;
    const auto weights = barycentric_weights<D>(piece.simplex, place);
    crossing.value.fill(attribute_ < 0 ? 0
                                       : weighted_mean(
                                             D + 1, [&](std::size_t i) { return weights[i]; },
                                             [&](std::size_t i) { return piece.value[i]; }));
    return crossing;
}

template <int D> bool LineScan<D>::hand_out_parts(const Piece &piece) {
    if constexpr (D == 2) {
        while (stretch_ < stretches_.size() && stretches_[stretch_].to <= piece.enters.at)
            ++stretch_;
        for (std::size_t i = stretch_; i < stretches_.size(); ++i) {
            const Polygon::Stretch &stretch = stretches_[i];
            if (piece.leaves.at <= stretch.from) break;
            Piece part = piece;
            if (piece.enters.at < stretch.from)
                part.enters = crossing_at(piece, stretch.from, stretch.first);
            if (stretch.to < piece.leaves.at)
                part.leaves = crossing_at(piece, stretch.to, stretch.last);
            if (!hand_out_whole(part)) return false;
        }
    }
    return true;
}

template <int D> void LineScan<D>::each(const std::function<bool(const LinePiece<D> &)> &visit) {
    if (reader_.is_empty()) return;
    visit_ = &visit;
    left_.reset();
    stretch_ = 0;
    if (reader_.is_convex())
        follow();
    else
        sweep();
}

// ---- Convex meshes ---------------------------------------------------------------------

template <int D> void LineScan<D>::follow() {
    begin();
    for (std::uint64_t steps = 0; found_; ++steps) {
        if (steps > reader_.size()) throw_corrupted("A line in the mesh does not end.");
        if (!hand_out(*found_) || found_->leaves.is_end) return;
        cache_.poll();
        trim();
        go_on();
    }
}

template <int D> void LineScan<D>::begin() {
    found_.reset();
    bool is_inside = false;
    reader_.containing(line_.from, [&](Handle h) {
        is_inside = true;
        consider(h, {});
    });
    if (!is_inside) begin_outside();
}

template <int D> void LineScan<D>::begin_outside() {
    std::uint32_t random = 2463534242u; // xorshift
    Handle h = reader_.simplex_around(line_.from);
    FacetPlace<D> place;
    for (std::uint64_t steps = 0;; ++steps) {
        if (steps > 64 * reader_.size()) throw_corrupted("A walk on the hull does not end.");
        cache_.poll();
        const Simplex<D> &ghost = cache_.simplex(h);
        if (!ghost.is_ghost()) throw_corrupted("A ghost has no ghost beside it.");
        Corners<D> corners;
        std::array<const Point<D> *, D> facet;
        for (int i = 0; i < D; ++i) corners[i] = facet[i] = &cache_.point(ghost.vertex[i]);
        corners[D] = &line_.from;
        if (orientation<D>(corners) <= 0) return; // not visible: the line misses the mesh
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        int ridge = 0;
        if (meets_facet<D>(line_, facet, place, random, ridge)) {
            if (line_.to && facet_side<D>(corners, D, *line_.to) >= 0) return; // ends before
            break;
        }
        h = link_simplex(cache_.cross(h, ridge));
    }
    Crossing<D> enters;
    fill(enters, h, place);
    look_around(h, enters);
}

template <int D> void LineScan<D>::look_around(Handle h, const Crossing<D> &crossing) {
    std::array<VertexIndex, D> face;
    int corners = 0;
    const Simplex<D> &s = cache_.simplex(h);
    for (int i = 0; i < D; ++i) {
        if (crossing.weight[i] == 0) continue;
        int k = 0;
        while (k < s.finite_vertices() && !(cache_.point(s.vertex[k]) == crossing.corner[i])) ++k;
        if (k == s.finite_vertices()) throw_corrupted("A simplex has lost a corner.");
        face[corners++] = s.vertex[k];
    }
    const auto has_face = [&](Handle met, int facet) {
        const VertexIndex v = cache_.simplex(met).vertex[facet];
        return std::find(face.begin(), face.begin() + corners, v) == face.begin() + corners;
    };
    found_.reset();
    if (corners == D) { // only one simplex is beyond
        int facet = 0;
        while (!has_face(h, facet)) ++facet;
        consider(link_simplex(cache_.cross(h, facet)), crossing);
        return;
    }
    reader_.flood().from(cache_, h, has_face, [&](Handle met) {
        consider(met, crossing);
        return true;
    });
}

template <int D> void LineScan<D>::go_on() {
    const Crossing<D> here = found_->leaves;
    look_around(at_, here);
}

/// Gives memory back; the current simplex stays.
template <int D> void LineScan<D>::trim() {
    const Key page = cache_.lower(at_);
    cache_.use(at_);
    cache_.trim();
    if (cache_.is_live(at_)) [[likely]]
        return;
    at_ = no_handle;
    cache_.visit(page, [&](Handle h) {
        abacus_simplex simplex;
        reader_.describe(h, simplex);
        if (!simplex.ghost && !comes_before<D>(simplex, found_->simplex) &&
            !comes_before<D>(found_->simplex, simplex))
            at_ = h;
    });
    if (at_ == no_handle) throw_corrupted("A simplex is no longer in its page.");
}

// ---- Other meshes ----------------------------------------------------------------------

template <int D> double LineScan<D>::reaches(const Box<D> &box) const {
    // Each quotient has a relative error of a few units in the last place.
    constexpr double slack = 1e-14;
    double least = 0, greatest = line_.to ? 1.0 + slack : INFINITY;
    for (int axis = 0; axis < D; ++axis) {
        const double from = line_.from[axis];
        double d = line_.direction[axis];
        double below = box.lower[axis] - from, above = box.upper[axis] - from;
        if (!std::isfinite(d) || !std::isfinite(below) || !std::isfinite(above)) {
            d = line_.to ? (*line_.to)[axis] / 4 - from / 4 : d / 4;
            below = box.lower[axis] / 4 - from / 4;
            above = box.upper[axis] / 4 - from / 4;
        }
        if (d == 0) {
            if (below > 0 || above < 0) return INFINITY;
            continue;
        }
        const double in = (d > 0 ? below : above) / d, out = (d > 0 ? above : below) / d;
        if (!std::isnan(in)) least = std::max(least, in - slack * std::fabs(in));
        if (!std::isnan(out)) greatest = std::min(greatest, out + slack * std::fabs(out));
    }
    return least <= greatest ? least : INFINITY;
}

template <int D> int LineScan<D>::compare(const Piece &a, const Piece &b) const {
    const Crossing<D> &p = a.enters, &q = b.enters;
    if (p.is_same_place(q)) return 0;
    if (p.is_end || q.is_end) return p.is_end ? -1 : 1;
    if (std::fabs(p.at - q.at) > p.error + q.error) return p.at < q.at ? -1 : 1;
    return exact::compare_along<D>(line_, p.corner, q.corner);
}

template <int D> bool LineScan<D>::hand_out_until(double least) {
    const auto later = [this](const Piece &a, const Piece &b) { return compare(a, b) > 0; };
    const auto take = [&] {
        std::pop_heap(ahead_.begin(), ahead_.end(), later);
        const Piece piece = ahead_.back();
        ahead_.pop_back();
        return piece;
    };
    while (!ahead_.empty() && ahead_.front().enters.at + ahead_.front().enters.error < least) {
        Piece first = take();
        while (!ahead_.empty() && compare(ahead_.front(), first) == 0)
            if (const Piece other = take(); comes_before<D>(other.simplex, first.simplex))
                first = other;
        if (!hand_out(first)) return false;
    }
    return true;
}

template <int D> void LineScan<D>::sweep() {
    const auto later = [this](const Piece &a, const Piece &b) { return compare(a, b) > 0; };
    bool goes_on = true;
    ahead_.clear();
    reader_.boxes().by_rank(
        memory_, [this](const Box<D> &box) { return reaches(box); },
        [&](Key key, const Key &end, double least) {
            goes_on = hand_out_until(least);
            if (!goes_on || least == INFINITY) return false;
            while (key < end) {
                cache_.trim();
                cache_.poll();
                key = cache_.visit(key, [&](Handle h) {
                    const std::optional<Piece> piece = piece_in(h);
                    if (!piece || !is_in<D>(extent_, piece->simplex)) return;
                    ahead_.push_back(*piece);
                    std::push_heap(ahead_.begin(), ahead_.end(), later);
                });
            }
            return true;
        });
    if (goes_on) hand_out_until(INFINITY);
}

template struct Crossing<2>;
template struct Crossing<3>;
template class LineScan<2>;
template class LineScan<3>;

} // namespace abacus
