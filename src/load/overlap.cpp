#include "load/overlap.hpp"

#include "geometry/contact.hpp"

namespace abacus {

namespace {

constexpr char common_faces[] = "Simplices of a mesh meet in common faces only.";

std::string overlap_of(const std::string &a, const std::string &b) {
    return names_of(a, b) + " overlap";
}
void add_overlap(Faults &faults, const std::string &a, const std::string &b) {
    faults.add(overlap_of(a, b), "Their interiors have points in common.", common_faces);
}
void add_contact(Faults &faults, const std::string &a, const std::string &b,
                 const std::string &detail) {
    if (faults.has(overlap_of(a, b))) return; // which says more
    faults.add(names_of(a, b) + " meet in more than a common face", detail, common_faces);
}

constexpr std::size_t least_room = 64; // facets

} // namespace

template <int D>
Overlap<D>::Overlap(const Host &host, const LoadLayout<D> &layout, std::size_t memory)
    : host_(host), layout_(layout),
      room_(std::max(least_room, memory / (sizeof(BoundaryFacet) + BoxTree<D>::bytes_per_box))),
      facets_(host), tree_(host) {}

template <int D> typename Overlap<D>::BoundaryFacet Overlap<D>::read(const Word *record) const {
    BoundaryFacet facet;
    for (int i = 0; i < D; ++i) {
        const Word *vertex = layout_.boundary_vertex(record, i);
        facet.id[i] = vertex[0];
        facet.point[i] = point_in<D>(vertex);
    }
    const Word *opposite = layout_.behind(record) + 2;
    facet.opposite_id = opposite[0];
    facet.opposite = point_in<D>(opposite);
    return facet;
}

/// Takes the next facets into memory; false if there are none.
template <int D> bool Overlap<D>::fill(RecordSort &boundary) {
    first_ += facets_.size();
    facets_.clear();
    tree_.clear();
    boundary.rewind();
    for (std::uint64_t i = 0; i < first_; ++i) boundary.next();
    while (facets_.size() < room_) {
        const Word *record = boundary.next();
        if (record == nullptr) break;
        facets_.push_back(read(record));
        tree_.add(facets_.back().box());
    }
    tree_.finish();
    return !facets_.empty();
}

template <int D>
void Overlap<D>::check(RecordSort &boundary, RecordSpool &simplices, Faults &faults) {
    while (!faults.is_full() && fill(boundary)) {
        check_simplices(simplices, faults);
        check_boundary(boundary, faults);
        if (first_ + facets_.size() == boundary.size()) break;
    }
    if (faults.is_full()) faults.stop();
    faults.raise();
    facets_.reset();
}

template <int D> void Overlap<D>::check_simplices(RecordSpool &simplices, Faults &faults) const {
    simplices.rewind();
    while (const Word *simplex = faults.is_full() ? nullptr : simplices.next()) {
        Corners<D> corners;
        Box<D> box;
        for (int i = 0; i <= D; ++i) {
            corners[i] = &point_in<D>(layout_.simplex_vertex(simplex, i));
            box.extend(*corners[i]);
        }
        tree_.visit(box, [&](std::size_t i) {
            host_.poll();
            const Cover cover = covers(corners, facets_[i]);
            if (cover == Cover::none) return true;
            std::array<Word, D + 1> ids;
            for (int k = 0; k <= D; ++k) ids[k] = layout_.simplex_vertex(simplex, k)[0];
            if (cover == Cover::inside)
                add_overlap(faults, facets_[i].simplex(), sorted_name(ids));
            else
                add_contact(faults, facets_[i].simplex(), sorted_name(ids),
                            "Facet " + sorted_name(facets_[i].id) + " lies along " +
                                sorted_name(ids) + ".");
            return !faults.is_full();
        });
    }
}

template <int D>
typename Overlap<D>::Cover Overlap<D>::covers(const Corners<D> &corners,
                                              const BoundaryFacet &facet) {
    Cover cover = Cover::inside;
    for (int k = 0; k <= D; ++k) {
        Corners<D> replaced = corners;
        int side = 0;
        for (int i = 0; i < D && side == 0; ++i) {
            replaced[k] = &facet.point[i];
            side = orientation<D>(replaced);
        }
        if (side == 0) { // the facet lies in this plane: towards or away from the simplex
            Corners<D> base;
            for (int i = 0; i < D; ++i) base[i] = &facet.point[i];
            base[D] = &facet.opposite;
            const int solid = orientation<D>(base);
            base[D] = corners[k];
            side = orientation<D>(base) == solid ? -1 : 1;
            cover = Cover::along;
        }
        if (side < 0) return Cover::none;
    }
    return cover;
}

template <int D> void Overlap<D>::check_boundary(RecordSort &boundary, Faults &faults) const {
    boundary.rewind();
    for (std::uint64_t number = 0;; ++number) {
        const Word *record = boundary.next();
        if (record == nullptr || faults.is_full()) return;
        if (number < first_) continue;
        const BoundaryFacet facet = read(record);
        tree_.visit(facet.box(), [&](std::size_t i) {
            host_.poll();
            const BoundaryFacet &other = facets_[i];
            if (first_ + i >= number) return false; // itself and later ones: their turn comes
            if (meet_improperly(facet.vertices(), other.vertices()))
                add_contact(faults, other.simplex(), facet.simplex(),
                            "Their facets " + sorted_name(other.id) + " and " +
                                sorted_name(facet.id) + " cross or touch.");
            return !faults.is_full();
        });
    }
}

template class Overlap<2>;
template class Overlap<3>;

} // namespace abacus
