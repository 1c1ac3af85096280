// Labels that go with their simplices, when the mesh changes.
//
// Labels are found by the places of a simplex' corners, and no insertion or removal looks at them.
// When all of a change is stored, the labels of each stretch of the curve that it has stored anew
// are compared with the simplices there: whose simplex is no longer in the mesh goes. So it does
// not matter what came and went on the way, in which order or thread, and whether the mesh was made
// anew as a whole: a simplex that a change leaves as it is, or brings back, keeps its labels.
//
// One page of labels after the other is read, and the pages of simplices with these codes.
#pragma once

#include "attributes/attribute_pages.hpp"
#include "mesh/page_format.hpp"
#include "mesh/stored_pages.hpp"

namespace abacus {

template <int D> class LabelSweep {
public:
    LabelSweep(const Host &host, const abacus_header &header, const Domain<D> &domain);

    /// Takes away what is without a simplex in a stretch; returns of how many simplices.
    std::uint64_t sweep(const StoredPages::Stretch &stretch);
    /// Writes what has been changed; returns the pages that have been moved.
    abacus_counters finish();

private:
    static constexpr unsigned group = first_group<D, D + 1>(); // whose pages tell which have some

    /// Reads a page of labels; false if none of its simplices has a code of the stretch.
    bool read(const abacus_page &page, const StoredPages::Stretch &stretch);
    /// Finds the simplices of its rows in the mesh.
    void find_simplices();
    void find(const Owner<D, D + 1> &simplex, std::uint64_t code);

    const Host &host_;
    const Domain<D> domain_;
    const unsigned labels_;
    const int attributes_; // of a simplex page
    AttributePages<D, D + 1> pages_;
    AttributePage<D, D + 1> rows_;
    Arena<Key> keys_;
    std::size_t begin_ = 0, end_ = 0; // the rows of the stretch
    Arena<bool> is_found_;
    PageView<D> view_;
    alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes_;
};

extern template class LabelSweep<2>;
extern template class LabelSweep<3>;

} // namespace abacus
