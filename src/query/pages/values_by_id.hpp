// Values of vertices by their ids: a step of a solution, which the host keeps.
//
// The host stores the rows of a step in the order in which they came, which is along the curve if
// ranks store their shares as they got them. So it returns the rows beside the one asked for, too.
// A table of fixed size keeps the last rows: each has one place in it, and gives way to the next
// row that belongs there. So memory does not grow with the step.
#pragma once

#include "host/arena.hpp"
#include "host/host.hpp"

#include <abacus/page_kinds.h>

#include <bit>
#include <cmath>

namespace abacus {

class ValuesById {
public:
    /// So many values of each of so many vertices, kept in about so many bytes.
    ValuesById(const Host &host, unsigned values, std::uint64_t vertices, std::size_t bytes)
        : host_(host), values_(values),
          bits_(static_cast<int>(std::bit_width(std::clamp<std::size_t>(
                    bytes / (row_bytes() + 1), 1, static_cast<std::size_t>(2 * vertices + 1)))) -
                1),
          ids_(host), is_taken_(host), rows_(host) {}

    /// The values of a vertex, valid until the next call; all NaN if the step has none.
    const double *find(std::int64_t id) {
        const std::size_t place = place_of(id);
        if (ids_.empty()) begin();
        if (!is_taken_[place] || ids_[place] != id) read(id);
        return rows_.data() + place * values_;
    }

private:
    std::size_t row_bytes() const { return sizeof(std::int64_t) + values_ * sizeof(double); }
    std::size_t place_of(std::int64_t id) const {
        // the upper bits of a product (Knuth's Fibonacci hashing) are those that are well mixed
        const std::uint64_t mixed = static_cast<std::uint64_t>(id) * 0x9e3779b97f4a7c15;
        return bits_ == 0 ? 0 : static_cast<std::size_t>(mixed >> (64 - bits_));
    }
    void begin() {
        ids_.resize(std::size_t{1} << bits_);
        is_taken_.resize(ids_.size());
        std::fill(is_taken_.begin(), is_taken_.end(), false);
        rows_.resize(ids_.size() * values_);
    }
    double *take(std::int64_t id) {
        const std::size_t place = place_of(id);
        ids_[place] = id;
        is_taken_[place] = true;
        return rows_.data() + place * values_;
    }
    void read(std::int64_t id) {
        abacus_page page{};
        if (!host_.find(ABACUS_STEP_PAGES, {static_cast<std::uint64_t>(id), 0}, page) ||
            page.size < row_bytes() || std::memcmp(page.bytes, &id, sizeof id) != 0) {
            std::fill_n(take(id), values_, NAN);
            return;
        }
        // the first is the one asked for; it is taken last, and so it stays
        for (std::size_t at = page.size / row_bytes() * row_bytes(); at > 0;) {
            at -= row_bytes();
            std::int64_t other;
            std::memcpy(&other, page.bytes + at, sizeof other);
            std::memcpy(take(other), page.bytes + at + sizeof other, values_ * sizeof(double));
        }
    }

    const Host &host_;
    const std::size_t values_; // of a vertex
    const int bits_;           // of the number of a place
    Arena<std::int64_t> ids_;
    Arena<bool> is_taken_;
    Arena<double> rows_;
};

} // namespace abacus
