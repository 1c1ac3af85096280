// Attributes of points that wait, changed.
//
// Waiting points are in no order in which one could be found. So, as in WaitingPoints, many are
// looked for at once: one run over all of them tells which points are meant. Their pages are then
// written in place.
#pragma once

#include "host/arena.hpp"
#include "points/record.hpp"
#include "points/vertex_reader.hpp"

#include <optional>
#include <span>

namespace abacus {

template <int D> class WaitingChanges {
public:
    /// Those of a mesh with so many attributes, of which `which` are changed.
    WaitingChanges(const Host &host, unsigned attributes, std::span<const std::uint32_t> which)
        : host_(host), attributes_(attributes), which_(which), wanted_(host), values_(host),
          found_(host) {}

    /// Wants other attributes for a point with these coordinates: of several the one with this id,
    /// or else the first. Of several wants for a point the last one counts.
    void want(const std::uint64_t *record);
    bool is_full() const { return wanted_.size() * (sizeof(Wanted) + 8 * which_.size()) >= bytes; }

    /// Changes those of the points [from, to), and forgets all wants. Returns for how many of them
    /// there was a point; `missing` becomes the first for which there was none, unless it is set.
    std::uint64_t apply(std::uint64_t from, std::uint64_t to,
                        std::optional<std::array<std::uint64_t, 1 + D>> &missing);

private:
    static constexpr std::size_t bytes = 3 << 19; // for what is wanted
    static constexpr std::uint64_t none = ~std::uint64_t(0);

    struct Wanted {
        Point<D> point;
        std::int64_t id;
        std::uint32_t order;          ///< among all wants
        std::uint64_t first = none;   ///< of the first want for a place: a point there
        std::uint64_t with_id = none; ///< of the first for an id there: a point that has it
    };
    /// A point that gets the values of a want.
    struct Found {
        std::uint64_t sequence;
        std::uint32_t order;
    };
    void find_points(std::uint64_t from, std::uint64_t to);
    /// Tells which point each want is for; the order of the first one without, or `none`.
    std::uint64_t choose();
    void write();

    const Host &host_;
    const unsigned attributes_;
    const std::span<const std::uint32_t> which_;
    Arena<Wanted> wanted_;
    Arena<std::uint64_t> values_; // of each want, in their order
    Arena<Found> found_;
};

extern template class WaitingChanges<2>;
extern template class WaitingChanges<3>;

} // namespace abacus
