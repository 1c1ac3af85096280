// The visible facets: those of which only one simplex is in the cache
// (dissertation §4.4.4). An entry holds the key of the simplex beyond, under
// which its page is found, and is itself found in two ways: by the number in the
// absent link of the cached simplex (a miss), and by the facet's vertices (a page
// that comes in looks for its neighbours).
#pragma once

#include "host/arena.hpp"
#include "host/free_numbers.hpp"
#include "host/hash_slots.hpp"
#include "keys/key.hpp"
#include "mesh/simplex.hpp"

namespace abacus {

template <int D> class VisibleFacets {
public:
    using Vertices = FacetVertices<D, VertexIndex>;

    struct Entry {
        Key beyond; // key of the simplex that is not in the cache
        Link owner; // the facet of the simplex that is; `unset` of a free entry
        std::uint32_t hash;
    };

    explicit VisibleFacets(const Host &host) : entries_(host), free_(host), slots_(host) {}

    Entry &operator[](std::uint32_t number) { return entries_[number]; }
    const Entry &operator[](std::uint32_t number) const { return entries_[number]; }
    bool has(std::uint32_t number) const {
        return number < entries_.size() && entries_[number].owner != unset;
    }
    std::size_t count() const { return count_; }
    std::size_t bytes() const { return count_ * (sizeof(Entry) + 2 * Slots::slot_bytes); }

    static std::uint32_t hash(const Vertices &facet) {
        std::uint64_t h = 0;
        for (const VertexIndex v : facet.vertex) {
            h = (h ^ to_number(v)) * 0x9e3779b97f4a7c15ull;
            h ^= h >> 29;
        }
        return static_cast<std::uint32_t>(h >> 16);
    }

    /// Adds an entry for a facet with this hash, and returns its number.
    std::uint32_t add(std::uint32_t hash, const Key &beyond, Link owner) {
        std::uint32_t number;
        if (!free_.empty()) {
            number = free_.take();
        } else {
            number = static_cast<std::uint32_t>(entries_.size());
            entries_.resize(number + 1);
        }
        entries_[number] = {beyond, owner, hash};
        slots_.add(hash, number);
        ++count_;
        return number;
    }

    void remove(std::uint32_t number) {
        Entry &entry = entries_[number];
        slots_.remove(entry.hash, number);
        entry.owner = unset;
        free_.add(number);
        --count_;
    }

    /// Number of the entry with this hash for which same(owner link) holds, or `none`.
    template <class Same> std::uint32_t find(std::uint32_t hash, Same same) const {
        return slots_.find(hash,
                           [&](std::uint32_t number) { return same(entries_[number].owner); });
    }
    /// The first entry with this hash, which is nearly always the one that find() finds.
    std::uint32_t guess(std::uint32_t hash) const { return slots_.first(hash); }

    /// What find() and add(), and remove(), will read.
    void prefetch(std::uint32_t hash) const { slots_.prefetch(hash); }
    void prefetch_entry(std::uint32_t number) const { __builtin_prefetch(&entries_[number], 1); }

    static constexpr std::uint32_t none = 0xffffffffu;

private:
    using Slots = HashSlots<none>;

    Arena<Entry> entries_;
    FreeNumbers free_; // apart, so that an entry is taken without reading it
    Slots slots_;      // of the entries
    std::size_t count_ = 0;
};

} // namespace abacus
