// Tells which of the equal points at one place leave, when some are taken away one after the
// other.
//
// Each time the first point with the wanted id leaves, or, if none has it, the first of all.
// With `exactly`, only a point leaves that has the wanted id and attributes;
// points/identities.hpp makes numbers of these, and what is said of ids here holds for them.
// What an id takes depends on the points that have left before. Still one run over the points
// of the place finds all of them.
//
// A point that leaves because no point has the wanted id is the first one left: all before it
// have gone. Of n wants at most n - 1 have been met by then, so it is one of the first n
// points of the place. Of the points behind those, only points with a wanted id count, of
// each id as many as are wanted. No more is kept of a place, however many points it has.
#pragma once

#include "host/arena.hpp"
#include "points/identities.hpp"

#include <algorithm>
#include <cstdint>

namespace abacus {

class Leaving {
public:
    /// For as many wants as take about so many bytes. `exactly`: a point leaves only if it has
    /// the id and all of so many attributes of a wanted one.
    Leaving(const Host &host, std::size_t bytes, bool exactly, unsigned attributes);

    /// Wants the next point taken away.
    void want(std::int64_t id, const double *attributes) {
        wants_.push_back(identities_.enter(id, attributes));
    }
    bool is_full() const { return wants_.size() >= most_; }
    bool empty() const { return wants_.empty(); }
    /// Whether the attributes of points make a difference.
    bool compares_attributes() const { return identities_.has_attributes(); }
    /// Whether a want takes this point, if there is no other at the place.
    bool takes(std::int64_t id, const double *attributes) {
        return !exactly_ || std::find(wants_.begin(), wants_.end(),
                                      identities_.find(id, attributes)) != wants_.end();
    }
    /// Forgets all wants.
    void clear() {
        wants_.clear();
        identities_.clear();
    }

    /// No more wants come; the points of the place do.
    void begin();
    /// The next point, in the order of input. False if the others make no difference.
    bool offer(std::int64_t id, const double *attributes, std::uint64_t serial);
    /// After the last point that makes a difference.
    void decide();

    /// Whether the point that was offered first leaves.
    bool has_first() const { return candidates_[0].leaves; }
    /// Calls visit(serial) for the others that leave, in the order of input.
    template <class Visit> void each_other(Visit visit) const {
        for (std::size_t i = 1; i < candidates_.size(); ++i)
            if (candidates_[i].leaves) visit(candidates_[i].serial);
    }

private:
    static constexpr std::uint32_t none = 0xffffffffu;

    /// A point that may leave.
    struct Candidate {
        std::uint64_t serial;
        std::uint32_t next; ///< with the same id, if that is wanted
        bool leaves;
    };
    /// An id that is wanted, in the order of ids.
    struct Wanted {
        std::int64_t id;
        std::uint32_t times;
        std::uint32_t offered;     ///< candidates that have it
        std::uint32_t behind;      ///< of them, those behind the first points of the place
        std::uint32_t first, last; ///< of them
    };
    static constexpr std::size_t bytes_a_want =
        sizeof(std::int64_t) + sizeof(Wanted) + 2 * sizeof(Candidate);

    Wanted *find(std::int64_t id);
    /// The candidate that leaves for a want, or none.
    std::uint32_t choose(Wanted &wanted);

    const bool exactly_;
    Identities identities_;
    const std::size_t most_;
    Arena<std::int64_t> wants_; // in their order
    Arena<Wanted> wanted_;
    Arena<Candidate> candidates_; // in the order of input
    std::size_t unmet_ = 0;       // ids wanted more often than they have been offered
    std::uint32_t front_ = 0;     // all candidates before have left
};

} // namespace abacus
