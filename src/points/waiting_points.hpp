// Taking points away from those that wait.
//
// Waiting points are in no order in which one could be found. So many are looked for at once, in
// two runs over all of them. The first run finds the points that may leave; each place then
// chooses among them as it does in the triangulation (leaving.hpp). The second run writes the
// other points behind the last page and erases the pages it has read. All points may be at one
// place. So no point is compared with all wants for its place, and no more are kept than the
// wants can take.
#pragma once

#include "host/arena.hpp"
#include "points/leaving.hpp"
#include "points/record.hpp"
#include "points/vertex_reader.hpp"

namespace abacus {

template <int D> class WaitingPoints {
public:
    /// `exactly`: takes only points that have the id and the attributes wanted.
    WaitingPoints(const Host &host, unsigned attributes, bool exactly)
        : host_(host), attributes_(attributes), exactly_(exactly),
          identities_(host, exactly ? attributes : 0),
          most_(bytes / (sizeof(Wanted) + identities_.bytes_each())), wanted_(host),
          candidates_(host), found_(host), leaving_(host, bytes, exactly, 0) {}

    /// Wants a point taken away: a point with these coordinates. Of several it is the
    /// one with this id, or else (unless exactly) the first. Wants are met one after the
    /// other.
    void want(const Point<D> &p, std::int64_t id, const double *attributes) {
        const auto order = static_cast<std::uint32_t>(wanted_.size());
        wanted_.push_back({p, identities_.enter(id, attributes), order, 0, 0});
    }
    bool is_full() const { return wanted_.size() >= most_; }

    /// Takes them away from the points [from, to); `to` becomes the end of those that are
    /// left, `from` their beginning. Returns how many were taken.
    std::uint64_t take(std::uint64_t &from, std::uint64_t &to);
    /// The same for all points at the places wanted, whatever their ids: in one run.
    std::uint64_t take_all(std::uint64_t &from, std::uint64_t &to);
    /// The id of the last point that take_all() has taken.
    std::int64_t last_taken() const { return last_taken_; }

private:
    static constexpr std::size_t bytes = 3 << 19; // for what is wanted

    struct Wanted {
        Point<D> point;
        std::int64_t identity;
        std::uint32_t order;   ///< among all wants
        std::uint32_t offered; ///< of the first want for a place: candidates there
        std::uint32_t behind;  ///< of the first for an identity: those behind the first points
    };
    /// A point that may leave.
    struct Candidate {
        std::uint32_t place; ///< number of its first want
        std::uint64_t sequence;
        std::int64_t identity;
    };
    void find_candidates(std::uint64_t from, std::uint64_t to);
    void choose();
    template <class Leaves>
    std::uint64_t take_those(std::uint64_t &from, std::uint64_t &to, Leaves leaves);

    const Host &host_;
    const unsigned attributes_;
    const bool exactly_;
    Identities identities_;
    const std::size_t most_;
    Arena<Wanted> wanted_;
    Arena<Candidate> candidates_;
    Arena<std::uint64_t> found_; // sequence numbers of the points that leave
    Leaving leaving_;            // those of one place
    std::int64_t last_taken_ = 0;
};

extern template class WaitingPoints<2>;
extern template class WaitingPoints<3>;

} // namespace abacus
