// Blocks, slots, keys: the parts of the cache that all others use.
#include "mesh/cache.hpp"

namespace abacus {

namespace {
// In the plane more room gains nothing over a stored mesh.
constexpr Replacement::LastPassRoom last_pass_room(int dimension) {
    constexpr std::size_t mb = std::size_t{1} << 20;
    if (dimension == 2) return {.after_others = 16 * mb, .alone = 16 * mb};
    return {.after_others = 48 * mb, .alone = 96 * mb};
}
} // namespace

template <int D>
Cache<D>::Cache(const Host &host, const Domain<D> &domain, int attributes,
                const CacheOptions &options)
    : host_(host), domain_(domain), options_(options), capacity_(attributes), blocks_(host),
      slots_(host), vertices_(host, attributes), visible_(host), directory_(host),
      unused_blocks_(host), overfull_(host), limbo_(host), places_(host),
      replacement_(host, options.budget, last_pass_room(D)), inner_links_(host), writer_(host),
      numbered_(host), on_border_(host), uses_(host), left_(host), border_(host), values_(host),
      codes_(host), hashes_(host), guesses_(host) {
    values_.resize(static_cast<std::size_t>(attributes));
}

template <int D> Handle Cache<D>::follow(Handle h) const {
    // A simplex moves from limbo, or with a part of its block, once or twice.
    for (int i = 0; i < 4 && h < slots_.size(); ++i) {
        if (is_live(h)) return h;
        if (!slots_[h].is_free()) break;
        h = slots_[h].link[1];
    }
    return no_handle;
}

template <int D> std::uint64_t Cache<D>::part(const Simplex<D> &s) const {
    std::array<const Point<D> *, D + 1> corners;
    std::array<std::uint64_t, D + 1> codes;
    const int n = s.finite_vertices();
    for (int i = 0; i < n; ++i) {
        const Vertex<D> &v = vertices_[s.vertex[i]];
        corners[i] = &v.point;
        codes[i] = v.code;
    }
    return Domain<D>::part(corners, codes, n);
}

template <int D> BlockIndex Cache<D>::new_block(Block::State state) {
    BlockIndex b;
    if (!unused_blocks_.empty()) {
        b = unused_blocks_.back();
        unused_blocks_.pop_back();
    } else {
        b = static_cast<BlockIndex>(blocks_.size());
        // A link has 29 bits for the handle.
        if ((std::uint64_t(b) + 1) * block_slots<D> >= (1u << 29))
            throw Error(ABACUS_ERROR_LIMIT, "the computational cache has too many blocks", {},
                        "Lower abacus.cache_size.");
        blocks_.resize(b + 1);
        slots_.resize((std::size_t(b) + 1) * block_slots<D>);
    }
    Block &block = blocks_[b];
    block = Block{};
    block.capacity = capacity_.usual();
    block.free = no_slot;
    block.state = state;
    block.used_at = clock_;
    ++cached_blocks_;
    return b;
}

template <int D> void Cache<D>::free_block(BlockIndex b) {
    blocks_[b].state = Block::unused;
    unused_blocks_.push_back(b);
    --cached_blocks_;
    for (BlockIndex &near : at_hand_)
        if (near == b) near = no_block;
}

template <int D> void Cache<D>::create_first_block() {
    const BlockIndex b = new_block(Block::cached);
    blocks_[b].own(first_key, end_key);
    blocks_[b].dirty = true;
    directory_.insert(first_key, b);
}

template <int D> BlockIndex Cache<D>::cached_owner(const Key &key) const {
    const BlockIndex b = directory_.floor(key);
    return b != no_block && blocks_[b].owns(key) ? b : no_block;
}

template <int D> BlockIndex Cache<D>::place_elsewhere(std::uint64_t code) {
    // A star at the border of two blocks has simplices now in one, now in the other.
    std::swap(at_hand_[0], at_hand_[1]);
    if (at_hand_[0] == no_block || !blocks_[at_hand_[0]].surely_owns(code)) {
        const BlockIndex b = cached_owner({code, 0});
        at_hand_[0] = b != no_block && blocks_[b].surely_owns(code) ? b : no_block;
    }
    if (at_hand_[0] != no_block && has_slot(at_hand_[0])) return at_hand_[0];
    if (limbo_.empty() || !has_slot(limbo_.back())) limbo_.push_back(new_block(Block::limbo));
    return limbo_.back();
}

template <int D> Handle Cache<D>::closest_of_some(BlockIndex b, const Point<D> &p) const {
    // A few samples: the walk is shorter by more than they cost.
    constexpr std::uint32_t samples = 16;
    Handle best = no_handle;
    double best_distance = 0;
    const std::uint32_t end = blocks_[b].high_water, stride = std::max(1u, end / samples);
    for (std::uint32_t slot = 0; slot < end; slot += best == no_handle ? 1 : stride) {
        const Handle h = b * block_slots<D> + slot;
        if (slots_[h].is_free()) continue;
        double distance = 0;
        for (int i = 0; i < D; ++i) {
            const double d = point(slots_[h].vertex[0])[i] - p[i];
            distance += d * d;
        }
        if (best == no_handle || distance < best_distance) {
            best = h;
            best_distance = distance;
        }
    }
    return best;
}

// Both are stretches of memory, where prefetch instructions do.

template <int D> void Cache<D>::ask_for_slots(BlockIndex b) const {
    prefetch(&slots_[b * block_slots<D>], blocks_[b].high_water);
}

template <int D> void Cache<D>::ask_for_loaded_vertices(BlockIndex b) const {
    prefetch(&vertices_[blocks_[b].first_vertex], blocks_[b].vertex_run);
}

template <int D> Handle Cache<D>::start(std::uint64_t code, const Point<D> &p) {
    // A page can be empty, the first one above all, when the domain reaches beyond the
    // points. Then any other simplex is as good: of the nearest block before it on the
    // curve, or else after it.
    const auto place = [&](Key key) -> Block & { // a copy: it may be in a block
        const BlockIndex b = owner(key);
        if (b == no_block) throw_corrupted("No page owns a part of the curve.");
        return blocks_[b];
    };
    const Key key{code, 0};
    const Block *block = &place(key);
    const Key upper = block->upper;
    while (block->count == 0 && !(block->lower == first_key))
        block = &place(predecessor(block->lower));
    if (block->count == 0) block = &place(upper == end_key ? key : upper);
    while (block->count == 0 && !(block->upper == end_key)) block = &place(block->upper);
    if (block->count == 0) return no_handle;
    return closest_of_some(static_cast<BlockIndex>(block - blocks_.data()), p);
}

template class Cache<2>;
template class Cache<3>;

} // namespace abacus
