// Where points are, by which a domain is chosen.
//
// The box of all points will not do. One garbage coordinate, a "no data" of -3.4e38 among metres,
// puts all other points into one cell of the curve, where only parts tell their simplices apart
// (locational_code.hpp). Points outside a domain, on the other hand, are clamped to its border,
// which does no harm as long as they are few.
//
// So besides the box there is a sample of the distinct points: those with the least hashes. It is a
// function of the set of points, whatever their order. The sample of two sets together follows from
// their two samples. A domain misplaces a point of the sample if the point lies outside, or shares
// its code with so many others that they take a good part of a page, as far as the sample tells.
// The box is taken if it misplaces few. Otherwise boxes compete that leave out more and more of the
// sample: on each axis the shortest interval that has all but a few of the points, with room for
// points not in the sample. A box wins if it misplaces less than half as many. So outliers on any
// side lose. Of two clusters that one domain can resolve, none loses. And where no linear scale
// would do (points at all magnitudes, ten clusters too far apart) the box stays.
#pragma once

#include "geometry/box.hpp"
#include "host/arena.hpp"
#include "points/point_hash.hpp"
#include "points/record.hpp"

#include <cstdint>

namespace abacus {

template <int D> class Spread {
public:
    explicit Spread(const Host &host) : host_(host), sample_(host) {}

    /// With canonical coordinates (no -0.0).
    void add(const Point<D> &p) {
        box_.extend(p);
        const std::uint64_t hash = point_hash(p);
        if (hash < least_excluded_) add({hash, p});
    }
    /// The points of n records.
    void add(const std::uint64_t *records, std::size_t n, std::size_t stride) {
        Box<D> box = box_; // in registers
        for (; n > 0; --n, records += stride) {
            const Point<D> p = record_point<D>(records);
            box.extend(p);
            const std::uint64_t hash = point_hash(p);
            if (hash < least_excluded_) [[unlikely]]
                add({hash, p});
        }
        box_ = box;
    }
    /// Points of which only the box is known, and those of their sample, which are added besides.
    void extend(const Box<D> &box) { box_.extend(box); }
    void add(const Spread &other) {
        box_.extend(other.box_);
        for (const Drawn &drawn : other.sample_)
            if (drawn.hash < least_excluded_) add(drawn);
    }

    /// Around all points.
    const Box<D> &box() const { return box_; }
    /// The box for a domain: `first`, unless another one serves the points far better.
    Box<D> choose(const Box<D> &first);
    Box<D> choose() { return choose(box_); }
    /// Whether a domain around the first box places the points far better than one around the
    /// second.
    bool is_better(const Box<D> &box, const Box<D> &than);

    /// Memory that it takes at most, but while it chooses.
    static constexpr std::size_t most_bytes = 2048 * sizeof(std::uint64_t) * (1 + D);

private:
    struct Drawn {
        std::uint64_t hash;
        Point<D> point;
    };
    /// Points of the sample; twice as many are held until it is cut.
    static constexpr std::size_t most = 1024;
    static_assert(most_bytes == 2 * most * sizeof(Drawn));

    void add(const Drawn &drawn) {
        if (sample_.size() == 2 * most) cut();
        if (drawn.hash < least_excluded_) sample_.push_back(drawn);
    }
    void cut();
    std::size_t misplaced_by(const Box<D> &box);
    Box<D> all_but(std::size_t few, const Arena<double> &sorted) const;

    const Host &host_;
    Box<D> box_;
    Arena<Drawn> sample_;
    std::uint64_t least_excluded_ = UINT64_MAX; // hash
};

extern template class Spread<2>;
extern template class Spread<3>;

} // namespace abacus
