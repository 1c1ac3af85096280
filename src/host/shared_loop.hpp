// Loops whose pieces several threads share. The session's thread waits for them, and serves
// interrupts meanwhile.
#pragma once

#include "host/crew.hpp"

#include <optional>

namespace abacus {

class SharedLoop {
public:
    explicit SharedLoop(const Host &host) : host_(host) {}

    /// Calls piece(i, host) for all i < n, each in some thread, with its host; here if the system
    /// grants no thread.
    template <class Piece> void each(std::size_t n, Piece piece) {
        if (!crew_) crew_.emplace(host_);
        if (crew_->run_each(host_.threads(), n, piece)) return;
        for (std::size_t i = 0; i < n; ++i) piece(i, host_);
    }
    /// Cuts [0, n) in stretches() and calls piece(number, begin, end, host) for each.
    template <class Piece> void each_stretch(std::size_t n, Piece piece) {
        each(stretches(), [&](std::size_t i, const Host &host) {
            piece(i, n * i / stretches(), n * (i + 1) / stretches(), host);
        });
    }
    std::size_t stretches() const { return host_.threads(); }

protected:
    const Host &host_;

private:
    std::optional<Crew> crew_; // from the first use on
};

} // namespace abacus
