// Segments of lines, collected in any order and read along the curve: by the code of their
// lexicographically lesser end. Of equal
// ones, one comes: a hard one, if there is any.
#pragma once

#include "geometry/point.hpp"
#include "keys/domain_of.hpp"
#include "mesh/fixed_facets.hpp"
#include "points/record.hpp"
#include "sort/record_sort.hpp"

#include <abacus/facts.h>

#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace abacus {

/// With the lesser end first.
struct Segment {
    Point<2> a, b;
    Fixed how;
};

/// A segment as the record of a point: that of its lesser end, with the kind as its id and the
/// other end as attributes.
constexpr std::size_t segment_record_words = record_words(2, 2);
inline void fill_segment(std::uint64_t *record, const Segment &segment) {
    fill_record<2>(record, static_cast<std::int64_t>(segment.how), segment.a, segment.b.data(),
                   segment.b.size());
}
inline Segment record_segment(const std::uint64_t *record) {
    const double *const far = record_attributes<2>(record);
    return {record_point<2>(record), {far[0], far[1]}, static_cast<Fixed>(record_id(record))};
}

class Segments {
public:
    Segments(const Host &host, const abacus_facts &facts, std::size_t memory)
        : sort_(host, words, words, memory) {
        if (facts.form.dimension != 2)
            throw Error(ABACUS_ERROR_ARGUMENT, "lines need a mesh of dimension 2");
        if (facts.form.has_domain != 0) domain_.emplace(domain_of<2>(facts.form));
    }

    /// Adds a segment: x and y of both ends.
    void add(const double *ends, Fixed how) {
        for (int i = 0; i < 4; ++i)
            if (!std::isfinite(ends[i]))
                throw Error(ABACUS_ERROR_ARGUMENT, "a coordinate of a line is not finite");
        Point<2> a{ends[0] + 0.0, ends[1] + 0.0}, b{ends[2] + 0.0, ends[3] + 0.0}; // 0, not -0
        if (b < a) std::swap(a, b);
        std::uint64_t *const record = sort_.add();
        record[0] = domain_ ? domain_->code(a) : 0;
        for (int i = 0; i < 2; ++i) {
            record[1 + i] = std::bit_cast<std::uint64_t>(a[i]);
            record[3 + i] = std::bit_cast<std::uint64_t>(b[i]);
        }
        record[5] = how == Fixed::soft; // after the hard one
    }
    /// Counts equal ones too.
    std::uint64_t size() const { return sort_.size(); }

    /// Calls visit(segment) for each; no more can be added. May be called again.
    template <class Visit> void each(Visit visit) {
        if (is_finished_)
            sort_.rewind();
        else
            sort_.finish();
        is_finished_ = true;
        std::array<std::uint64_t, words - 1> last{};
        bool is_first = true;
        while (const std::uint64_t *record = sort_.next()) {
            if (!is_first && std::equal(last.begin(), last.end(), record)) continue;
            std::copy_n(record, last.size(), last.begin());
            is_first = false;
            std::array<double, 4> x;
            for (int i = 0; i < 4; ++i) x[i] = std::bit_cast<double>(record[1 + i]);
            visit(Segment{{x[0], x[1]}, {x[2], x[3]}, record[5] != 0 ? Fixed::soft : Fixed::hard});
        }
    }
    void close() { sort_.close(); }

private:
    static constexpr std::size_t words = 6;

    RecordSort sort_; // code, both ends, 1 if it is soft
    std::optional<Domain<2>> domain_;
    bool is_finished_ = false;
};

} // namespace abacus
