// How many records fit into a page.
//
// A block is split by the number of its records, a page is full by its bytes. What a record
// takes depends on what the data are, but also on the place in them: where a coordinate comes
// near to 0 its numbers have many exponents, and the page next to one of 760 tetrahedra may hold
// 610. So each page that is made or loaded tells how many like its own would fill it, and a block
// keeps that as its capacity; blocks of which nothing is known get the mean of the pages of late.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace abacus {

/// What is known of pages of some type before there are any.
struct PageShape {
    double overhead;     ///< bytes of a page that are not those of its records
    double room;         ///< bytes for records in a full page
    double record_bytes; ///< of one; a guess
    /// A page's bytes grow with this power of its records: below 1 where records take more
    /// bytes on a page's border, which is the longer the fewer there are. Here its inverse,
    /// negative.
    double inverse_growth;
    std::uint32_t slots; ///< of a block
};

class PageCapacity {
public:
    explicit PageCapacity(const PageShape &shape)
        : shape_(shape), mean_(shape.room / shape.record_bytes) {}

    /// Records that fit into a page, as far as is known.
    std::uint16_t usual() const { return in_a_block(mean_); }

    /// Learns from a page; one not yet stored tells as much. Returns how many records fit into a
    /// page like it.
    std::uint16_t learn(std::uint32_t records, std::size_t page_bytes) {
        if (records == 0) return usual();
        const double bytes =
            std::max<double>(page_bytes, shape_.overhead + records) - shape_.overhead;
        const double share = bytes / shape_.room;
        const double fit = records * std::pow(share, shape_.inverse_growth);
        // Quickly from the first pages, then slowly; a crumb hardly counts.
        known_ = std::min(known_ + share, most_known);
        mean_ += (fit - mean_) * std::min(share / known_, 1.0);
        return in_a_block(fit);
    }

private:
    /// The share of what would fit: pages differ, and one that turns out too large has to be split.
    static constexpr double margin = 0.97;
    static constexpr double most_known = 8; // pages

    std::uint16_t in_a_block(double fit) const {
        return static_cast<std::uint16_t>(std::clamp<double>(margin * fit, 8, shape_.slots));
    }

    PageShape shape_;
    double mean_;
    double known_ = 0; // pages that the mean is of: nothing yet, but a guess
};

} // namespace abacus
