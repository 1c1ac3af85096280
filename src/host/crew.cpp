#include "host/crew.hpp"

#include <algorithm>
#include <cfenv>
#include <csignal>
#include <limits>
#include <system_error>

namespace abacus {

namespace {

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

Crew *Crew::at_work_ = nullptr;

Crew::Crew(const Host &host)
    : host_(host), host_memory_(host), couriers_(&host_memory_), threads_(&host_memory_) {
    // Threads, like the session, decide themselves how much memory they use: caches have budgets.
    const std::size_t any = std::numeric_limits<std::size_t>::max() / 2;
    memory_.reserve(host.most_thread_bytes() != 0 ? host.most_thread_bytes() : any);
}

Crew::~Crew() { stop(); }

void Crew::stop() noexcept {
    desk_.close();
    for (std::thread &thread : threads_) thread.join();
    threads_.clear();
    if (at_work_ == this) at_work_ = nullptr;
}

void Crew::stop_all() noexcept {
    if (at_work_ != nullptr) at_work_->stop();
}

bool Crew::run(unsigned threads, std::size_t pieces, Work &work) {
    threads = static_cast<unsigned>(std::min<std::size_t>(threads, pieces));
    work_ = &work;
    pieces_ = pieces;
    next_piece_ = 0;
    has_failure_.clear();
    failure_ = nullptr;
    while (couriers_.size() < threads) couriers_.emplace_back(desk_, memory_.memory());
    threads_.reserve(threads);
    desk_.open(threads);
    at_work_ = this;
    try {
        start(threads);
        if (threads_.empty()) {
            stop();
            return false;
        }
        while (desk_.serve(host_, !work.is_busy())) work.meanwhile();
    } catch (...) {
        stop();
        throw;
    }
    stop();
    if (failure_) std::rethrow_exception(failure_);
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
    }
    desk_.leave();
}

void Crew::keep_failure() noexcept {
    if (!has_failure_.test_and_set()) failure_ = std::current_exception();
}

} // namespace abacus
