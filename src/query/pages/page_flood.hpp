// Reaches pages from one another across facets.
//
// A page has, for each facet on its border, the key of the simplex beyond. So one page of a mesh
// leads to all pages that a chain of neighbouring simplices reaches, each read once. The page index
// finds the page of a key. The pages already read are recorded as intervals of keys, which grow
// together. Memory holds only these intervals and the keys still to be looked up.
//
// The next page is the least one ahead on the curve. Pages found behind wait until there is none
// ahead, and then come in order again. Once all are known they can be read again, strictly along
// the curve.
#pragma once

#include "host/memory_resource.hpp"
#include "keys/locational_code.hpp"
#include "mesh/inner_links.hpp"

#include <abacus/facts.h>

#include <map>

namespace abacus {

template <int D> class PageFlood {
public:
    PageFlood(const Host &host, const abacus_facts &facts);

    /// The page that owns the key will be read.
    void reach(const Key &key);
    /// Goes to the next page; false if none is left. Throws if it is damaged or missing.
    bool advance();
    /// Reaches what lies across those facets on the page's border for which crosses(simplex, facet)
    /// holds.
    template <class Crosses> void spread(Crosses crosses) {
        if (page().links() == 0 || is_again_) return;
        inner_links_.connect(page(), slots_.data(), Handle{}, true, border_, on_border_);
        for (std::size_t i = 0; i < border_.size(); ++i)
            if (crosses(static_cast<int>(to_number(link_simplex(border_[i]))),
                        link_facet(border_[i])))
                follow(static_cast<int>(i));
    }
    /// After the last page: begins again with the first of those that were read.
    void rewind();

    const PageView<D> &page() const { return view_; }
    /// Pages read so far, including those read again.
    std::uint64_t pages_read() const { return pages_read_; }

private:
    using Less = bool (*)(const Key &, const Key &);

    void follow(int link);
    /// All pages with simplices of this code will be read.
    void reach_all(std::uint64_t code);
    bool advance_again();
    /// Takes the next page off the list of pages to be read; true if it has not been read.
    bool take_open();
    void read(const Key &key);
    /// The lower end of the interval already read around a key; null if the key has not been read.
    const Key *read_around(const Key &key) const;
    void note_read(Key lower, Key upper);

    const Host &host_;
    const int attributes_;
    const Domain<D> domain_;
    HostMemory memory_;
    std::pmr::map<Key, bool, Less> open_; // to be read; whether all pages with its code are
    std::pmr::map<Key, Key, Less> read_;  // intervals by their lower ends
    Key at_ = first_key;
    bool is_again_ = false;
    std::uint64_t pages_read_ = 0;
    PageView<D> view_;
    InnerLinks<D> inner_links_;
    Arena<Simplex<D>> slots_;
    Arena<Link> border_;
    Arena<bool> on_border_;
    alignas(8) unsigned char copy_[ABACUS_PAGE_BYTES];
};

extern template class PageFlood<2>;
extern template class PageFlood<3>;

} // namespace abacus
