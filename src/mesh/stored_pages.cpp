#include "mesh/stored_pages.hpp"

#include "mesh/page_format.hpp"

#include <abacus/facts.h>

namespace abacus {

void StoredPages::stored(abacus_page_kind kind, const abacus_page &page) {
    if (kind != ABACUS_SIMPLEX_PAGES) return;
    constexpr std::size_t few = 1024;
    PageHeader header;
    std::memcpy(&header, page.bytes, sizeof header);
    const std::uint64_t end = header.upper.code + (header.upper.part > 0);
    stretches_.push_back({header.lower.code, end - 1});
    if (stretches_.size() >= few + 2 * merged_) merge(); // at most as many as the mesh has pages
}

const Arena<StoredPages::Stretch> &StoredPages::stretches() {
    merge();
    return stretches_;
}

void StoredPages::merge() {
    std::sort(stretches_.begin(), stretches_.end(),
              [](const Stretch &a, const Stretch &b) { return a.least < b.least; });
    std::size_t n = 0;
    for (const Stretch &stretch : stretches_) {
        if (n > 0 && stretch.least <= stretches_[n - 1].greatest + 1)
            stretches_[n - 1].greatest = std::max(stretches_[n - 1].greatest, stretch.greatest);
        else
            stretches_[n++] = stretch;
    }
    stretches_.resize(n);
    merged_ = n;
}

} // namespace abacus
