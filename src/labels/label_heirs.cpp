#include "labels/label_heirs.hpp"

namespace abacus {

namespace {

template <int D> constexpr std::size_t place_words = D *(D + 1);
constexpr std::size_t least_room = 64;

/// The corners in positive orientation.
template <int D> Corners<D> corners_of(const Owner<D, D + 1> &simplex) {
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &simplex[i];
    if (orientation<D>(corners) < 0) std::swap(corners[0], corners[1]);
    return corners;
}

template <int D> Point<D> centroid_of(const Owner<D, D + 1> &simplex) {
    Point<D> centroid{};
    for (const Point<D> &p : simplex)
        for (int axis = 0; axis < D; ++axis) centroid[axis] += p[axis] / (D + 1);
    return centroid;
}

} // namespace

template <int D>
LabelHeirs<D>::LabelHeirs(const Host &host, unsigned labels, std::size_t memory)
    : labels_(labels), spool_(host, place_words<D> + labels),
      room_(std::max(least_room, memory / (sizeof(Simplex) + BoxTree<D>::bytes_per_box +
                                           labels * sizeof(double)))),
      tree_(host), lost_(host), values_(host), heirs_(host) {}

template <int D> void LabelHeirs<D>::lose(const Simplex &simplex, const double *labels) {
    std::uint64_t *const record = spool_.add();
    std::memcpy(record, simplex.data(), sizeof simplex);
    std::memcpy(record + place_words<D>, labels, labels_ * sizeof(double));
}

template <int D>
std::uint64_t LabelHeirs<D>::pass_on(LabelSweep<D> &sweep,
                                     const Arena<StoredPages::Stretch> &stretches) {
    std::uint64_t count = 0;
    spool_.rewind();
    while (read_lost())
        for (const StoredPages::Stretch &stretch : stretches)
            sweep.simplices().each(
                stretch,
                [&](const Simplex &simplex, std::uint64_t code) { look_at(simplex, code); },
                [&] { count += give(sweep.pages()); });
    spool_.close();
    return count;
}

template <int D> bool LabelHeirs<D>::read_lost() {
    lost_.clear();
    values_.clear();
    tree_.clear();
    while (lost_.size() < room_) {
        const std::uint64_t *const record = spool_.next();
        if (record == nullptr) break;
        Simplex simplex;
        std::memcpy(simplex.data(), record, sizeof simplex);
        lost_.push_back(simplex);
        Box<D> box;
        for (const Point<D> &p : simplex) box.extend(p);
        tree_.add(box);
        const std::size_t at = values_.size();
        values_.resize(at + labels_);
        std::memcpy(values_.data() + at, record + place_words<D>, labels_ * sizeof(double));
    }
    tree_.finish();
    return !lost_.empty();
}

template <int D> void LabelHeirs<D>::look_at(const Simplex &simplex, std::uint64_t code) {
    const Point<D> centroid = centroid_of<D>(simplex);
    bool is_inside = false, is_known = false; // whether the centroid is in its own simplex
    tree_.visit(Box<D>(centroid, centroid), [&](std::size_t i) {
        if (!is_known) is_inside = in_simplex<D>(corners_of<D>(simplex), centroid) > 0;
        is_known = true;
        if (!is_inside) return false;
        if (in_simplex<D>(corners_of<D>(lost_[i]), centroid) < 0) return true;
        heirs_.push_back({simplex, code, i});
        return false;
    });
}

/// A simplex that already has labels is not new, or got them from a removed simplex with a lesser
/// key.
template <int D> std::uint64_t LabelHeirs<D>::give(AttributePages<D, D + 1> &pages) {
    std::uint64_t count = 0;
    sort_along_keys<D>(heirs_);
    for (const Heir &heir : heirs_)
        count += pages.put_new(heir.simplex, heir.code, values_.data() + heir.from * labels_);
    heirs_.clear();
    return count;
}

template class LabelHeirs<2>;
template class LabelHeirs<3>;

} // namespace abacus
