// Prefetches memory ahead of places that come along the curve, in a mesh in memory.
//
// If few places lie in a block, each step of a walk would wait for a simplex and a vertex. But the
// next blocks are known. A block is a stretch of memory, and so are the vertices that came with its
// page. So the second place in a block prefetches the simplices of the next block on the curve, the
// fourth its vertices. They are there when the places reach them. If those of the current block
// have not been prefetched, the same places do that.
#pragma once

#include "mesh/cache.hpp"

namespace abacus {

template <int D> class ReadAhead {
public:
    explicit ReadAhead(const Cache<D> &cache) : cache_(cache) {}

    /// Another place in the block of the simplex found last.
    void follow(Handle found) {
        const BlockIndex here = Cache<D>::block_of(found);
        if (here != here_) {
            is_new_ = here != next_;
            here_ = here;
            places_ = 1;
        }
        ++places_;
        if (places_ == 2) {
            next_ = cache_.next_on_curve(here);
            if (is_new_) cache_.ask_for_slots(here);
            if (next_ != no_block) cache_.ask_for_slots(next_);
        } else if (places_ == 4) {
            if (is_new_) cache_.ask_for_loaded_vertices(here);
            if (next_ != no_block) cache_.ask_for_loaded_vertices(next_);
        }
    }

private:
    const Cache<D> &cache_;
    BlockIndex here_ = no_block; // where the places are
    BlockIndex next_ = no_block; // the block prefetched
    bool is_new_ = false;        // the current block has not been prefetched
    unsigned places_ = 0;        // in it
};

} // namespace abacus
