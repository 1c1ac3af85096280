// What is wrong with a triangulation that is loaded. Who mends one wants to see more than the
// first fault: a step goes on to its end, and then its faults are told together. What would follow
// from them is left to the next call.
#pragma once

#include "host/host.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace abacus {

class Faults {
public:
    static constexpr std::size_t most = 100; // that are listed

    /// What has been listed already is not a fault of its own.
    void add(const std::string &message, const std::string &detail, const std::string &hint);
    bool has(const std::string &message) const;
    /// So many further ones, which are not named.
    void add_unnamed(std::uint64_t count) { count_ += count; }
    /// As many are listed as will be. Who stops then says so.
    bool is_full() const { return messages_.size() == most; }
    void stop() { is_whole_ = false; }

    /// Throws an Error (argument) if there are any.
    void raise() const;

private:
    std::string list() const;

    std::vector<std::string> messages_;
    std::string first_detail_;
    std::vector<std::string> hints_; // different ones
    std::uint64_t count_ = 0;
    bool is_whole_ = true;
};

} // namespace abacus
