// Answers places that come along the curve with several threads.
//
// They are gathered, and cut into pieces along the curve. An idle thread takes the next piece,
// answers it with a cache of its own, and puts the answers on a tape. The session's thread serves
// the threads with pages, and reports the answers piece by piece: so they come in the order of the
// places, no matter which thread has found them.
//
// Memory. Gathered places and answers take at most a third of the cache's memory, the caches of the
// threads the rest. The length of an answer is a guess: a piece ends early when its tape is full,
// and the rest of it is answered when the tape has been reported.
//
// Errors. An error that a thread finds in the mesh is kept with its piece, and raised when the
// pieces before it have been reported: the first error along the curve counts.
#pragma once

#include "host/crew.hpp"
#include "query/places/question.hpp"

#include <chrono>

namespace abacus {

template <int D> class PlacesTogether {
public:
    /// Whether there are threads, so many places that they are worth it, and room for them.
    static bool is_worth_while(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
                               const Question<D> &question, std::uint64_t total);

    /// `total`: places that will come.
    PlacesTogether(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
                   const Question<D> &question, std::uint64_t total);

    /// Adds a place; true if it is time to answer.
    bool gather(const std::uint64_t *record) {
        std::copy_n(record, stride, places_.extend(stride));
        return held_back() == most_gathered_;
    }
    std::size_t held_back() const { return places_.size() / stride; }
    /// Answers the gathered places, and forgets them. Does nothing and returns false if the system
    /// grants no thread.
    bool answer();
    /// Calls visit(record) for the gathered places, and forgets them.
    template <class Visit> void each_gathered(Visit visit) {
        for (std::size_t i = 0; i < held_back(); ++i) visit(place(i));
        forget_gathered();
    }
    /// Pages handed to threads so far.
    std::uint64_t pages_read() const { return pages_read_; }

private:
    static constexpr std::size_t stride = 1 + D; // words of a place

    /// Consecutive places and their answers.
    struct Piece {
        explicit Piece(const Memory &memory) : tape(memory) {}

        std::size_t told, answered, end; // numbers of gathered places
        Tape tape;                       // answered but not yet reported
        std::exception_ptr failure;      // at the next place
        std::atomic<bool> is_ready;      // to be reported
    };
    class Round;

    const std::uint64_t *place(std::size_t i) const { return places_.data() + i * stride; }
    void forget_gathered() {
        done_ += held_back();
        places_.clear();
    }
    /// Cuts the gathered places.
    void cut();
    void answer(Piece &piece, const Host &host);
    bool has_to_tell() const {
        return first_ < cut_ && pieces_[first_].is_ready.load(std::memory_order_acquire);
    }
    /// Reports some answers, if the next ones are there.
    void tell_some();
    void report_progress();

    const Host &host_;
    const abacus_facts &facts_;
    const Question<D> &question_;
    const std::uint64_t total_;
    const std::size_t most_gathered_, thread_bytes_;
    std::uint64_t done_ = 0, pages_read_ = 0;
    std::chrono::steady_clock::time_point reported_{};
    Arena<std::uint64_t> places_;
    Crew crew_;
    HostMemory memory_;
    std::pmr::deque<Piece> pieces_;
    std::size_t cut_ = 0;                // pieces in use
    std::size_t first_ = 0;              // first of them that is not completely reported
    std::optional<Tape::Player> player_; // of its tape
    std::size_t most_words_ = 0;         // of a tape, about
    std::atomic<std::size_t> first_failed_;
    OfEachThread<Answerer<D>> answerers_;
};

extern template class PlacesTogether<2>;
extern template class PlacesTogether<3>;

} // namespace abacus
