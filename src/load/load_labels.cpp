// Labels of simplices: they come with the corners, and are stored by the places of these.
//
// The simplices are assembled in the order in which they came, so their labels are read in step.
// Simplices with labels are then sorted by the keys under which labels are found, so that each page
// is written once.
#include "attributes/attribute_pages.hpp"
#include "blocks/counters.hpp"
#include "load/load.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

template <int D> void Load<D>::begin_labels() {
    if (labels_ == 0) return;
    begin(labelled_, key_words + D * (D + 1) + labels_, key_words);
    label_rows_.rewind();
}

/// Places the labels of the next simplex.
template <int D> void Load<D>::place_labels(const Corners<D> &corners) {
    const Word *labels = label_rows_.next();
    const auto is_missing = [](Word label) { return std::isnan(std::bit_cast<double>(label)); };
    if (std::all_of(labels, labels + labels_, is_missing)) return;
    std::array<Point<D>, D + 1> points;
    for (int i = 0; i <= D; ++i) points[i] = *corners[i];
    const Owner<D, D + 1> owner = owner_of<D, D + 1>(points);
    const Key key = attribute_key<D, D + 1>(owner, code_of<D, D + 1>(*domain_, owner));
    Word *record = labelled_->add();
    *record++ = key.code;
    *record++ = key.part;
    std::memcpy(record, owner.data(), sizeof owner);
    std::copy_n(labels, labels_, record + D * (D + 1));
}

template <int D> void Load<D>::write_labels(abacus_header &header) {
    header.facts.census.labelled = labelled_->size();
    labelled_->finish();
    AttributePages<D, D + 1> pages(host_, *domain_, labels_);
    Arena<double> labels(host_);
    labels.resize(labels_);
    while (const Word *record = labelled_->next()) {
        Owner<D, D + 1> owner;
        std::memcpy(owner.data(), record + key_words, sizeof owner);
        std::memcpy(labels.data(), record + key_words + D * (D + 1), labels_ * sizeof(double));
        pages.put(owner, code_of<D, D + 1>(*domain_, owner), labels.data());
    }
    pages.flush();
    header.counters += pages.take_counters();
    end(labelled_);
}

} // namespace abacus
