// Taking points away from those that wait.
//
// They are in no order in which one could be found, so many are looked for at once, in
// two runs over all of them: the first finds the points meant, the second writes the
// others anew behind the last page and erases the pages it has read. All may be at one place,
// so no point is compared with all wants for its place.
#pragma once

#include "host/arena.hpp"
#include "points/identities.hpp"
#include "points/record.hpp"
#include "points/vertex_reader.hpp"

namespace abacus {

template <int D> class WaitingPoints {
public:
    /// `exactly`: takes only points that have the id and the attributes wanted.
    WaitingPoints(const Host &host, unsigned attributes, bool exactly)
        : host_(host), attributes_(attributes), exactly_(exactly),
          identities_(host, exactly ? attributes : 0),
          most_(bytes / (sizeof(Wanted) + identities_.bytes_each())), wanted_(host), found_(host) {}

    /// Wants a point taken away: one with these coordinates, and of several the one with
    /// this id, or else (unless exactly) the first.
    void want(const Point<D> &p, std::int64_t id, const double *attributes) {
        wanted_.push_back({p, identities_.enter(id, attributes), false, 0});
    }
    bool is_full() const { return wanted_.size() >= most_; }

    /// Takes them away from the points [from, to); `to` becomes the end of those that are
    /// left, `from` their beginning. Returns how many were taken.
    std::uint64_t take(std::uint64_t &from, std::uint64_t &to);

private:
    static constexpr std::size_t bytes = 1 << 20; // for what is wanted

    struct Wanted {
        Point<D> point;
        std::int64_t identity;
        bool is_met;         ///< by a point with it
        std::uint32_t unmet; ///< of the first want for a place: how many take any point there
    };
    void find(std::uint64_t from, std::uint64_t to);
    bool is_wanted(const VertexReader<D> &reader);

    const Host &host_;
    const unsigned attributes_;
    const bool exactly_;
    Identities identities_;
    const std::size_t most_;
    Arena<Wanted> wanted_;
    Arena<std::uint64_t> found_; // sequence numbers of the points that meet a want by their ids
    std::size_t found_again_ = 0; // of them, in the second run
};

extern template class WaitingPoints<2>;
extern template class WaitingPoints<3>;

} // namespace abacus
