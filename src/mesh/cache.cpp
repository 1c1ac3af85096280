// Keys, and where a walk starts: the parts of the mesh cache that all others use.
#include "mesh/cache.hpp"

#include "blocks/block_cache_code.hpp"

namespace abacus {

template <int D>
Cache<D>::Cache(const Host &host, const Domain<D> &domain, int attributes,
                const CacheOptions &options)
    : Blocks(host, options.budget, last_pass_room<D>(), PageCapacity(simplex_pages<D>(attributes))),
      domain_(domain), options_(options), vertices_(host, attributes, options.split_nodes),
      visible_(host), fixed_(host), inner_links_(host), writer_(host), border_(host), left_(host),
      uses_(host), values_(host), codes_(host), guesses_(host) {
    values_.resize(static_cast<std::size_t>(attributes));
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

template <int D> void Cache<D>::set_fixed(Handle h, FixedFacets<D> facets) {
    if (static_cast<std::size_t>(h) >= fixed_.size()) {
        if (!facets.any()) return;
        const std::size_t before = fixed_.size();
        fixed_.resize(slots_.size());
        std::fill(fixed_.begin() + before, fixed_.end(), FixedFacets<D>{});
    }
    fixed_[h] = facets;
}

template <int D> Handle Cache<D>::closest_of_some(BlockIndex b, const Point<D> &p) const {
    // A few samples cost less than they shorten the walk.
    constexpr std::uint32_t samples = 16;
    Handle best = no_handle;
    double best_distance = 0;
    const std::uint32_t end = blocks_[b].high_water, stride = std::max(1u, end / samples);
    for (std::uint32_t slot = 0; slot < end; slot += best == no_handle ? 1 : stride) {
        const Handle h = first_of(b) + slot;
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

template class BlockCache<Cache<2>, SimplexBlocks<2>>;
template class BlockCache<Cache<3>, SimplexBlocks<3>>;
template class Cache<2>;
template class Cache<3>;

} // namespace abacus
