// Keeps the markers of facets while the simplices beside them come and go.
//
// A facet's marker is kept with each simplex beside it, so both sides agree. When a simplex is
// removed, so is its row (label_sweep.hpp), with the markers of its facets. Those facets that are
// still in the mesh have another simplex on that side, which the change has stored: they are looked
// up among the simplices of the stored stretches, and get their markers back. The facets of
// simplices that stay are looked up, too: a facet of the hull may now have a simplex beyond it. As
// for labels, neither order nor threads matter.
//
// A fixed edge of a removed simplex may have been split or joined with another one. Then its heirs,
// which the caller knows (MarkerHeirs), are looked up, too.
//
// These facets go to a spool; as many as memory holds are looked up at once.
#pragma once

#include "labels/label_sweep.hpp"
#include "sort/record_spool.hpp"

namespace abacus {

/// A facet of a simplex: the one opposite its corner `opposite`, in the order of its points.
template <int D> Owner<D, D> facet_of(const Owner<D, D + 1> &simplex, int opposite) {
    Owner<D, D> facet;
    for (int i = 0; i < D; ++i) facet[i] = simplex[i + (i >= opposite)];
    return facet;
}

/// Whether a facet has a marker: the stored value must be a marker, or missing.
inline bool has_marker(double stored) {
    if (!std::isnan(stored) && !is_marker(stored))
        throw_corrupted("A facet has a marker that is not an integer of four bytes.");
    return !std::isnan(stored);
}

/// Gives one facet of a simplex a marker; returns whether the simplex had none.
template <int D>
bool set_marker(AttributePages<D, D + 1> &pages, const Owner<D, D + 1> &simplex, std::uint64_t code,
                std::uint32_t opposite, double marker) {
    if (pages.set(simplex, code, {&opposite, 1}, &marker)) return false;
    std::array<double, D + 1> markers;
    markers.fill(null_value);
    markers[opposite] = marker;
    pages.put(simplex, code, markers.data());
    return true;
}

/// Who inherits the markers of facets that have gone.
template <int D> class MarkerHeirs {
public:
    using Facet = Owner<D, D>;
    /// A facet of a simplex that has gone, which may still be in the mesh, beside others.
    virtual void add(const Facet &facet, double marker) = 0;
    /// Each facet that inherits a marker; no more can be added.
    virtual void each(const std::function<void(const Facet &, double)> &visit) = 0;

protected:
    ~MarkerHeirs() = default;
};

template <int D> class MarkerSweep {
public:
    MarkerSweep(const Host &host, const abacus_facts &facts, const Domain<D> &domain,
                std::size_t memory);

    /// For a change that has stored these stretches. Returns how many simplices have markers now,
    /// if `marked` had some before. `heirs` may be null.
    std::uint64_t sweep(const Arena<StoredPages::Stretch> &stretches, std::uint64_t marked,
                        MarkerHeirs<D> *heirs);
    abacus_counters finish() { return rows_.finish(); }

private:
    using Simplex = Owner<D, D + 1>;
    struct Marked {
        Key key;
        Owner<D, D> facet;
        double marker;
    };
    struct Found {
        Simplex simplex;
        std::uint64_t code;
        std::uint32_t opposite;
        double marker;
    };
    static constexpr std::size_t least_room = 64;

    void add(const Simplex &simplex, const double *markers, MarkerHeirs<D> *heirs);
    void add(const Owner<D, D> &facet, double marker);
    /// Reads the next facets to look up; false if there are none.
    bool read_marked();
    void look_at(const Simplex &simplex, std::uint64_t code);
    /// Gives the facets found their markers; returns how many simplices had none.
    std::uint64_t mark_found();

    const Host &host_;
    const Domain<D> domain_;
    LabelSweep<D> rows_;
    RecordSpool spool_;
    const std::size_t room_; // for this many facets at once
    Arena<Marked> marked_;
    Arena<Found> found_; // in a page
};

extern template class MarkerSweep<2>;
extern template class MarkerSweep<3>;

} // namespace abacus
