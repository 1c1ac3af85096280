#include "geometry/polygon.hpp"

#include "geometry/overlap.hpp"
#include "geometry/rational.hpp"
#include "host/memory_resource.hpp"

#include <cmath>
#include <cstring>

namespace abacus {

namespace {

using exact::Rational;
using Place = std::array<Rational, 2>;

constexpr double infinity = std::numeric_limits<double>::infinity();

Place place_of(const Point<2> &p) { return {Rational(p[0]), Rational(p[1])}; }

/// As orientation().
int turn(const Place &a, const Place &b, const Place &c) {
    const Rational left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    return left > right ? 1 : left < right ? -1 : 0;
}
int turn(const Point<2> &a, const Point<2> &b, const Point<2> &c) { return orientation(a, b, c); }

/// Counts the edges to the right of a place.
template <class P> class RightOf {
public:
    explicit RightOf(const P &p) : p_(p) {}

    /// False for an edge on which the place is.
    bool count(const P &a, const P &b) {
        const bool is_a_above = p_[1] < a[1], is_b_above = p_[1] < b[1];
        const int side = turn(a, b, p_);
        if (side == 0 && is_between(a[0], b[0], p_[0]) && is_between(a[1], b[1], p_[1])) {
            side_ = 0;
            return false;
        }
        if (is_a_above != is_b_above && is_b_above == (side > 0)) side_ = -side_;
        return true;
    }
    /// +1 if they were odd, 0 on an edge, -1 if they were even.
    int side() const { return side_; }

private:
    template <class N> static bool is_between(const N &a, const N &b, const N &x) {
        return (a <= x && x <= b) || (b <= x && x <= a);
    }

    const P &p_;
    int side_ = -1;
};

Box<2> box_around(const Point<2> &a, const Point<2> &b) {
    Box<2> box;
    box.extend(a);
    box.extend(b);
    return box;
}

/// Part of a line from a to b: (c, d) are on its two sides, or p on it.
Rational share_at(const Place &a, const Place &b, const Place &p) {
    const int axis = a[0] == b[0] ? 1 : 0;
    return (p[axis] - a[axis]) / (b[axis] - a[axis]);
}
Rational share_at(const Place &a, const Place &b, const Place &c, const Place &d) {
    const auto times = [&](const Place &p) {
        return Rational((d[0] - c[0]) * (p[1] - c[1]) - (d[1] - c[1]) * (p[0] - c[0]));
    };
    const Rational at_a = times(a);
    return at_a / (at_a - times(b));
}

Place along(const Place &a, const Place &b, const Rational &share) {
    return {a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share};
}

Point<2> rounded(const Place &p) {
    return {exact::nearest_double(p[0]) + 0.0, exact::nearest_double(p[1]) + 0.0};
}

/// The ends of an edge at an x, with a bound on what rounding may do.
Box<2> box_at(const Point<2> &left, const Point<2> &right, double x) {
    const double least = std::fmin(left[1], right[1]), greatest = std::fmax(left[1], right[1]);
    const double y = std::lerp(left[1], right[1], (x - left[0]) / (right[0] - left[0]));
    const double slack = 0x1p-48 * std::fmax(std::fabs(least), std::fabs(greatest));
    if (!std::isfinite(y) || !std::isfinite(slack)) return {{x, least}, {x, greatest}};
    return {{x, std::fmax(least, y - slack)}, {x, std::fmin(greatest, y + slack)}};
}

} // namespace

// ---- Its inside ------------------------------------------------------------------------

/// From left to right: which edges are there, and what is between them.
class Polygon::Sweep {
public:
    Sweep(const Host &host, Polygon &polygon)
        : host_(host), polygon_(polygon), edges_(polygon.edges_), begin_(host), end_(host),
          active_(host), new_(host) {}

    void run() {
        sort(begin_, [this](std::uint32_t i) -> const Point<2> & { return edges_[i].left; });
        sort(end_, [this](std::uint32_t i) -> const Point<2> & { return edges_[i].right; });
        std::size_t begun = 0, ended = 0;
        while (ended < end_.size()) {
            if (ended % 1024 == 0) host_.poll();
            Point<2> vertex = edges_[end_[ended]].right;
            if (begun < begin_.size() &&
                lexicographically_less<2>(edges_[begin_[begun]].left, vertex))
                vertex = edges_[begin_[begun]].left;
            new_.clear();
            for (; begun < begin_.size() && edges_[begin_[begun]].left == vertex; ++begun)
                new_.push_back({begin_[begun], vertex[0]});
            pass(vertex);
            while (ended < end_.size() && edges_[end_[ended]].right == vertex) ++ended;
        }
    }

private:
    /// An edge, and where what is above it begins.
    struct Active {
        std::uint32_t edge;
        double since;
    };

    template <class PointOf> void sort(Arena<std::uint32_t> &order, PointOf point) {
        order.resize(edges_.size());
        for (std::size_t i = 0; i < edges_.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
        std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
            return lexicographically_less<2>(point(i), point(j));
        });
    }
    int side(const Active &active, const Point<2> &p) const {
        return orientation(edges_[active.edge].left, edges_[active.edge].right, p);
    }
    void pass(const Point<2> &vertex) {
        Active *const first = std::partition_point(
            active_.begin(), active_.end(), [&](const Active &a) { return side(a, vertex) > 0; });
        Active *const last = std::partition_point(
            first, active_.end(), [&](const Active &a) { return side(a, vertex) >= 0; });
        for (const Active *a = first; a != last; ++a) // an edge may pass through a vertex
            if (!(edges_[a->edge].right == vertex)) new_.push_back({a->edge, vertex[0]});
        std::sort(new_.begin(), new_.end(), [&](const Active &a, const Active &b) {
            return orientation(vertex, edges_[a.edge].right, edges_[b.edge].right) > 0;
        });
        const auto begin = static_cast<std::size_t>(first - active_.begin()),
                   end = static_cast<std::size_t>(last - active_.begin());
        // What is between the edges 0 and 1, 2 and 3 and so on is inside.
        for (std::size_t i = begin & ~std::size_t{1}; i < end + end % 2 && i + 1 < active_.size();
             i += 2)
            put(active_[i], active_[i + 1], vertex[0]);
        replace(begin, end);
        if (begin % 2 == 1) active_[begin - 1].since = vertex[0];
    }
    void put(const Active &lower, const Active &upper, double right) {
        if (lower.since < right)
            polygon_.parts_.push_back({lower.since, right, lower.edge, upper.edge});
    }
    /// By the new ones.
    void replace(std::size_t begin, std::size_t end) {
        const std::size_t behind = active_.size() - end, size = begin + new_.size() + behind;
        if (size > active_.size()) active_.resize(size);
        std::memmove(&active_[begin + new_.size()], &active_[end], behind * sizeof(Active));
        active_.resize(size);
        std::copy(new_.begin(), new_.end(), active_.begin() + begin);
    }

    const Host &host_;
    Polygon &polygon_;
    const Arena<Edge> &edges_;
    Arena<std::uint32_t> begin_, end_; // edges in the order of their left ends, and right ends
    Arena<Active> active_, new_;       // from below
};

Polygon::Polygon(const Host &host, const Point<2> *points, const std::size_t *sizes,
                 std::size_t rings)
    : Polygon(host) {
    for (std::size_t ring = 0; ring < rings; points += sizes[ring++])
        for (std::size_t i = 0; i < sizes[ring]; ++i)
            add_edge(points[i], points[i + 1 < sizes[ring] ? i + 1 : 0]);
    finish(host);
}

void Polygon::add_edge(const Point<2> &a, const Point<2> &b) {
    if (a == b) return;
    edges_.push_back(lexicographically_less<2>(a, b) ? Edge{a, b} : Edge{b, a});
    edge_tree_.add(box_around(a, b));
}

/// After the last edge.
void Polygon::finish(const Host &host) {
    edge_tree_.finish();
    box_ = edge_tree_.around_all();
    Sweep(host, *this).run();
    for (const Part &part : parts_) part_tree_.add(box_of(part));
    part_tree_.finish();
}

Box<2> Polygon::box_of(const Part &part) const {
    Box<2> box;
    for (const std::uint32_t i : {part.lower, part.upper})
        for (const double x : {part.left, part.right})
            box.extend(box_at(edges_[i].left, edges_[i].right, x));
    return box;
}

// ---- In rational numbers ---------------------------------------------------------------

struct Polygon::Exact {
    const Polygon &polygon;

    /// As side(), of a place in a box.
    int side(const Place &place, const Box<2> &around) const {
        RightOf<Place> right(place);
        polygon.each_edge({around.lower, {infinity, around.upper[1]}},
                          [&](const Point<2> &a, const Point<2> &b) {
                              return right.count(place_of(a), place_of(b));
                          });
        return right.side();
    }
    /// Where the border meets a segment, as a share of it. A proper crossing, of an edge that goes
    /// on on both sides, leads from the inside to the outside or back; at another place it may do
    /// either.
    struct Cut {
        Rational share;
        bool is_proper;
    };
    std::pmr::vector<Cut> cuts(std::pmr::memory_resource &memory, const Point<2> &a,
                               const Point<2> &b) const {
        std::pmr::vector<Cut> cuts(&memory);
        const Place from = place_of(a), to = place_of(b);
        const auto add = [&](Rational share, bool is_proper) {
            if (share > 0 && share < 1) cuts.push_back({std::move(share), is_proper});
        };
        polygon.each_edge(box_around(a, b), [&](const Point<2> &c, const Point<2> &d) {
            const int at_c = orientation(a, b, c), at_d = orientation(a, b, d);
            if (at_c == 0) add(share_at(from, to, place_of(c)), false);
            if (at_d == 0) add(share_at(from, to, place_of(d)), false);
            if (at_c * at_d < 0 && orientation(c, d, a) * orientation(c, d, b) < 0)
                add(share_at(from, to, place_of(c), place_of(d)), true);
            return true;
        });
        std::sort(cuts.begin(), cuts.end(),
                  [](const Cut &p, const Cut &q) { return p.share < q.share; });
        std::size_t count = 0;
        for (Cut &cut : cuts)
            if (count > 0 && cuts[count - 1].share == cut.share)
                cuts[count - 1].is_proper = false; // several meet there
            else
                std::swap(cuts[count++], cut);
        cuts.erase(cuts.begin() + static_cast<std::ptrdiff_t>(count), cuts.end());
        return cuts;
    }
    /// Calls visit(share, share) for the stretches of a segment that are inside or on the border.
    template <class Visit>
    void each_stretch(const Point<2> &a, const Point<2> &b, Visit visit) const {
        const Box<2> around = box_around(a, b);
        if (!around.meets(polygon.box_)) return;
        HostMemory memory(polygon.memory_);
        std::pmr::vector<Cut> cuts = this->cuts(memory, a, b);
        cuts.push_back({Rational(1), false});
        const Place from = place_of(a), to = place_of(b);
        const Rational zero(0);
        const auto is_inside = [&](const Rational &begin, const Rational &end) {
            return side(along(from, to, (begin + end) / 2), around) >= 0;
        };
        const int at = polygon.side(a);
        bool inside = at != 0 ? at > 0 : is_inside(zero, cuts[0].share);
        Rational begin = zero; // of the stretch
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            const Rational &here = cuts[i].share;
            const bool is_last = i + 1 == cuts.size();
            const bool goes_on =
                !is_last && (cuts[i].is_proper ? !inside : is_inside(here, cuts[i + 1].share));
            if (inside && !goes_on) visit(begin, here);
            if (!inside && goes_on) begin = here;
            inside = goes_on;
        }
    }
};

// ---- Questions -------------------------------------------------------------------------

int Polygon::side(const Point<2> &p) const {
    if (!box_.contains(p)) return -1;
    RightOf<Point<2>> right(p);
    each_edge({p, {infinity, p[1]}},
              [&](const Point<2> &a, const Point<2> &b) { return right.count(a, b); });
    return right.side();
}

bool Polygon::overlaps(const Corners<2> &triangle) const {
    Box<2> around;
    for (const Point<2> *corner : triangle) around.extend(*corner);
    if (!around.meets(box_)) return false;
    bool has_edge = false;
    each_edge(around, [&](const Point<2> &a, const Point<2> &b) {
        has_edge = passes_through(a, b, triangle);
        return !has_edge;
    });
    if (has_edge) return true; // and the inside is on one side of it
    for (const Point<2> *corner : triangle)
        if (const int at = side(*corner); at != 0) return at > 0;
    Place middle{0, 0};
    for (int axis = 0; axis < 2; ++axis) {
        for (const Point<2> *corner : triangle) middle[axis] += Rational((*corner)[axis]);
        middle[axis] /= 3;
    }
    return Exact{*this}.side(middle, around) > 0;
}

bool Polygon::overlaps(const Point<2> &a, const Point<2> &b) const {
    bool has_stretch = false;
    Exact{*this}.each_stretch(a, b,
                              [&](const Rational &, const Rational &) { has_stretch = true; });
    return has_stretch;
}

void Polygon::cut(const Point<2> &a, const Point<2> &b,
                  const std::function<void(const Stretch &)> &visit) const {
    const Box<2> around = box_around(a, b);
    if (!around.meets(box_)) return;
    if (!has_edge_near(around)) { // most segments: all or nothing
        if (side(a) > 0) visit({0, 1, a, b});
        return;
    }
    const Place from = place_of(a), to = place_of(b);
    const auto place_at = [&](const Rational &share) {
        return share == 0 ? a : share == 1 ? b : rounded(along(from, to, share));
    };
    Exact{*this}.each_stretch(a, b, [&](const Rational &begin, const Rational &end) {
        visit({exact::nearest_double(begin), exact::nearest_double(end), place_at(begin),
               place_at(end)});
    });
}

} // namespace abacus
