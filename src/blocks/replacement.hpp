// Replacement: which blocks leave, and from how many bytes on (dissertation §4.5.2).
//
// Points come along the curve, in each round from its beginning to its end. The blocks
// ahead are all needed once more, the farthest last; those behind, only where the curve
// comes by again. Least recently used first would drop what is needed next: of two blocks
// ahead, the nearer one has not been used for longer. So the blocks behind go first, by
// their last use, except for a window of them, and then the farthest ahead.
//
// Behind the front of the last pass blocks are finished, but for those where the curve comes by
// again, mostly soon. To keep the others until the end would take new memory all the time,
// which is slower than that of blocks that have left; and a page is made sooner while its block is
// still in the processor's cache. What there was before the pass lies ahead, and is all needed. A
// pass over a stored mesh finds nothing: there what is ahead has been loaded since, by points
// whose cavities reach it, and takes from the same room. So that has to be larger.
#pragma once

#include "blocks/block.hpp"
#include "host/arena.hpp"

#include <cstddef>
#include <cstdint>

namespace abacus {

class Replacement {
public:
    /// What the last pass is given for itself, in bytes: after others, and where there was nothing
    /// before it.
    struct LastPassRoom {
        std::size_t after_others, alone;
    };

    /// `budget`: bytes that the cache may take.
    Replacement(const Host &host, std::size_t budget, const LastPassRoom &last_pass_room)
        : budget_(budget), last_pass_room_(last_pass_room), limit_(budget), candidates_(host) {}

    /// Bytes beyond which blocks leave.
    std::size_t limit() const { return limit_; }
    void set_budget(std::size_t bytes) {
        budget_ = bytes;
        set_limit();
    }
    /// Whether this pass along the curve is the last.
    void expect_last_pass(bool last) {
        last_pass_ = last;
        set_limit();
    }
    /// An operation has been at this code. True if another pass has begun with it: call
    /// begin_pass() then.
    bool reached(std::uint64_t code) {
        const bool begins = code < front_;
        front_ = code;
        return begins;
    }
    /// So many bytes are in use now.
    void begin_pass(std::size_t bytes) {
        bytes_before_pass_ = bytes;
        set_limit();
    }
    /// Lists the next blocks to leave, some of those cached, of which there are more than two: a
    /// tenth, but for a bound. `clock`: the number of the operation at hand.
    void choose(const Arena<Block, BlockIndex> &blocks, std::size_t cached, std::uint64_t clock,
                Arena<BlockIndex> &victims);

private:
    enum Rank : std::uint8_t { first, second, last };
    struct Candidate {
        Rank rank;
        std::uint64_t order;
        BlockIndex block;
    };

    void set_limit();

    std::size_t budget_;
    const LastPassRoom last_pass_room_;
    std::size_t limit_;
    std::uint64_t front_ = 0;           // code of the last operation
    std::size_t bytes_before_pass_ = 0; // in use when the front began at the curve's beginning
    bool last_pass_ = false;
    Arena<Candidate> candidates_;
};

} // namespace abacus
