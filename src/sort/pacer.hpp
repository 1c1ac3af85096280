// Serves interrupts and reports progress from inside long loops.
#pragma once

#include "host/host.hpp"

#include <algorithm>
#include <chrono>

namespace abacus {

/// Pages read from and written to the database.
struct PagesMoved {
    std::uint64_t read = 0, written = 0;
};

class Pacer {
public:
    /// Records after which it is time for poll() or reached().
    static constexpr std::size_t stride = 4096;

    explicit Pacer(const Host &host) : host_(host) {}

    /// Begins a phase of `total` records; 0 = not known.
    void begin(abacus_phase phase, std::uint64_t total) {
        progress_.phase = phase;
        progress_.done = 0;
        progress_.total = total;
        report(Clock::now());
    }

    /// `done` records of the phase are done.
    void reached(std::uint64_t done, const PagesMoved &pages = {}) {
        set(done, pages);
        const auto now = Clock::now();
        if (now - last_ >= std::chrono::milliseconds(10)) report(now);
        host_.poll();
    }
    /// The phase ends with `done` records.
    void end(std::uint64_t done, const PagesMoved &pages) {
        set(done, pages);
        report(Clock::now());
    }
    void poll() const { host_.poll(); }

    /// Calls body(begin, end) for consecutive pieces of [0, n) and polls between them.
    template <class Body> void each_piece(std::size_t n, Body &&body) const {
        for (std::size_t begin = 0; begin < n;) {
            const std::size_t end = begin + std::min(n - begin, stride);
            body(begin, end);
            host_.poll();
            begin = end;
        }
    }

private:
    using Clock = std::chrono::steady_clock;

    void set(std::uint64_t done, const PagesMoved &pages) {
        progress_.done = done;
        progress_.pages_read = pages.read;
        progress_.pages_written = pages.written;
    }
    void report(Clock::time_point now) {
        last_ = now;
        host_.progress(progress_);
    }

    const Host &host_;
    abacus_progress progress_{};
    Clock::time_point last_{};
};

} // namespace abacus
