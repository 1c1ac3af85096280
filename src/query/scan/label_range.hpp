// Selects the simplices that have a label within a range.
//
// Pages of labels lie along the curve as those of simplices do, and the head of a column bounds the
// values in it. So a page of simplices is skipped if no page of labels that belongs to its stretch
// of the curve may have such a value. The heads of these pages decide; labels are read only where
// simplices are.
#pragma once

#include "query/scan/simplex_labels.hpp"

#include <abacus/windows.h>

namespace abacus {

template <int D> class LabelRange {
public:
    /// `range` names the label by its number.
    LabelRange(const Host &host, const abacus_facts &facts, const abacus_range &range);

    /// Whether some simplex of the page may be wanted; true if one is.
    bool may_be_in(const PageView<D> &page);
    /// For a simplex that is not a ghost. A NULL is in no range.
    bool wants(const PageView<D> &page, int simplex);

private:
    /// The interval that a page of labels owns, and whether it may have a wanted value.
    struct Stretch {
        Key lower{}, upper{};
        bool may_have = false;
    };
    const Stretch &stretch_of(const Key &key);

    const Host &host_;
    const abacus_range range_;
    const bool has_labels_;
    const unsigned group_;   // with the label, among all
    const unsigned columns_; // of the group
    const unsigned column_;  // of the label in it
    SimplexLabels<D> labels_;
    AttributePage<D, D + 1> page_;
    Stretch last_; // the last one requested
    alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes_;
};

extern template class LabelRange<2>;
extern template class LabelRange<3>;

} // namespace abacus
