// Threads that compute while the session's thread serves them.
//
// A database's session is one thread, and its functions may be called by no other. So threads
// only compute: each has a Host that puts requests for pages on a desk (desk.hpp), which the
// session's thread serves until all work is done.
//
// Invariants
//   1. No thread outlives run(), whatever ends it; nor, after begin(), finish(), stop() or the
//   crew.
//      A session that ends while threads compute calls stop_all() before anything that they use
//      goes away.
//   2. All signals are blocked in the threads: they are the session's.
//   3. The threads round to nearest, whatever the session does.
//   4. Threads use memory of memory() alone, and what the session's thread lends them for as long
//      as it runs them.
//
// An error of a thread stops the others, and run() throws it. An error of the host, or an
// interrupt, is found by the session's thread; it stops all threads and goes on to the caller
// of run().
#pragma once

#include "host/desk.hpp"
#include "host/memory_resource.hpp"
#include "host/thread_memory.hpp"

#include <atomic>
#include <cstdlib>
#include <deque>
#include <exception>
#include <list>
#include <memory_resource>
#include <optional>
#include <thread>
#include <vector>

namespace abacus {

class Crew {
public:
    /// What there is to do, in pieces that do not depend on each other.
    class Work {
    public:
        /// Does a piece, in a thread with this host.
        virtual void piece(std::size_t number, const Host &host) = 0;
        /// Called now and then in the session's thread.
        virtual void meanwhile() {}
        /// Whether meanwhile() has more to do, and is to be called soon.
        virtual bool is_busy() const { return false; }
        /// Threads that wait in piece() for anything but pages are to return; for any thread.
        virtual void give_up() noexcept {}

    protected:
        ~Work() = default;
    };

    explicit Crew(const Host &host);
    Crew(const Crew &) = delete;
    Crew &operator=(const Crew &) = delete;
    ~Crew();

    /// Does all pieces, in so many threads at most. False, and nothing is done, if the system
    /// grants no thread.
    bool run(unsigned threads, std::size_t pieces, Work &work);
    /// The same for a function that is called as Work::piece() is.
    template <class Piece> bool run_each(unsigned threads, std::size_t pieces, Piece piece) {
        class Each final : public Work {
        public:
            explicit Each(Piece &piece) : piece_(piece) {}
            void piece(std::size_t number, const Host &host) override { piece_(number, host); }

        private:
            Piece &piece_;
        };
        Each each(piece);
        return run(threads, pieces, each);
    }
    /// Starts threads that do all pieces, and returns; false, and nothing is done, if the system
    /// grants no thread. The work has to last until finish() or stop(). The session's thread may
    /// compute meanwhile; it calls serve() now and then if the threads use pages.
    bool begin(unsigned threads, std::size_t pieces, Work &work);
    /// Whether threads have begun, and not been finished or stopped.
    bool has_begun() const { return work_ != nullptr; }
    /// Serves what is asked for now. False once all threads have ended.
    bool serve();
    /// Serves until all threads have ended. Throws what the first that failed has thrown.
    void finish();
    /// Stops and joins the threads, in the middle of run() too. For the session's thread.
    void stop() noexcept;
    /// For a thread: meanwhile() is to be called soon.
    void ring() noexcept { desk_.ring(); }
    /// Stops the threads of all crews at work in this process: for a session that ends.
    static void stop_all() noexcept;

    /// Pages that threads find besides the host's, from the next begin() on.
    void hand_out(PagesInHand &pages) { desk_.hand_out(pages); }

    ThreadMemory &memory() { return memory_; }
    const Desk &desk() const { return desk_; }

private:
    void start(unsigned threads);
    /// Serves the other crews of this host that are at work; false if there are none.
    bool serve_others();
    void thread(Courier &courier) noexcept;
    void keep_failure() noexcept;

    const Host &host_;
    ThreadMemory memory_;
    HostMemory host_memory_;
    Desk desk_;
    std::pmr::list<Courier> couriers_;
    std::pmr::vector<std::thread> threads_;
    Work *work_ = nullptr;
    std::size_t pieces_ = 0;
    std::atomic<std::size_t> next_piece_ = 0;
    std::atomic_flag has_failure_; // the first one counts
    std::exception_ptr failure_;

    static Crew *first_; // of those at work; the session's thread alone reads and writes the list
    Crew *next_ = nullptr;
};

/// What each thread of a crew keeps from piece to piece. It is made in that thread, with its
/// host, and goes before the crew does.
template <class T> class OfEachThread {
public:
    OfEachThread(const Host &host, unsigned threads) : memory_(host), slots_(threads, &memory_) {}

    /// That of the thread with this host; `args` are for the first time.
    template <class... Args> T &get(const Host &host, Args &&...args) {
        for (Slot &slot : slots_) {
            const Host *owner = nullptr;
            if (!slot.owner.compare_exchange_strong(owner, &host) && owner != &host) continue;
            if (!slot.value) slot.value.emplace(host, std::forward<Args>(args)...);
            return *slot.value;
        }
        std::abort(); // there are no more threads than slots
    }
    /// Of all threads that have one; for the session's thread, between two runs.
    template <class Visit> void each(Visit visit) {
        for (Slot &slot : slots_)
            if (slot.value) visit(*slot.value);
    }

private:
    struct Slot {
        std::atomic<const Host *> owner = nullptr;
        std::optional<T> value;
    };

    HostMemory memory_;
    std::pmr::deque<Slot> slots_;
};

} // namespace abacus
