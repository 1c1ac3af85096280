// The visible facets: those of which only one simplex is in the cache
// (dissertation §4.4.4). An entry holds the key of the simplex beyond, under
// which its page is found, and is itself found in two ways: by the number in the
// absent link of the cached simplex (a miss), and by the facet's vertices (a page
// that comes in looks for its neighbours).
#pragma once

#include "cache/key.hpp"
#include "host/arena.hpp"
#include "mesh/simplex.hpp"

namespace abacus {

template <int D> class VisibleFacets {
public:
    using Vertices = FacetVertices<D, VertexIndex>;

    struct Entry {
        Key beyond;          // key of the simplex that is not in the cache
        Link owner;          // the facet of the simplex that is
        std::uint32_t hash;
        std::uint32_t next;  // in the chain of its bucket, or of free entries
    };

    explicit VisibleFacets(const Host &host) : entries_(host), buckets_(host) { rehash(1024); }

    Entry &operator[](std::uint32_t number) { return entries_[number]; }
    const Entry &operator[](std::uint32_t number) const { return entries_[number]; }
    std::size_t count() const { return count_; }
    std::size_t bytes() const { return count_ * sizeof(Entry); }

    static std::uint32_t hash(const Vertices &facet) {
        std::uint64_t h = 0;
        for (const VertexIndex v : facet.vertex) {
            h = (h ^ v) * 0x9e3779b97f4a7c15ull;
            h ^= h >> 29;
        }
        return static_cast<std::uint32_t>(h >> 16);
    }

    std::uint32_t add(const Vertices &facet, const Key &beyond, Link owner) {
        std::uint32_t number = free_;
        if (number != none) {
            free_ = entries_[number].next;
        } else {
            number = static_cast<std::uint32_t>(entries_.size());
            entries_.resize(number + 1);
        }
        const std::uint32_t h = hash(facet);
        entries_[number] = {beyond, owner, h, buckets_[h & mask_]};
        buckets_[h & mask_] = number;
        if (++count_ > buckets_.size()) rehash(2 * buckets_.size());
        return number;
    }

    void remove(std::uint32_t number) {
        std::uint32_t *at = &buckets_[entries_[number].hash & mask_];
        while (*at != number) at = &entries_[*at].next;
        *at = entries_[number].next;
        entries_[number].owner = free_owner;
        entries_[number].next = free_;
        free_ = number;
        --count_;
    }

    /// Number of the entry for which same(owner link) holds, or `none`.
    template <class Same> std::uint32_t find(const Vertices &facet, Same same) const {
        const std::uint32_t h = hash(facet);
        std::uint32_t number = buckets_[h & mask_];
        while (number != none && !(entries_[number].hash == h && same(entries_[number].owner)))
            number = entries_[number].next;
        return number;
    }

    /// Two steps of find() or add() in advance, for many facets at once.
    void prefetch_bucket(const Vertices &facet) const {
        __builtin_prefetch(&buckets_[hash(facet) & mask_]);
    }
    void prefetch_entry(const Vertices &facet) const {
        const std::uint32_t number = buckets_[hash(facet) & mask_];
        if (number != none) __builtin_prefetch(&entries_[number]);
    }

    static constexpr std::uint32_t none = 0xffffffffu;

private:
    static constexpr Link free_owner = 0xffffffffu;

    void rehash(std::size_t size) {
        buckets_.resize(size);
        std::fill(buckets_.begin(), buckets_.end(), none);
        mask_ = static_cast<std::uint32_t>(size - 1);
        for (std::uint32_t number = 0; number < entries_.size(); ++number) {
            Entry &entry = entries_[number];
            if (entry.owner == free_owner) continue;
            entry.next = buckets_[entry.hash & mask_];
            buckets_[entry.hash & mask_] = number;
        }
    }

    Arena<Entry> entries_;
    Arena<std::uint32_t> buckets_;
    std::uint32_t mask_ = 0;
    std::uint32_t free_ = none;
    std::size_t count_ = 0;
};

} // namespace abacus
