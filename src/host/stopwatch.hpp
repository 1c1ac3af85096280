#pragma once

#include <chrono>
#include <cstdint>

namespace abacus {

/// Adds the time of its scope, in nanoseconds, to a counter.
class Stopwatch {
public:
    explicit Stopwatch(std::uint64_t &total) : total_(total) {}
    Stopwatch(const Stopwatch &) = delete;
    Stopwatch &operator=(const Stopwatch &) = delete;
    ~Stopwatch() {
        total_ +=
            std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin_).count();
    }

private:
    using Clock = std::chrono::steady_clock;

    std::uint64_t &total_;
    Clock::time_point begin_ = Clock::now();
};

} // namespace abacus
