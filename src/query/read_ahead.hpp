// Asks for memory ahead of places that come along the curve, in a mesh in memory.
//
// Where few places lie in a block, each step of a walk would wait for a simplex and a vertex. But
// the blocks to come are known, and a block is a stretch of memory, as the vertices are that came
// with its page. So the second place in a block asks for the simplices of the next one on the
// curve, the fourth for its vertices, and nobody waits: they are there when the places have got so
// far. If nobody has asked for those of the block at hand before, the same places do.
#pragma once

#include "cache/cache.hpp"

namespace abacus {

template <int D> class ReadAhead {
public:
    explicit ReadAhead(const Cache<D> &cache) : cache_(cache) {}

    /// Another place in the block of the simplex found last.
    void follow(Handle found) {
        ++in_row_;
        if (in_row_ == 2) {
            const BlockIndex here = block_of<D>(found);
            is_new_ = here != next_;
            next_ = cache_.next_on_curve(here);
            if (is_new_) cache_.ask_for_slots(here);
            if (next_ != no_block) cache_.ask_for_slots(next_);
        } else if (in_row_ == 4) {
            if (is_new_) cache_.ask_for_loaded_vertices(block_of<D>(found));
            if (next_ != no_block) cache_.ask_for_loaded_vertices(next_);
        }
    }
    /// A place elsewhere.
    void leave() { in_row_ = 0; }

private:
    const Cache<D> &cache_;
    unsigned in_row_ = 0;        // places in one block
    BlockIndex next_ = no_block; // that was asked for
    bool is_new_ = false;        // nobody has asked for the block at hand
};

} // namespace abacus
