#include "host/crew.hpp"

#include <algorithm>
#include <cfenv>
#include <csignal>
#include <limits>
#include <system_error>

namespace abacus {

namespace {

/// How long the session's thread waits at a desk while another one has threads, too.
constexpr std::chrono::microseconds soon{100};

/// Blocks all signals: new threads inherit the mask.
class SignalsBlocked {
public:
    SignalsBlocked() noexcept {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &found_);
    }
    SignalsBlocked(const SignalsBlocked &) = delete;
    SignalsBlocked &operator=(const SignalsBlocked &) = delete;
    ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &found_, nullptr); }

private:
    sigset_t found_;
};

} // namespace

Crew *Crew::first_ = nullptr;

Crew::Crew(const Host &host)
    : host_(host), host_memory_(host), desk_(host), couriers_(&host_memory_),
      threads_(&host_memory_) {
    // Threads, like the session, decide themselves how much memory they use: caches have budgets.
    const std::size_t any = std::numeric_limits<std::size_t>::max() / 2;
    memory_.reserve(host.most_thread_bytes() != 0 ? host.most_thread_bytes() : any);
}

Crew::~Crew() { stop(); }

void Crew::stop() noexcept {
    desk_.close();
    if (work_ != nullptr) work_->give_up();
    for (std::thread &thread : threads_) thread.join();
    threads_.clear();
    work_ = nullptr;
    for (Crew **at = &first_; *at != nullptr; at = &(*at)->next_)
        if (*at == this) {
            *at = next_;
            return;
        }
}

void Crew::stop_all() noexcept {
    while (first_ != nullptr) first_->stop();
}

bool Crew::begin(unsigned threads, std::size_t pieces, Work &work) {
    threads = static_cast<unsigned>(std::min<std::size_t>(threads, pieces));
    pieces_ = pieces;
    next_piece_ = 0;
    has_failure_.clear();
    failure_ = nullptr;
    while (couriers_.size() < threads) couriers_.emplace_back(desk_, memory_.memory());
    threads_.reserve(threads);
    desk_.open(threads);
    work_ = &work;
    next_ = first_;
    first_ = this;
    try {
        start(threads);
    } catch (...) {
        stop();
        throw;
    }
    if (threads_.empty()) stop();
    return has_begun();
}

bool Crew::serve() {
    try {
        return desk_.serve(host_, false);
    } catch (...) {
        stop();
        throw;
    }
}

/// While this crew's threads sort, say, those of another one insert points.
bool Crew::serve_others() {
    bool any = false;
    for (Crew *crew = first_; crew != nullptr; crew = crew->next_)
        any |= crew != this && crew->host_.is_same(host_) && crew->desk_.serve(crew->host_, soon);
    return any;
}

void Crew::finish() {
    try {
        bool others = serve_others();
        while (desk_.serve(host_, !work_->is_busy() && !others)) {
            work_->meanwhile();
            others = serve_others();
        }
    } catch (...) {
        stop();
        throw;
    }
    stop();
    if (failure_) std::rethrow_exception(failure_);
}

bool Crew::run(unsigned threads, std::size_t pieces, Work &work) {
    if (!begin(threads, pieces, work)) return false;
    finish();
    return true;
}

void Crew::start(unsigned threads) {
    const SignalsBlocked blocked;
    auto courier = couriers_.begin();
    for (; threads > 0; --threads, ++courier) {
        try {
            threads_.emplace_back([this, courier] { thread(*courier); });
        } catch (const std::system_error &) { // the running threads do all the work
            for (; threads > 0; --threads) desk_.leave();
            return;
        }
    }
}

void Crew::thread(Courier &courier) noexcept {
    std::fesetround(FE_TONEAREST);
    try {
        for (std::size_t n; (n = next_piece_++) < pieces_; desk_.ring())
            work_->piece(n, courier.host());
    } catch (...) {
        keep_failure();
        desk_.close();
        work_->give_up();
    }
    desk_.leave();
}

void Crew::keep_failure() noexcept {
    if (!has_failure_.test_and_set()) failure_ = std::current_exception();
}

} // namespace abacus
