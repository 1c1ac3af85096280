// Staged points whose vertex has another id or other attributes than they have.
//
// Equal points are one vertex, and the first that was staged gives it its id and
// attributes. Within one staging equal points follow one another; a later staging may
// repeat a point of an earlier one, and then the difference is right: if and only if an
// equal point with the vertex's id and attributes was staged before. Such points are
// collected, many at a time, and looked for in one run over the staged points.
#pragma once

#include "staging/vertex_reader.hpp"

#include <algorithm>
#include <bit>
#include <memory_resource>
#include <vector>

namespace abacus {

/// Whether attributes are equal, bit by bit: NaN equals itself.
inline bool same_attributes(const double *a, const double *b, std::size_t n) {
    return n == 0 || std::memcmp(a, b, n * sizeof *a) == 0;
}

template <int D> class Repeats {
public:
    Repeats(const Host &host, unsigned attributes, std::size_t bytes,
            std::pmr::memory_resource *memory)
        : host_(host), attributes_(attributes),
          most_(
              std::max<std::size_t>(1024, bytes / (sizeof(Repeat) + attributes * sizeof(double)))),
          repeats_(memory), values_(memory) {}

    bool is_full() const { return repeats_.size() >= most_; }

    /// `id` and `attributes` are those of the vertex at p.
    void add(std::uint64_t sequence, const Point<D> &p, std::int64_t id, const double *attributes) {
        repeats_.push_back({p, sequence, id, values_.size(), false});
        values_.insert(values_.end(), attributes, attributes + attributes_);
    }

    /// Calls wrong(sequence) for every point collected that no earlier one explains, and
    /// forgets them all.
    template <class Wrong> void settle(Wrong wrong) {
        if (repeats_.empty()) return;
        const auto by_point = [](const Repeat &a, const Repeat &b) { return a.point < b.point; };
        const std::uint64_t end = repeats_.back().sequence;
        std::sort(repeats_.begin(), repeats_.end(), by_point);
        VertexReader<D> earlier(host_, attributes_, 0, end);
        std::pmr::vector<double> values(attributes_, values_.get_allocator());
        Repeat staged{};
        while (earlier.advance()) {
            staged.point = earlier.point();
            auto [at, last] = std::equal_range(repeats_.begin(), repeats_.end(), staged, by_point);
            if (at == last) continue;
            earlier.attributes(values.data());
            for (; at != last; ++at)
                if (earlier.sequence() < at->sequence && earlier.id() == at->id &&
                    same_attributes(values.data(), values_.data() + at->values, attributes_))
                    at->explained = true;
        }
        for (const Repeat &repeat : repeats_)
            if (!repeat.explained) wrong(repeat.sequence);
        repeats_.clear();
        values_.clear();
    }

private:
    struct Repeat {
        Point<D> point;
        std::uint64_t sequence;
        std::int64_t id;
        std::size_t values;
        bool explained;
    };

    const Host &host_;
    unsigned attributes_;
    std::size_t most_;
    std::pmr::vector<Repeat> repeats_;
    std::pmr::vector<double> values_;
};

} // namespace abacus
