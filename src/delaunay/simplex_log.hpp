// What has come and what has gone: the simplices that changes of a mesh create and destroy, in
// memory.
//
// A simplex is identified by its corners, ids included, and its code. Insertion creates most
// simplices only to destroy them again, and does so within a short stretch of the curve. So the log
// is a hash table of net changes: what goes soon after it has come leaves nothing. When it is full,
// it is handed on as a whole. What comes and goes in different logs cancels out when all are sorted
// together (simplex_changes.hpp). Only sums count, so the order of logs does not matter.
//
// Ghosts are left out: they are not simplices of the user.
#pragma once

#include "blocks/bit_column.hpp"
#include "host/hash_slots.hpp"
#include "mesh/cache.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace abacus {

/// A finite simplex as words, in the order by which simplices are sorted. Its corners ascend by
/// their coordinates.
template <int D> struct SimplexWords {
    std::uint64_t code;
    std::array<std::array<std::uint64_t, D>, D + 1> corner; // ranks of doubles
    std::array<std::uint64_t, D + 1> id;                    // in the order of the numbers
    std::int64_t change;                                    // how often it has come, less gone

    /// What tells it from others.
    static constexpr std::size_t key = 1 + D * (D + 1) + D + 1;
    static constexpr std::size_t words = key + 1;

    bool is_same_as(const SimplexWords &other) const {
        return std::memcmp(this, &other, key * sizeof(std::uint64_t)) == 0;
    }
    Point<D> point(int i) const {
        Point<D> p;
        for (int axis = 0; axis < D; ++axis) p[axis] = from_ordered(corner[i][axis]);
        return p;
    }
    std::int64_t vertex(int i) const { return static_cast<std::int64_t>(id[i] ^ sign); }

    static constexpr std::uint64_t sign = std::uint64_t{1} << 63; // of an id: turned for sorting
};
static_assert(sizeof(SimplexWords<2>) == SimplexWords<2>::words * sizeof(std::uint64_t));
static_assert(sizeof(SimplexWords<3>) == SimplexWords<3>::words * sizeof(std::uint64_t));

/// Of a simplex that is not a ghost.
template <int D>
SimplexWords<D> words_of(const Cache<D> &cache, const Simplex<D> &s, std::uint64_t code) {
    std::array<VertexIndex, D + 1> vertex = s.vertex;
    std::sort(vertex.begin(), vertex.end(),
              [&](VertexIndex a, VertexIndex b) { return cache.point(a) < cache.point(b); });
    SimplexWords<D> result{};
    result.code = code;
    for (int i = 0; i <= D; ++i) {
        const Point<D> &p = cache.point(vertex[i]);
        for (int axis = 0; axis < D; ++axis) result.corner[i][axis] = ordered(p[axis]);
        result.id[i] = static_cast<std::uint64_t>(cache.vertices().id(vertex[i])) ^ result.sign;
    }
    return result;
}

template <int D> class SimplexLog {
public:
    /// Where a full log goes.
    class Overflow {
    public:
        /// Takes the entries; the log is empty then.
        virtual void take(SimplexLog &log) = 0;

    protected:
        ~Overflow() = default;
    };

    SimplexLog(const Memory &memory, std::size_t bytes, Overflow &overflow)
        : most_(std::clamp<std::size_t>(bytes / bytes_each, least, none)), overflow_(overflow),
          entries_(memory), hashes_(memory), slots_(memory) {}

    /// A simplex has been created, or is about to be destroyed. Its vertices are in the cache.
    void come(const Cache<D> &cache, Handle h) { note(cache, h, 1); }
    void go(const Cache<D> &cache, Handle h) { note(cache, h, -1); }
    /// The same of one whose code is that of another domain.
    void go(const Cache<D> &cache, Handle h, const Domain<D> &domain) {
        const Simplex<D> &s = cache.simplex(h);
        if (s.is_ghost()) return;
        std::uint64_t code = 0;
        for (const VertexIndex v : s.vertex) code = std::max(code, domain.code(cache.point(v)));
        add(words_of(cache, s, code), -1);
    }

    bool empty() const { return entries_.empty(); }
    const Arena<SimplexWords<D>> &entries() const { return entries_; }
    /// Forgets all entries, and leaves them to the caller.
    Arena<SimplexWords<D>> take() {
        empty_slots();
        return std::move(entries_);
    }
    void clear() {
        empty_slots();
        entries_.clear();
    }

private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// Arrays have up to a quarter more room than they need, and three in four slots may be free.
    static constexpr std::size_t bytes_each =
        (sizeof(SimplexWords<D>) + sizeof(std::uint32_t)) * 5 / 4 + 4 * HashSlots<none>::slot_bytes;
    static constexpr std::size_t least = 16;

    void note(const Cache<D> &cache, Handle h, std::int64_t change) {
        const Simplex<D> &s = cache.simplex(h);
        if (!s.is_ghost()) add(words_of(cache, s, cache.code(s)), change);
    }
    static std::uint32_t hash(const SimplexWords<D> &simplex) {
        std::array<std::uint64_t, SimplexWords<D>::key> words;
        std::memcpy(words.data(), &simplex, sizeof words);
        std::uint64_t h = 0;
        for (const std::uint64_t word : words) {
            h = (h ^ word) * 0x9e3779b97f4a7c15ull;
            h ^= h >> 32;
        }
        return static_cast<std::uint32_t>(h);
    }
    void add(const SimplexWords<D> &simplex, std::int64_t change) {
        const std::uint32_t h = hash(simplex);
        const std::uint32_t n = slots_.find(
            h, [&](std::uint32_t number) { return entries_[number].is_same_as(simplex); });
        if (n == none) {
            if (entries_.size() == most_) overflow_.take(*this);
            slots_.add(h, static_cast<std::uint32_t>(entries_.size()));
            hashes_.push_back(h);
            entries_.push_back(simplex);
            entries_.back().change = change;
        } else if ((entries_[n].change += change) == 0) {
            remove(n);
        }
    }
    void empty_slots() {
        for (std::uint32_t n = 0; n < hashes_.size(); ++n) slots_.remove(hashes_[n], n);
        hashes_.clear();
    }
    /// The last entry takes its place.
    void remove(std::uint32_t n) {
        const auto last = static_cast<std::uint32_t>(entries_.size() - 1);
        slots_.remove(hashes_[n], n);
        if (n != last) {
            slots_.remove(hashes_[last], last);
            slots_.add(hashes_[last], n);
            entries_[n] = entries_[last];
            hashes_[n] = hashes_[last];
        }
        entries_.pop_back();
        hashes_.pop_back();
    }

    const std::size_t most_;
    Overflow &overflow_;
    Arena<SimplexWords<D>> entries_;
    Arena<std::uint32_t> hashes_;
    HashSlots<none> slots_; // of the entries
};

} // namespace abacus
