// What tells points at one place apart: the id, or id and attributes.
//
// A mesh that follows a table needs the latter. Rows may agree in id and place, and a change
// of an attribute that the mesh has missed must be noticed. So a point only counts as the
// wanted one if id and attributes agree; otherwise the wanted point is missing.
//
// Points are compared by numbers. Without attributes these are the ids themselves; with
// attributes, the numbers under which the wanted identities have been entered here.
// Attributes agree as in SQL: 0 equals -0, and a NaN equals every other NaN.
#pragma once

#include "host/arena.hpp"
#include "host/hash_slots.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace abacus {

class Identities {
public:
    static constexpr std::int64_t unknown = -1;

    /// `attributes`: how many of them count; with none there is no table.
    Identities(const Host &host, unsigned attributes)
        : attributes_(attributes), stride_(1 + std::size_t(attributes)), words_(host),
          hashes_(host), slots_(host, attributes > 0 ? HashSlots<none>::few : 0) {}

    bool has_attributes() const { return attributes_ > 0; }
    /// The number of a point that is wanted.
    std::int64_t enter(std::int64_t id, const double *attributes) {
        const std::int64_t known = find(id, attributes);
        if (attributes_ == 0 || known != unknown) return known;
        const std::uint32_t hash = append(id, attributes), number = count();
        hashes_.push_back(hash);
        slots_.add(hash, number);
        return number;
    }
    /// The number of a point; `unknown` if none like it has been entered.
    std::int64_t find(std::int64_t id, const double *attributes) {
        if (attributes_ == 0) return id;
        const std::uint32_t hash = append(id, attributes);
        const std::uint64_t *const words = words_.data();
        const std::uint64_t *const wanted = words + count() * stride_;
        const std::uint32_t number = slots_.find(hash, [&](std::uint32_t n) {
            return std::equal(wanted, wanted + stride_, words + n * stride_);
        });
        words_.resize(count() * stride_);
        return number == none ? unknown : number;
    }
    /// Forgets all that has been entered.
    void clear() {
        for (std::uint32_t n = 0; n < hashes_.size(); ++n) slots_.remove(hashes_[n], n);
        hashes_.clear();
        words_.clear();
    }
    /// What an entry takes.
    std::size_t bytes_each() const {
        return attributes_ == 0 ? 0
                                : stride_ * sizeof(std::uint64_t) + sizeof(std::uint32_t) +
                                      4 * HashSlots<none>::slot_bytes;
    }

private:
    static constexpr std::uint32_t none = 0xffffffffu;

    std::uint32_t count() const { return static_cast<std::uint32_t>(hashes_.size()); }
    static std::uint64_t canonical(double x) {
        if (x == 0) return 0;
        return std::isnan(x) ? ~std::uint64_t(0) : std::bit_cast<std::uint64_t>(x);
    }
    /// Puts the words of an identity behind those entered; their hash.
    std::uint32_t append(std::int64_t id, const double *attributes) {
        words_.push_back(std::bit_cast<std::uint64_t>(id));
        for (unsigned i = 0; i < attributes_; ++i) words_.push_back(canonical(attributes[i]));
        std::uint64_t hash = 0;
        for (std::size_t i = words_.size() - stride_; i < words_.size(); ++i) {
            hash = (hash ^ words_[i]) * 0x9e3779b97f4a7c15ull;
            hash ^= hash >> 32;
        }
        return static_cast<std::uint32_t>(hash);
    }

    const unsigned attributes_;
    const std::size_t stride_;
    Arena<std::uint64_t> words_; // id and attributes of each entry
    Arena<std::uint32_t> hashes_;
    HashSlots<none> slots_; // of the entries, by their words
};

} // namespace abacus
