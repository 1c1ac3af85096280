// Points inserted or removed, and edges of segments fixed, by several threads.
//
// Points come in rounds, each along the curve. Those that are inserted are gathered until the next
// round begins, unless their round is large: then the next one is gathered with it. Those that are
// removed come in rounds from the last to the first, and are gathered over all rounds: the mesh is
// not in memory yet, and is read once. Points are gathered at most until they take a share of the
// memory that the build has. A few are dealt with here and now, as with one thread: those of small
// rounds, or a small change. Many are dealt with together:
//
//   1. The mesh is cut where the threads' intervals begin (cuts.hpp). Threads find the points near
//      the borders (near_border.hpp), the session's thread inserts them, and its pages are handed
//      over to the threads.
//   2. Each thread inserts or removes the points of its interval, in a cache of its own
//      (interval.hpp), and writes its pages. The session's thread serves it. Meanwhile it gathers
//      the next points to be inserted, if they come in several batches.
//   3. Some points near borders have been put off. Each two intervals are joined, and the points
//      put off there are dealt with in the same way: the border is inside now.
//   4. When one interval is left, or few points are, the session's thread does the rest.
//
// The session's thread deals with points that equal a vertex after each pass, in their order, since
// their pages are its own; at the end if they give the vertex another id. Points to be removed at a
// place with such points are removed at the end.
//
// Segments come once along the curve, by their lesser ends, and are dealt with as points that are
// inserted.
//
// Points near borders are not removed first. The session's thread would have to read the mesh for
// them, and the stars of the full mesh are small.
#pragma once

#include "change/cuts.hpp"
#include "change/interval.hpp"
#include "change/near_border.hpp"
#include "change/pass.hpp"
#include "change/workspace.hpp"
#include "host/crew.hpp"

#include <chrono>
#include <optional>

namespace abacus {

template <int D> class Gathering {
public:
    using Removing = typename Interval<D>::Removing;

    /// What is done with the points.
    class User {
    public:
        virtual Deed deed() const = 0;
        /// Whether threads may take part now.
        virtual bool is_shared() const = 0;
        /// Whether points that equal a vertex have to wait for the last pass.
        virtual bool keeps_left() const = 0;
        /// Deals with some points, in the session's thread.
        virtual void take(const std::uint64_t *records, const std::uint64_t *codes,
                          std::size_t n) = 0;
        /// After the last of them: threads may go on from here.
        virtual void finish_here() = 0;
        /// Deals with a point that the threads have left to the session's thread.
        virtual void take_left(const std::uint64_t *record) = 0;
        /// How threads remove points, until end_sharing(); null if they do something else.
        virtual const Removing *begin_sharing() = 0;
        virtual void end_sharing() = 0;
        /// See Interval::insert().
        virtual bool counts_crowded() const = 0;

    protected:
        ~User() = default;
    };

    explicit Gathering(Workspace<D> &work);
    Gathering(const Gathering &) = delete;
    Gathering &operator=(const Gathering &) = delete;
    ~Gathering() { stop(); }

    /// About `points` points come, and `words` words of each are used. The user gets them until
    /// the next begin().
    void begin(User &user, std::uint64_t points, std::size_t words);
    /// Whether there are threads, and room for enough points to be worth sharing.
    bool gathers() const;
    /// Records of points that are removed may come without attributes.
    void gather(const std::uint64_t *records, std::size_t n, std::size_t stride);
    /// The next n, of `words` words each, with their codes.
    void gather(const std::uint64_t *records, std::size_t words, const std::uint64_t *codes,
                std::size_t n);
    /// After the last point: inserts the gathered points, or removes them.
    void finish();
    /// After a failure: stops threads that are at work.
    void stop() noexcept {
        if (crew_) crew_->stop();
        pass_.reset(); // its results are in the crew's memory
    }
    /// If threads are at work: gives them what they ask for now.
    void meanwhile() {
        if (pass_) serve();
    }
    /// The points that are gathered, and not yet done.
    std::size_t size() const { return gathered_.size() + working_.size(); }
    /// The memory for the cache of each thread.
    std::size_t thread_cache_bytes() const;

private:
    bool removes() const { return user_->deed() == Deed::remove; }
    /// The memory for this many gathered points, with copies of those that have to wait.
    std::size_t gathered_bytes(std::size_t points) const;
    /// The memory for the session's cache: with threads, what the gathered points leave.
    std::size_t own_cache_bytes() const;
    bool is_worth_sharing() const;
    bool takes_several_rounds() const;
    Cuts cuts_for_threads() const;
    /// Inserts the gathered points, or begins to, or removes them.
    void change();
    void change_here();
    bool begin_work();
    void end_work();
    bool begin_pass();
    bool end_pass();
    void serve();
    /// For a point that the threads have left to the session's thread.
    void deal_with_left(std::size_t i);
    void take_results(const typename Interval<D>::Results &results, Arena<std::size_t> &put_off);
    /// Inserts gathered points that threads would put off.
    void insert_near_borders(const Cuts &cuts);
    typename NearBorder<D>::Marks near_border(NearBorder<D> &border, std::size_t word) const;
    void report_pass(std::uint64_t done);
    /// Hands the pages to the threads and begins with an empty cache.
    void hand_over(const Cuts &cuts);
    /// After the threads: stores what none of them has changed.
    void store_in_hand();

    Workspace<D> &work_;
    const Host &host_;
    User *user_ = nullptr;
    Batch gathered_;           ///< so far
    Batch working_;            ///< being inserted, or removed
    Batch left_;               ///< what the threads have left to the session's thread
    std::optional<Cuts> cuts_; ///< of the points being inserted, or removed
    const Removing *how_ = nullptr;
    std::optional<Crew> crew_;           ///< from the first pass on
    std::optional<Pass<D>> pass_;        ///< while threads are at work
    std::size_t most_gathered_ = 0;      ///< points
    bool gathers_ahead_ = false;         ///< while threads are at work
    std::uint64_t done_ = 0, to_do_ = 0; ///< gathered points, for reports
    std::chrono::steady_clock::time_point reported_{};
};

extern template class Gathering<2>;
extern template class Gathering<3>;

} // namespace abacus
