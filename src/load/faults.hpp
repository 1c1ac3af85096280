// What is wrong with a triangulation that is loaded. Users who mend one want to see more than the
// first fault. So a step goes on to its end, and then its faults are reported together. Faults
// that would only follow from them are left to the next call.
#pragma once

#include "host/host.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace abacus {

class Faults {
public:
    static constexpr std::size_t most = 100; // that are listed

    /// A fault that is listed already does not count again.
    void add(const std::string &message, const std::string &detail, const std::string &hint);
    bool has(const std::string &message) const;
    /// So many further ones, which are not named.
    void add_unnamed(std::uint64_t count) { count_ += count; }
    /// Whether as many are listed as ever will be. A step that stops then says so.
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
