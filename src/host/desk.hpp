// Where threads leave requests for pages, and the session's thread serves them.
//
// Only the session's thread may call the host. Each other thread has a Courier: a host of its
// own, whose functions put a request into a queue. A page that is stored or erased is copied
// there, and the thread goes on at once; it waits only for a page that it asks for, or for a place
// in its queue. The session's thread takes the requests in their order, so a thread finds what it
// has stored.
//
// Where a page is stored is known only once it is. So the thread gets a ticket for its place, and
// whenever it names the place again the session's thread looks it up. A ticket is good until the
// desk is opened the next time: nothing that lasts longer may keep one.
//
// Invariants
//   1. A request belongs to its thread until it is counted as asked, then to the session's thread
//      until it is counted as served. The counts change under the lock, the requests outside.
//   2. The lock is never held while the host is called or anything is computed.
//   3. Once the desk is closed, every request fails, and no thread waits.
#pragma once

#include "host/arena.hpp"
#include "host/pages_in_hand.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace abacus {

class Courier;

class Desk {
public:
    explicit Desk(const Memory &memory) : none_in_hand_(memory) {}
    Desk(const Desk &) = delete;
    Desk &operator=(const Desk &) = delete;

    /// For the session's thread, while no other uses the desk: so many threads begin to work. What
    /// was left of earlier work is forgotten.
    void open(unsigned threads);
    /// Threads find these pages, too, and store them. They have to be there while threads work.
    void hand_out(PagesInHand &pages) { in_hand_ = &pages; }
    /// From now on all requests fail, and those who wait are woken. For any thread.
    void close() noexcept;
    /// For a thread: its work has ended.
    void leave() noexcept;
    /// For a thread: there is something to do for the session's thread besides pages.
    void ring() noexcept;

    /// For the session's thread: serves what is asked for, or waits for it or a ring so long at
    /// most, or for a moment, if it may. False once all threads have left and everything is served.
    /// Throws what the host throws.
    bool serve(const Host &host, std::chrono::microseconds wait);
    bool serve(const Host &host, bool may_wait) {
        return serve(host, may_wait ? longest_wait : std::chrono::microseconds{0});
    }

    /// Pages handed to threads and stored for them since open(); for the session's thread.
    std::uint64_t pages_read() const { return read_; }
    std::uint64_t pages_written() const { return written_; }
    /// Threads that have not left.
    unsigned at_work() const;
    /// Nanoseconds that threads have waited here since open(), of all together.
    std::uint64_t waited() const;

private:
    friend class Courier;

    /// The session's thread looks for interrupts so often when nobody asks for anything.
    static constexpr std::chrono::microseconds longest_wait{20000};

    /// Serves the courier's next request; false if there is none.
    bool serve(const Host &host, Courier &courier);

    mutable std::mutex lock_;
    Courier *first_ = nullptr; // of those that have a place here
    PagesInHand none_in_hand_;
    PagesInHand *in_hand_ = &none_in_hand_;
    std::condition_variable asked_;
    std::size_t open_requests_ = 0; // asked and not served
    unsigned at_work_ = 0;          // threads
    bool is_rung_ = false;
    bool is_urgent_ = false; // a thread waits for a page, or soon for room
    std::uint64_t read_ = 0, written_ = 0;
    std::uint64_t waited_ = 0;
    volatile int closed_ = 0; // what the threads' hosts show as an interrupt
};

class Courier {
public:
    /// For a thread that uses this memory. Made by the session's thread, for as long as the desk.
    Courier(Desk &desk, const Memory &memory);
    Courier(const Courier &) = delete;
    Courier &operator=(const Courier &) = delete;

    /// The thread's host: memory, interrupts and pages. It has no spools, and reports nothing.
    const Host &host() const { return host_; }

private:
    friend class Desk;
    struct Functions;

    enum class Wish : std::uint8_t { find, fetch, next, first, put, erase };
    struct Request {
        Wish wish;
        abacus_page_kind kind;
        abacus_page page;
        std::uint64_t ticket; // for the place of a page that is put
        abacus_host_status answer;
        alignas(8) unsigned char bytes[ABACUS_MAX_PAGE_BYTES];
    };
    static constexpr std::size_t most_requests = 16;
    /// A location with this bit is a ticket; the host's own have it not.
    static constexpr std::uint64_t ticket_bit = std::uint64_t{1} << 63;

    /// Forgets requests and tickets.
    void begin_anew();
    /// Waits until so many requests have been served, or the desk is closed.
    void wait_until_served(std::unique_lock<std::mutex> &guard, std::size_t requests);
    /// The thread's next request, once there is room; nullptr if the desk is closed.
    Request *begin(Wish wish, abacus_page_kind kind, const abacus_page &page);
    /// Hands it in. The session's thread is woken only if the thread `waits` for it, or many are
    /// there: to wake up costs more than to store a page.
    void ask(bool waits);
    /// Hands it in, and waits for the page.
    abacus_host_status look(Request *request, abacus_page &page);
    std::uint64_t new_ticket();
    /// Where that is for the host.
    std::uint64_t place(std::uint64_t location) const;

    Desk &desk_;
    Courier *const next_; // of the desk's
    const Memory memory_;
    abacus_host table_{};
    Host host_;
    Arena<Request> requests_;     // a ring
    Arena<std::uint64_t> places_; // by ticket
    std::size_t asked_ = 0, served_ = 0;
    std::size_t awaited_ = 0; // how many are to be served before the thread is woken
    std::condition_variable answered_;
};

} // namespace abacus
