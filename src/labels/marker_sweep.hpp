// Markers of facets that stay while simplices beside them come and go.
//
// A facet's marker is kept with each simplex beside it, so both sides agree. When a simplex goes,
// its row goes (label_sweep.hpp), and with it the markers of its facets. Those facets that are
// still in the mesh have another simplex on that side, which the change has stored: among the
// simplices of the stretches that it has stored they are looked for, and get their markers again.
// So are the facets of simplices that stay: one at the hull may have got a simplex beyond it.
// Neither order nor threads matter to that, as for labels.
//
// These facets go to a spool, and as many are looked for at once as memory holds.
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

/// Whether a facet has a marker: what a page has for it is one, or nothing.
inline bool has_marker(double stored) {
    if (!std::isnan(stored) && !is_marker(stored))
        throw_corrupted("A facet has a marker that is no integer of four bytes.");
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

template <int D> class MarkerSweep {
public:
    MarkerSweep(const Host &host, const abacus_facts &facts, const Domain<D> &domain,
                std::size_t memory);

    /// Of a change that has stored these stretches. Returns how many simplices have markers now, if
    /// `marked` had before.
    std::uint64_t sweep(const Arena<StoredPages::Stretch> &stretches, std::uint64_t marked);
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

    void add(const Simplex &simplex, const double *markers);
    /// Reads the next facets to be looked for; false if there are none.
    bool read_marked();
    void look_at(const Simplex &simplex, std::uint64_t code);
    /// Gives what has been found its markers; returns how many simplices had none.
    std::uint64_t mark_found();

    const Host &host_;
    const Domain<D> domain_;
    LabelSweep<D> rows_;
    RecordSpool spool_;
    const std::size_t room_; // for so many facets at once
    Arena<Marked> marked_;
    Arena<Found> found_; // in a page
};

extern template class MarkerSweep<2>;
extern template class MarkerSweep<3>;

} // namespace abacus
