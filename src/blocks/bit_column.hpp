// Columns: arrays of 64-bit words, of which a page stores only the bits in which they
// differ.
//
// A word is base + (delta << shift), and a delta takes `width` bits, one after the other.
// In a page a column has a head,
//
//   width    1 byte, 0 to 64
//   shift    1 byte; with has_base added, when there is a base that is not 0
//   base     8 bytes, if so
//
// and elsewhere its deltas, width bits each, from the least significant bit of the first byte
// on. The heads of all columns are together: where a column lies follows from those before.
//
// Words are found in place, without reading those before: one unaligned load, a shift and
// a mask. A load reads up to 7 bytes beyond the column: a page ends with 8 others.
//
// Doubles are stored by their rank among all doubles (ordered()), so that near values have
// near words, whatever they are; points of a page share sign, exponent and the first bits
// of the mantissa, and those on a grid end with zeros.
#pragma once

#include "geometry/ordered.hpp"
#include "host/processor_cache.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace abacus {

constexpr std::size_t bits_to_bytes(std::size_t bits) { return (bits + 7) / 8; }

/// Equally wide fields of bits, read in place.
class BitFields {
public:
    BitFields() = default;
    BitFields(const unsigned char *bytes, int width)
        : bytes_(bytes), width_(static_cast<unsigned>(width)),
          mask_(width == 0 ? 0 : ~0ull >> (64 - width)) {}

    std::uint64_t operator[](std::size_t i) const {
        const std::size_t bit = i * width_;
        const unsigned char *at = bytes_ + (bit >> 3);
        const unsigned offset = bit & 7;
        std::uint64_t word;
        std::memcpy(&word, at, sizeof word);
        word >>= offset;
        if (offset + width_ > 64) word |= std::uint64_t(at[8]) << (64 - offset);
        return word & mask_;
    }
    /// The same of fields of at most 57 bits: a word has all of one, wherever it begins.
    std::uint64_t narrow(std::size_t i) const { return word(i) >> (i * width_ & 7) & mask_; }
    /// All that follow in the word that begins with a field's first byte.
    std::uint64_t word(std::size_t i) const {
        std::uint64_t word;
        std::memcpy(&word, bytes_ + (i * width_ >> 3), sizeof word);
        return word;
    }
    /// The greatest bits of the fields from `begin` to `end`, as many as `bits`, at most 25.
    template <class Prefix>
    void prefixes(std::size_t begin, std::size_t end, unsigned bits, Prefix *prefix) const {
        const unsigned taken = width_ < bits ? width_ : bits;
        const std::uint32_t mask = (1u << taken) - 1;
        std::size_t bit = begin * width_ + (width_ - taken);
        for (std::size_t i = begin; i < end; ++i, bit += width_) {
            std::uint32_t word;
            std::memcpy(&word, bytes_ + (bit >> 3), sizeof word);
            *prefix++ = static_cast<Prefix>(word >> (bit & 7) & mask);
        }
    }
    /// Asks for a field, which will be read soon.
    void ask_for(std::size_t i) const { touch(bytes_ + (i * width_ >> 3)); }
    unsigned width() const { return width_; }
    /// The greatest that a field may be.
    std::uint64_t most() const { return mask_; }
    const unsigned char *begin() const { return bytes_; }

private:
    const unsigned char *bytes_ = nullptr;
    unsigned width_ = 0;
    std::uint64_t mask_ = 0;
};

class Column {
public:
    static constexpr unsigned has_base = 128;

    Column() = default;
    /// Takes a column's head off the bytes from `at` to `end`; false if that is none.
    bool read_head(const unsigned char *&at, const unsigned char *end) {
        if (end - at < 2) return false;
        const unsigned width = at[0], shift = at[1] & ~has_base;
        const bool based = (at[1] & has_base) != 0;
        if (width + shift > 64 || shift == 64 || end - at < 2 + 8 * based) return false;
        base_ = 0;
        if (based) std::memcpy(&base_, at + 2, sizeof base_);
        fields_ = {nullptr, static_cast<int>(width)};
        shift_ = shift;
        at += 2 + 8 * based;
        // What is always the same has one form.
        return (base_ != 0 || !based) && (width != 0 || shift == 0);
    }
    /// Then the deltas of n words; false if there are fewer.
    bool read_deltas(const unsigned char *&at, const unsigned char *end, std::size_t n) {
        const std::size_t size = bits_to_bytes(n * fields_.width());
        if (static_cast<std::size_t>(end - at) < size) return false;
        fields_ = {at, static_cast<int>(fields_.width())};
        at += size;
        return true;
    }

    std::uint64_t operator[](std::size_t i) const { return base_ + (fields_[i] << shift_); }

    /// The greatest bits of words, for comparisons that need not be exact: of two words one is
    /// greater if its prefix is, and either may be if these are equal.
    using Prefix = std::int16_t;
    void prefixes(std::size_t begin, std::size_t end, Prefix *prefix) const {
        fields_.prefixes(begin, end, prefix_bits, prefix);
    }
    void ask_for(std::size_t i) const { fields_.ask_for(i); }
    Prefix prefix_at(std::size_t i) const {
        Prefix prefix = 0;
        prefixes(i, i + 1, &prefix);
        return prefix;
    }
    /// That of any word, also of one that the column cannot have.
    Prefix prefix(std::uint64_t word) const {
        if (word < base_) return -1;
        const unsigned width = fields_.width();
        const std::uint64_t field = (word - base_) >> shift_;
        const std::uint64_t cut = width > prefix_bits ? field >> (width - prefix_bits) : field;
        return static_cast<Prefix>(cut >> prefix_bits == 0 ? cut : 1u << prefix_bits);
    }

    /// Whether the head lets a word be from `least` to `greatest`; true where a word is.
    bool may_have(std::uint64_t least, std::uint64_t greatest) const {
        return this->least() <= greatest && least <= most();
    }
    /// As far as the head shows, no word is less than this, ...
    std::uint64_t least() const { return wraps() ? 0 : base_; }
    /// ... or greater than this.
    std::uint64_t most() const { return wraps() ? ~std::uint64_t{0} : base_ + span(); }

    /// Whether not all words are 0.
    bool is_not_zero() const { return base_ != 0 || fields_.width() != 0; }

    static constexpr unsigned prefix_bits = 14;

private:
    std::uint64_t span() const { return fields_.most() << shift_; }
    /// Whether the head lets words exceed 64 bits: then any word may be there.
    bool wraps() const { return base_ + span() < base_; }

    BitFields fields_;
    std::uint64_t base_ = 0;
    unsigned shift_ = 0;
};

/// Whether the head of a column of ranks lets a double be in a range; true where one is.
inline bool column_may_have(const Column &column, double least, double greatest) {
    // -0 and 0 have different ranks.
    return column.may_have(ordered(least == 0 ? -0.0 : least),
                           ordered(greatest == 0 ? 0.0 : greatest));
}

/// Puts bits one after the other into bytes. Writes up to 8 bytes beyond them.
class BitWriter {
public:
    explicit BitWriter(unsigned char *at) : at_(at) {}

    /// `value` has no bits beyond `width`, 0 to 64.
    void put(std::uint64_t value, unsigned width) {
        if (width > 56) {
            put_short(value & 0xffffffffu, 32);
            put_short(value >> 32, width - 32);
        } else {
            put_short(value, width);
        }
    }
    /// Fills up the last byte; returns the end.
    unsigned char *close() const {
        std::memcpy(at_, &word_, sizeof word_);
        return at_ + (fill_ != 0);
    }

private:
    void put_short(std::uint64_t value, unsigned width) {
        word_ |= value << fill_;
        std::memcpy(at_, &word_, sizeof word_);
        fill_ += width;
        at_ += fill_ >> 3;
        word_ >>= fill_ & ~7u;
        fill_ &= 7;
    }

    unsigned char *at_;
    std::uint64_t word_ = 0; // begun bytes
    unsigned fill_ = 0;      // bits of them, below 8
};

/// How an array of words is stored.
class ColumnPlan {
public:
    ColumnPlan() = default;
    ColumnPlan(const std::uint64_t *words, std::size_t n) : count_(n) {
        std::uint64_t least = n > 0 ? words[0] : 0, any = 0, deltas = 0;
        for (std::size_t i = 0; i < n; ++i) {
            least = words[i] < least ? words[i] : least;
            any |= words[i];
        }
        for (std::size_t i = 0; i < n; ++i) deltas |= words[i] - least;
        fit(deltas);
        base_ = least;
        // A base costs 8 bytes, and may not be worth them.
        ColumnPlan plain;
        plain.count_ = n;
        plain.fit(any);
        if (plain.size() <= size()) *this = plain;
    }

    /// Of head and deltas.
    std::size_t size() const { return 2 + (base_ != 0 ? 8 : 0) + bits_to_bytes(count_ * width_); }
    /// What Column::prefix() will be of one of these words.
    Column::Prefix prefix(std::uint64_t word) const {
        const unsigned cut = width_ > Column::prefix_bits ? width_ - Column::prefix_bits : 0;
        return static_cast<Column::Prefix>((word - base_) >> shift_ >> cut);
    }

    /// Each returns the end of what it has written.
    unsigned char *write_head(unsigned char *at) const {
        *at++ = static_cast<unsigned char>(width_);
        *at++ = static_cast<unsigned char>(shift_ | (base_ != 0 ? Column::has_base : 0));
        if (base_ != 0) {
            std::memcpy(at, &base_, sizeof base_);
            at += sizeof base_;
        }
        return at;
    }
    /// Of the same words.
    unsigned char *write_deltas(const std::uint64_t *words, unsigned char *at) const {
        if (width_ == 0) return at;
        const ColumnPlan plan = *this; // in registers: what is written may be anywhere
        BitWriter bits(at);
        for (std::size_t i = 0; i < plan.count_; ++i)
            bits.put((words[i] - plan.base_) >> plan.shift_, plan.width_);
        return bits.close();
    }

private:
    void fit(std::uint64_t deltas) {
        shift_ = deltas == 0 ? 0 : static_cast<unsigned>(std::countr_zero(deltas));
        width_ = static_cast<unsigned>(std::bit_width(deltas >> shift_));
    }

    std::uint64_t base_ = 0;
    std::size_t count_ = 0;
    unsigned width_ = 0, shift_ = 0;
};

} // namespace abacus
