// Voronoi cells behind the C interface.
#include "query/shapes/voronoi.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/shapes.h>

struct abacus_voronoi {
    abacus_voronoi(const abacus_host *table, const abacus_facts &facts, const abacus_window &window,
                   std::size_t cache_bytes)
        : host(*table), ring(host), cells(host, facts, window, cache_bytes) {}

    const abacus::Host host;
    abacus::Arena<double> ring; // returned last
    abacus::ByDimension<abacus::Voronoi> cells;
    bool is_in_cell = false; // whether facets are being read: where the next one is
    std::size_t face = 0, corner = 0;
};

namespace abacus {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// Whether no corner of a ring is at infinity.
template <int D>
bool is_finite(const CellShape<D> &shape, const typename CellShape<D>::Face &face) {
    for (std::size_t i = face.begin; i < face.end; ++i)
        if (shape.corners()[i].is_infinite()) return false;
    return true;
}

template <int D>
void add_points(Arena<double> &ring, const CellShape<D> &shape, std::size_t begin,
                std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
        for (const double x : shape.corners()[i].at) ring.push_back(x);
}

template <int D>
void fill(abacus_voronoi &voronoi, const Voronoi<D> &cells, abacus_voronoi_cell &cell) {
    const CellShape<D> &shape = cells.shape();
    cell = {};
    cell.vertex = cells.id();
    cell.bounded = cells.is_bounded();
    voronoi.ring.clear();
    if (!cells.is_bounded() && !cells.is_clipped()) {
        cell.area = cell.volume = endless;
    } else if constexpr (D == 2) {
        cell.area = shape.content();
        add_points<2>(voronoi.ring, shape, 0, shape.corners().size());
    } else {
        cell.volume = shape.content();
        for (const auto &face : shape.faces()) cell.area += shape.area(face);
    }
    cell.corners = voronoi.ring.size() / D;
    cell.ring = voronoi.ring.data();
}

/// Describes a facet whose points are in the ring, unless it is unbounded.
template <int D>
void name(const Voronoi<D> &cells, int label, double size, bool is_bounded, abacus_voronoi &voronoi,
          abacus_voronoi_facet &facet) {
    facet = {};
    facet.vertex = cells.id();
    facet.has_neighbour = label >= 0;
    if (label >= 0) facet.neighbour = cells.neighbour_id(label);
    facet.bounded = is_bounded;
    facet.size = is_bounded ? size : endless;
    if (!is_bounded) voronoi.ring.clear();
    facet.corners = voronoi.ring.size() / D;
    facet.ring = voronoi.ring.data();
}

/// The next facet of the current cell: an edge of its only face.
bool next_facet(abacus_voronoi &voronoi, const Voronoi<2> &cells, abacus_voronoi_facet &facet) {
    const auto &corners = cells.shape().corners();
    while (voronoi.corner < corners.size()) {
        const auto &from = corners[voronoi.corner++];
        const auto &to = corners[voronoi.corner % corners.size()];
        if (from.next == CellShape<2>::no_label) continue; // at infinity
        voronoi.ring.clear();
        for (const auto *end : {&from, &to})
            for (const double x : end->at) voronoi.ring.push_back(x);
        name(cells, from.next, distance<2>(from.at, to.at),
             !from.is_infinite() && !to.is_infinite(), voronoi, facet);
        return true;
    }
    return false;
}

bool next_facet(abacus_voronoi &voronoi, const Voronoi<3> &cells, abacus_voronoi_facet &facet) {
    const CellShape<3> &shape = cells.shape();
    if (voronoi.face == shape.faces().size()) return false;
    const auto &face = shape.faces()[voronoi.face++];
    voronoi.ring.clear();
    add_points<3>(voronoi.ring, shape, face.begin, face.end);
    name(cells, face.label, shape.area(face), is_finite<3>(shape, face), voronoi, facet);
    return true;
}

} // namespace
} // namespace abacus

abacus_status abacus_voronoi_open(const abacus_host *host, const abacus_facts *facts,
                                  const abacus_window *window, std::size_t cache_bytes,
                                  abacus_voronoi **voronoi, abacus_error *error) {
    return abacus::guard(error, [&] {
        *voronoi = abacus::create_handle<abacus_voronoi>(host, *facts, *window, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_voronoi_next(abacus_voronoi *voronoi, abacus_voronoi_cell *cell,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        return voronoi->cells.visit([&](auto &cells) {
            if (!cells.advance()) return ABACUS_END;
            abacus::fill(*voronoi, cells, *cell);
            return ABACUS_OK;
        });
    });
}

abacus_status abacus_voronoi_next_facet(abacus_voronoi *voronoi, abacus_voronoi_facet *facet,
                                        abacus_error *error) {
    return abacus::guard(error, [&] {
        return voronoi->cells.visit([&](auto &cells) {
            while (!voronoi->is_in_cell || !abacus::next_facet(*voronoi, cells, *facet)) {
                if (!cells.advance()) return ABACUS_END;
                voronoi->is_in_cell = true;
                voronoi->face = voronoi->corner = 0;
            }
            return ABACUS_OK;
        });
    });
}

void abacus_voronoi_close(abacus_voronoi *voronoi) { abacus::destroy_handle(voronoi); }
