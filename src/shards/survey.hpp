// A survey of the points of a mesh before they are dealt out to shards: the domain that one server
// would choose for them, and the borders of the shards.
//
// Each server surveys the points it has. The samples are drawn by the hashes of points, so the
// sample of all points follows from those of the servers, and is a function of the set of points.
#pragma once

#include "keys/domain_of.hpp"
#include "points/canonical.hpp"
#include "points/point_hash.hpp"
#include "points/record.hpp"
#include "points/spread.hpp"

#include <abacus/facts.h>
#include <optional>

namespace abacus {

template <int D> class Survey {
public:
    /// `facts` has the shape of the points; perhaps a domain.
    Survey(const Host &host, const abacus_facts &facts)
        : stride_(record_words(D, facts.columns.attributes)), spread_(host), drawn_(host),
          sample_(host), codes_(host) {
        if (facts.form.has_domain != 0) given_ = domain_box<D>(facts.form);
    }

    /// Records as in abacus_stage_add.
    void add(const std::uint64_t *records, std::size_t count);
    /// Another survey's result: how many points, in which box, and its sample.
    void merge(std::uint64_t points, const Box<D> &box, const Point<D> *sample, std::size_t count);

    std::uint64_t points() const { return points_; }
    /// Around all points; empty without any.
    const Box<D> &box() const { return spread_.box(); }
    /// The points drawn, in the order of their hashes: all of them, unless they are too many.
    const Arena<Point<D>> &sample();
    /// The box of the domain that a mesh of these points has on one server.
    Box<D> domain() { return given_ ? *given_ : spread_.choose(); }
    /// Borders that cut the curve over a domain into as many stretches as shards, with about
    /// equally many distinct points each. A border may move by a 32nd of a share, to the coarsest
    /// cell, whose edges are long: there it is short. They ascend.
    void borders(const Domain<D> &domain, std::uint32_t shards, std::uint64_t *borders);

    /// Points of a sample.
    static constexpr std::size_t most = std::size_t{1} << 14;

private:
    struct Drawn {
        std::uint64_t hash;
        Point<D> point;
    };
    void draw(const Point<D> &p);
    void cut();

    const std::size_t stride_;
    std::optional<Box<D>> given_;
    std::uint64_t points_ = 0;
    Spread<D> spread_;
    Arena<Drawn> drawn_;                        // twice as many as the sample has, until it is cut
    std::uint64_t least_excluded_ = UINT64_MAX; // hash
    Arena<Point<D>> sample_;
    Arena<std::uint64_t> codes_; // of the sample
};

extern template class Survey<2>;
extern template class Survey<3>;

} // namespace abacus
