// Simplices in the order of their keys, cut into pages.
//
// The cache makes the pages, since only it knows how: each is put together as a block, written
// and dropped again. A page is cut where the code changes, so that parts of keys need not be
// stored. Only where one code has more simplices than half a page, links into it carry parts.
// The size of a page in bytes is known when it is made. A page that turns out too large is cut
// shorter, if need be inside a code without parts. A reader then looks into all pages of that
// code, from the last one back (cache_load.cpp).
#pragma once

#include "load/records.hpp"
#include "mesh/cache.hpp"
#include "sort/record_sort.hpp"

#include <abacus/mesh_counters.h>

#include <algorithm>

namespace abacus {

template <int D> class ElementWriter {
public:
    ElementWriter(const Host &host, const LoadLayout<D> &layout, const Domain<D> &domain,
                  int attributes, bool linked_ghosts, bool split_nodes);

    /// Writes the pages of all elements, which are sorted; reads them twice.
    void write(RecordSort &elements, Pacer &pacer);
    const abacus_counters &counters() const { return cache_.counters; }

private:
    void find_crowded(RecordSort &elements);
    bool is_crowded(std::uint64_t code) const;
    /// Elements of a page. It can only grow: a code that is not crowded must leave a change
    /// of code where a page is cut.
    std::size_t capacity() const {
        return std::max<std::size_t>(least_capacity_, cache_.capacity());
    }
    const Word *element(std::size_t i) const { return waiting_.data() + i * layout_.element; }
    Key key(std::size_t i) const { return {element(i)[0], element(i)[1]}; }
    std::size_t cut(std::size_t most) const;
    void write_page(bool last);

    const Host &host_;
    const LoadLayout<D> layout_;
    Cache<D> cache_;
    const std::size_t least_capacity_; // elements of a page, before any is made
    Arena<std::uint64_t> crowded_;     // codes of many elements, ascending
    Arena<Word> waiting_;              // elements not written yet
    std::size_t count_ = 0;
    Arena<LooseSimplex<D>> loose_; // those of the current page
    Key lower_ = first_key;
};

extern template class ElementWriter<2>;
extern template class ElementWriter<3>;

} // namespace abacus
