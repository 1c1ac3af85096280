#include "query/pages/page_search.hpp"

#include <cstring>

namespace abacus {

template <int D> typename PageSearch<D>::Held &PageSearch<D>::page(const Key &key) {
    Held *oldest = &pages_.front();
    for (Held &held : pages_) {
        if (held.lower <= key && key < held.upper) {
            held.last_use = ++uses_;
            return held;
        }
        if (held.last_use < oldest->last_use) oldest = &held;
    }
    Held &held = *oldest;
    held.lower = held.upper = {}; // no page, until everything has succeeded
    held.patches = 0;
    abacus_page page{};
    if (!host_.find(ABACUS_SIMPLEX_PAGES, key, page))
        throw_corrupted("No page owns a part of the curve.");
    ++pages_read_;
    std::memcpy(held.bytes.data(), page.bytes, std::min(page.size, held.bytes.size()));
    held.view.open(held.bytes.data(), page.size, attributes_);
    if (!(held.view.lower() == page.key))
        throw_corrupted("A page is stored under another page's key.");
    if (key < held.view.lower() || held.view.upper() <= key)
        throw_corrupted("No page owns a part of the curve.");
    held.lower = held.view.lower();
    held.upper = held.view.upper();
    held.last_use = ++uses_;
    return held;
}

template class PageSearch<2>;
template class PageSearch<3>;

} // namespace abacus
