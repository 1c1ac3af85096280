#include "query/places/places_threads.hpp"

#include "points/record.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

namespace {

/// From this number of places on, threads pay off although they read and decode some pages more
/// than once.
constexpr std::size_t places_worth_sharing = 1 << 13;
/// For a quick question: with fewer places, fetching pages by the session's thread takes longer
/// than the work on them.
constexpr std::uint64_t simplices_a_place = 32;
/// More places at once gain nothing.
constexpr std::size_t most_at_once = 1 << 18;
/// For tests.
constexpr std::size_t tiny_gathered = 61, tiny_piece = 4;
/// Share of the cache's memory that gathered places and answers may take.
constexpr std::size_t gathered_share = 3;
/// Pieces for each thread, so that no thread waits long for the last one.
constexpr std::size_t pieces_a_thread = 8;
/// Answers that are returned before the threads' requests are served again.
constexpr std::size_t told_at_once = 64;
/// After this number of places a thread checks whether it has to end.
constexpr std::size_t poll_every = 64;

/// How many places may be gathered.
std::size_t room(const Host &host, std::size_t words, std::size_t cache_bytes) {
    if (host.has_tiny_intervals()) return tiny_gathered;
    return std::min(most_at_once, cache_bytes / gathered_share / (words * sizeof(std::uint64_t)));
}

} // namespace

template <int D>
bool PlacesTogether<D>::is_worth_while(const Host &host, const abacus_facts &facts,
                                       std::size_t cache_bytes, const Question<D> &question,
                                       std::uint64_t total) {
    if (host.threads() == 1 || host.has_tiny_intervals()) return host.threads() > 1;
    const std::uint64_t least =
        question.is_quick() ? (facts.census.simplices + facts.census.ghosts) / simplices_a_place
                            : 0;
    return total >= std::max<std::uint64_t>(least, places_worth_sharing) &&
           room(host, stride + question.words(), cache_bytes) >= places_worth_sharing;
}

template <int D>
PlacesTogether<D>::PlacesTogether(const Host &host, const abacus_facts &facts,
                                  std::size_t cache_bytes, const Question<D> &question,
                                  std::uint64_t total)
    : host_(host), facts_(facts), question_(question), total_(total),
      most_gathered_(room(host, stride + question.words(), cache_bytes)),
      thread_bytes_((cache_bytes - cache_bytes / gathered_share) / host.threads()), places_(host),
      crew_(host), memory_(host), pieces_(&memory_), answerers_(host, host.threads()) {}

template <int D> void PlacesTogether<D>::cut() {
    const std::size_t n = held_back();
    std::size_t most =
        (n + host_.threads() * pieces_a_thread - 1) / (host_.threads() * pieces_a_thread);
    cut_ = first_ = 0;
    std::uint64_t state = n;
    for (std::size_t begin = 0, end; begin < n; begin = end, ++cut_) {
        state = (state ^ state >> 29) * 0xd6e8feb86659fd93 + 1;
        if (host_.has_tiny_intervals()) most = 1 + (state >> 40) % (2 * tiny_piece);
        end = std::min(begin + most, n);
        if (pieces_.size() == cut_) pieces_.emplace_back(crew_.memory().memory());
        Piece &piece = pieces_[cut_];
        piece.told = piece.answered = begin;
        piece.end = end;
        piece.tape.clear();
        piece.is_ready.store(false, std::memory_order_relaxed);
    }
    most_words_ = std::max<std::size_t>(most, 1) * question_.words();
    first_failed_.store(n, std::memory_order_relaxed);
}

/// The work of all threads; or of one thread, on the first unfinished piece.
///
/// A thread goes on with the piece behind its last one, whose pages it may have, as long as nobody
/// has begun there.
template <int D> class PlacesTogether<D>::Round final : public Crew::Work {
public:
    Round(PlacesTogether &all, unsigned threads, std::size_t pieces)
        : all_(all), first_(all.first_), is_taken_(all.host_), next_(all.host_, threads) {
        is_taken_.resize(pieces);
        std::fill(is_taken_.begin(), is_taken_.end(), false);
    }

    void piece(std::size_t, const Host &host) override {
        all_.answer(all_.pieces_[first_ + take(next_.get(host))], host);
    }
    void meanwhile() override {
        all_.tell_some();
        all_.report_progress();
    }
    bool is_busy() const override { return all_.has_to_tell(); }

private:
    struct Next {
        explicit Next(const Host &) {}
        std::size_t piece = std::numeric_limits<std::size_t>::max();
    };

    /// As many pieces are taken as there are.
    std::size_t take(Next &next) {
        const std::lock_guard guard(lock_);
        const bool goes_on = next.piece < is_taken_.size() && !is_taken_[next.piece];
        const std::size_t piece = goes_on ? next.piece : middle_of_longest();
        is_taken_[piece] = true;
        next.piece = piece + 1;
        return piece;
    }
    /// Of the stretches that nobody has taken; the beginning of all pieces if that is free.
    std::size_t middle_of_longest() const {
        if (!is_taken_[0]) return 0;
        std::size_t middle = 0, longest = 0;
        for (std::size_t begin = 0, end; begin < is_taken_.size(); begin = end) {
            for (end = begin; end < is_taken_.size() && !is_taken_[end];) ++end;
            if (end - begin > longest) {
                longest = end - begin;
                middle = begin + longest / 2;
            }
            while (end < is_taken_.size() && is_taken_[end]) ++end;
        }
        return middle;
    }

    PlacesTogether &all_;
    const std::size_t first_;
    std::mutex lock_;
    Arena<bool> is_taken_; // pieces, from the first on
    OfEachThread<Next> next_;
};

template <int D> bool PlacesTogether<D>::answer() {
    cut();
    const auto run = [&](unsigned threads, std::size_t pieces) {
        Round round(*this, threads, pieces);
        const bool has_run = crew_.run(threads, pieces, round);
        pages_read_ += crew_.desk().pages_read();
        return has_run;
    };
    if (!run(host_.threads(), cut_)) return false;
    while (first_ < cut_) {
        host_.poll();
        if (has_to_tell())
            tell_some();
        else if (!run(1, 1)) // its tape was full
            throw Error(ABACUS_ERROR_MEMORY, "could not start a thread");
    }
    forget_gathered();
    return true;
}

template <int D> void PlacesTogether<D>::answer(Piece &piece, const Host &host) {
    try {
        Answerer<D> &by = answerers_.get(host, facts_, thread_bytes_);
        piece.tape.reserve(most_words_);
        for (std::size_t i = piece.answered; i < piece.end; ++i) {
            if (i % poll_every == 0) host.poll();
            // No answer after the first failure is returned.
            if (piece.tape.size() > most_words_ ||
                i > first_failed_.load(std::memory_order_relaxed))
                break;
            question_.answer(by, record_point<D>(place(i)), piece.tape);
            piece.answered = i + 1;
        }
    } catch (const Error &) {
        piece.failure = std::current_exception();
        std::size_t first = first_failed_.load(std::memory_order_relaxed);
        while (piece.answered < first &&
               !first_failed_.compare_exchange_weak(first, piece.answered)) {
        }
    }
    piece.is_ready.store(true, std::memory_order_release);
}

template <int D> void PlacesTogether<D>::tell_some() {
    if (!has_to_tell()) return;
    Piece &piece = pieces_[first_];
    if (!player_) player_.emplace(piece.tape);
    for (std::size_t n = 0; n < told_at_once && piece.told < piece.answered; ++n, ++piece.told)
        question_.tell(record_id(place(piece.told)), *player_);
    if (piece.told < piece.answered) return;
    player_.reset();
    if (piece.failure) std::rethrow_exception(piece.failure);
    if (piece.answered == piece.end) {
        ++first_;
    } else {
        piece.tape.clear();
        piece.is_ready.store(false, std::memory_order_relaxed);
    }
}

template <int D> void PlacesTogether<D>::report_progress() {
    const auto now = std::chrono::steady_clock::now();
    if (now - reported_ < std::chrono::milliseconds(10)) return;
    reported_ = now;
    const std::size_t told = first_ < cut_ ? pieces_[first_].told : held_back();
    host_.progress({ABACUS_PHASE_LOCATING, done_ + told, total_,
                    pages_read_ + crew_.desk().pages_read(), 0, crew_.desk().at_work()});
}

template class PlacesTogether<2>;
template class PlacesTogether<3>;

} // namespace abacus
