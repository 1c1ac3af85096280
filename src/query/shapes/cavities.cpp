#include "query/shapes/cavities.hpp"

#include "blocks/bit_column.hpp"

#include <algorithm>

namespace abacus {

Cavities::Cavities(const Host &host, std::size_t memory)
    : here_(host), numbers_here_(host), border_(host),
      most_numbers_(std::max(memory, RecordSort::least) / 3 / sizeof(std::uint32_t)), parts_(host),
      facets_(host, facet_words, corner_words, memory / 3 * 2) {
    parts_.reset(1);
}

void Cavities::begin_page(Cache<3> &cache, Handle any) {
    cache_ = &cache;
    first_ = Handle{to_number(any) / SimplexBlocks<3>::slots * SimplexBlocks<3>::slots};
    here_.reset(1 + SimplexBlocks<3>::slots);
    border_.clear();
}

void Cavities::meet(Handle h, int facet, Handle beyond) {
    if (Cache<3>::block_of(h) == Cache<3>::block_of(beyond))
        here_.join(local(h), local(beyond));
    else
        border_.push_back(make_link(h, facet));
}

std::uint32_t Cavities::new_number() {
    if (parts_.size() == most_numbers_)
        throw Error(ABACUS_ERROR_LIMIT, "the memory of a query is too small for this shape",
                    "There are too many parts that may be cavities.", "Increase work_mem.");
    return parts_.add();
}

void Cavities::number_page() {
    numbers_here_.resize(1 + SimplexBlocks<3>::slots);
    std::fill(numbers_here_.begin(), numbers_here_.end(), shut_in);
    numbers_here_[here_.find(outside_here)] = 0;
    for (const Link link : border_) {
        const Handle h = link_simplex(link);
        std::uint32_t &number = numbers_here_[here_.find(local(h))];
        if (number == shut_in) number = new_number();
        std::array<const Point<3> *, 3> corners;
        for (int i = 0, n = 0; i < 4; ++i)
            if (i != link_facet(link)) corners[n++] = &cache_->point(cache_->simplex(h).vertex[i]);
        std::sort(corners.begin(), corners.end(), [](const Point<3> *a, const Point<3> *b) {
            return lexicographically_less<3>(*a, *b);
        });
        std::uint64_t *word = facets_.add();
        for (const Point<3> *corner : corners)
            for (const double x : *corner) *word++ = ordered(x);
        *word = number;
    }
}

void Cavities::finish() {
    facets_.finish();
    std::array<std::uint64_t, facet_words> side{};
    std::uint64_t n = 0; // sides of the current facet; a fault has four, all beside its ghosts
    const auto end_facet = [&] {
        if (n % 2 != 0) throw_corrupted("A facet has only one side.");
    };
    while (const std::uint64_t *facet = facets_.next()) {
        if (n > 0 && std::equal(facet, facet + corner_words, side.begin())) {
            parts_.join(static_cast<std::uint32_t>(side.back()),
                        static_cast<std::uint32_t>(facet[corner_words]));
            ++n;
            continue;
        }
        end_facet();
        std::copy_n(facet, facet_words, side.begin());
        n = 1;
    }
    end_facet();
    facets_.close();
}

} // namespace abacus
