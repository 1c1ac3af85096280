// Markers of facets: they come with the ids of the facet, and go to the simplices beside it when
// these are found to be neighbours. They are stored by the places of the simplices' corners.
#include "attributes/attribute_pages.hpp"
#include "blocks/counters.hpp"
#include "load/load.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

template <int D> void Load<D>::add_facets(const Word *facets, std::size_t count) {
    if (!marks_) marks_.emplace(host_, D + 1, D, small_share_);
    for (std::size_t i = 0; i < count; ++i, facets += D + 1) {
        const auto marker = std::bit_cast<double>(facets[D]);
        std::array<Word, D> ids;
        std::copy_n(facets, D, ids.begin());
        std::sort(ids.begin(), ids.end());
        if (std::adjacent_find(ids.begin(), ids.end()) != ids.end())
            faults_.add("facet " + sorted_name(ids) + " has the same vertex twice", {},
                        "Name facets of the simplices, by the ids of their vertices.");
        if (std::isnan(marker)) continue;
        if (!is_marker(marker))
            faults_.add("the marker of facet " + sorted_name(ids) + " is not an integer", {},
                        "Give an integer of four bytes, or NULL.");
        Word *mark = std::copy(ids.begin(), ids.end(), marks_->add());
        *mark = facets[D];
    }
}

template <int D> void Load<D>::begin_markers() {
    if (!marks_) return;
    marks_->finish();
    marked_.emplace(host_, 2, 1, small_share_);
    mark_ = marks_->next();
}

/// Rejects marks that come before a facet: they belong to no facet.
template <int D> void Load<D>::refuse_marks_before(const std::array<Word, D> *ids) {
    for (; mark_ != nullptr && (ids == nullptr || std::lexicographical_compare(
                                                      mark_, mark_ + D, ids->begin(), ids->end()));
         mark_ = marks_->next()) {
        std::array<Word, D> unknown;
        std::copy_n(mark_, D, unknown.begin());
        faults_.add("facet " + sorted_name(unknown) + " belongs to no simplex", {},
                    "Name facets of the simplices, by the ids of their vertices.");
    }
}

/// Gives the marker of a facet to its sides.
template <int D>
void Load<D>::mark_sides(const std::array<Word, D> &ids, std::span<const Word> sides) {
    refuse_marks_before(&ids);
    std::optional<Word> marker;
    for (; mark_ != nullptr && std::equal(ids.begin(), ids.end(), mark_); mark_ = marks_->next()) {
        if (marker && *marker != mark_[D])
            faults_.add("facet " + sorted_name(ids) + " is given two markers", {},
                        "Give each facet one marker, whichever side it is seen from.");
        if (marker) continue;
        marker = mark_[D];
        for (const Word side : sides) {
            Word *record = marked_->add();
            record[0] = side;
            record[1] = *marker;
        }
    }
}

template <int D> void Load<D>::end_marks() {
    refuse_marks_before(nullptr);
    end(marks_);
    marked_->finish();
    mark_ = marked_->next();
    marker_rows_.emplace(host_, key_words + D * (D + 1) + D + 1, key_words, small_share_);
}

/// Places the markers of the next simplex.
template <int D> void Load<D>::place_markers(Word simplex, const Word *record) {
    if (mark_ == nullptr || mark_[0] >> 2 != simplex) return;
    std::array<Point<D>, D + 1> points;
    for (int i = 0; i <= D; ++i) points[i] = point_in<D>(layout_.simplex_vertex(record, i));
    const Owner<D, D + 1> owner = owner_of<D, D + 1>(points);
    std::array<double, D + 1> markers;
    markers.fill(null_value);
    for (; mark_ != nullptr && mark_[0] >> 2 == simplex; mark_ = marked_->next()) {
        const auto at = std::find(owner.begin(), owner.end(), points[mark_[0] & 3]);
        markers[static_cast<std::size_t>(at - owner.begin())] = std::bit_cast<double>(mark_[1]);
    }
    const Key key = attribute_key<D, D + 1>(owner, code_of<D, D + 1>(*domain_, owner));
    Word *row = marker_rows_->add();
    *row++ = key.code;
    *row++ = key.part;
    std::memcpy(row, owner.data(), sizeof owner);
    std::memcpy(row + D * (D + 1), markers.data(), sizeof markers);
}

template <int D> void Load<D>::write_markers(abacus_header &header) {
    header.facts.census.marked = marker_rows_->size();
    marker_rows_->finish();
    AttributePages<D, D + 1> pages(host_, *domain_, D + 1, marker_group);
    while (const Word *row = marker_rows_->next()) {
        Owner<D, D + 1> owner;
        std::array<double, D + 1> markers;
        std::memcpy(owner.data(), row + key_words, sizeof owner);
        std::memcpy(markers.data(), row + key_words + D * (D + 1), sizeof markers);
        pages.put(owner, code_of<D, D + 1>(*domain_, owner), markers.data());
    }
    pages.flush();
    header.counters += pages.take_counters();
    end(marker_rows_);
}

} // namespace abacus
