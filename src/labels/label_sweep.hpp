// Keeps labels, or markers of facets, in step with the simplices when the mesh changes.
//
// Both are found by the places of a simplex' corners, and no insertion or removal looks at them.
// When a change has been stored completely, the rows of each stretch of the curve that it has
// stored are compared with the simplices there: a row whose simplex is no longer in the mesh is
// removed. So it does not matter which simplices came and went in between, in which order or
// thread, or whether the whole mesh was rebuilt: a simplex that a change leaves as it is, or brings
// back, keeps its row.
//
// Pages of rows are read one after the other, each together with the simplex pages of its codes.
#pragma once

#include "attributes/attribute_pages.hpp"
#include "mesh/page_attributes.hpp"
#include "mesh/page_format.hpp"
#include "mesh/stored_pages.hpp"

#include <functional>

namespace abacus {

/// Reads the pages of the simplices whose codes lie in a stretch.
template <int D> class SimplicesOfStretch {
public:
    using Simplex = Owner<D, D + 1>;

    SimplicesOfStretch(const Host &host, const abacus_facts &facts, const Domain<D> &domain)
        : host_(host), domain_(domain), attributes_(page_attributes(facts.columns)) {}

    /// Calls visit(simplex, code) for each finite simplex with a code of the stretch, and leave()
    /// after those of each page; visit must not call the host.
    template <class Visit, class Leave>
    void each(const StoredPages::Stretch &stretch, const Visit &visit, const Leave &leave) {
        abacus_page page;
        bool more = host_.find(ABACUS_SIMPLEX_PAGES, {stretch.least, 0}, page);
        while (more) {
            const Key key = page.key;
            view_.read(page.bytes, page.size, attributes_);
            for (int s = 0; s < view_.simplices(); ++s) {
                if (view_.is_ghost(s)) continue;
                std::array<Point<D>, D + 1> points;
                for (int i = 0; i <= D; ++i) points[i] = view_.point(view_.corner(s, i));
                const Simplex simplex = owner_of<D, D + 1>(points);
                const std::uint64_t code = code_of<D, D + 1>(domain_, simplex);
                if (stretch.least <= code && code <= stretch.greatest) visit(simplex, code);
            }
            leave();
            host_.poll();
            more =
                host_.next(ABACUS_SIMPLEX_PAGES, &key, page) && page.key.code <= stretch.greatest;
        }
    }

private:
    const Host &host_;
    const Domain<D> domain_;
    const int attributes_; // of a simplex page
    PageView<D> view_;
};

/// Sorts elements for the simplices of a page into the order of their rows, so that few pages of
/// rows are visited again. An element has a simplex and a code.
template <int D, class T> void sort_along_keys(Arena<T> &elements) {
    const auto key = [](const T &e) { return attribute_key<D, D + 1>(e.simplex, e.code); };
    std::sort(elements.begin(), elements.end(),
              [&](const T &a, const T &b) { return key(a) < key(b); });
}

template <int D> class LabelSweep {
public:
    using Simplex = Owner<D, D + 1>;
    /// Gets a simplex that has been removed, or is still there, and the values of its row.
    using Report = std::function<void(const Simplex &, const double *)>;

    /// Of so many columns, in groups from `first` on.
    LabelSweep(const Host &host, const abacus_facts &facts, const Domain<D> &domain,
               unsigned columns, unsigned first);

    /// Removes the rows of a stretch whose simplices are gone; returns how many simplices these
    /// are. `kept` requires that the columns are in one group.
    std::uint64_t sweep(const StoredPages::Stretch &stretch, const Report &gone = {},
                        const Report &kept = {});
    /// Writes the changes; the counters returned are those of the pages moved.
    abacus_counters finish();

    AttributePages<D, D + 1> &pages() { return pages_; }
    SimplicesOfStretch<D> &simplices() { return simplices_; }

private:
    /// Reads the page that owns the key, if there is one; returns where the next one begins.
    Key read(const Key &from);
    std::size_t first_row(const Key &from) const;
    void find(const Simplex &simplex, std::uint64_t code);
    void take_away(std::size_t row, const Report &gone);
    void report(std::size_t row, const Report &kept);

    const Host &host_;
    const Domain<D> domain_;
    const unsigned columns_; // of the first group
    const unsigned group_;
    Arena<double> values_; // of a simplex
    AttributePages<D, D + 1> pages_;
    AttributePage<D, D + 1> rows_;
    Arena<Key> keys_;
    std::size_t begin_ = 0, end_ = 0; // the rows of the stretch
    Arena<bool> is_found_;
    SimplicesOfStretch<D> simplices_;
    alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes_;
};

extern template class LabelSweep<2>;
extern template class LabelSweep<3>;

} // namespace abacus
