#include "query/levels/contours.hpp"

#include "query/levels/contour_rings.hpp"
#include "query/levels/path_parts.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/scan/extent_pages.hpp"
#include "query/scan/narrowed.hpp"

#include <cmath>
#include <limits>

namespace abacus {

namespace {

const abacus_contouring &checked(const abacus_facts &facts, const abacus_contouring &how) {
    if (facts.form.dimension != 2)
        throw Error(ABACUS_ERROR_ARGUMENT, "contours need a mesh of dimension 2");
    return how;
}

void report_path(abacus_contour_report report, void *context, std::int64_t id, double value,
                 bool is_closed, const Arena<Point<2>> &path) {
    host::require(report(context, id, value, is_closed, path.data()->data(), path.size()));
}

} // namespace

// Two thirds of the memory to join the pieces, the rest for the rim.
Contours::Contours(const Host &host, const abacus_facts &facts, const abacus_window &window,
                   const abacus_contouring &contouring, std::size_t memory)
    : host_(host), facts_(facts), simplices_(facts.census.simplices + facts.census.ghosts),
      pacer_(host), how_(checked(facts, contouring)),
      window_(narrowed<2>(window, contouring.extent)), bounds_(window), levels_(how_),
      attribute_(&how_.attribute, 1), vertex_values_(host, facts),
      pages_(host, facts, window_.region(), pages_in<2>(how_.extent)),
      cut_(bounds_, levels_, how_.bands != 0), pieces_(host, memory / 3 * 2),
      rims_(host, bounds_, levels_, memory / 3), edges_(host) {}

void Contours::each(abacus_contour_report report, void *context) {
    read();
    how_.bands != 0 ? report_bands(report, context) : report_lines(report, context);
}

void Contours::read() {
    std::uint64_t seen = 0; // simplices
    double pieces = 0;      // at most, so far; negative: they have been counted
    const std::uint64_t total = window_.region() == nullptr ? simplices_ : 0;
    pacer_.begin(ABACUS_PHASE_SCANNING, total);
    while (pages_.advance()) {
        const Page &page = pages_.page();
        pacer_.reached(seen += static_cast<std::uint64_t>(page.simplices()));
        if (!read_values(page)) continue;
        if (pieces >= 0 && (pieces += most_pieces(page)) > few_pieces) {
            count();
            pieces = -1;
            pacer_.begin(ABACUS_PHASE_SCANNING, total);
            read_values(page);
        }
        read_page(page);
        pieces_.flush();
    }
    if (how_.bands != 0) rims_.finish(pieces_);
}

void Contours::count() {
    RangeScan<2> pages(host_, facts_, window_.region(), pages_in<2>(how_.extent));
    double chains =
        0; // at least: of each level in a triangle one, which others of its page may join
    std::uint64_t seen = 0;
    pacer_.begin(ABACUS_PHASE_SCANNING, window_.region() == nullptr ? simplices_ : 0);
    while (pages.advance()) {
        const Page &page = pages.page();
        pacer_.reached(seen += static_cast<std::uint64_t>(page.simplices()));
        if (!read_values(page)) continue;
        std::int64_t most = 0;
        each_triangle(page, [&](const std::array<int, 3> &) {
            const auto [least, greatest] = include_levels();
            most = std::max(most, greatest - least);
        });
        chains += static_cast<double>(most);
    }
    if (window_.region() != nullptr) return pieces_.expect(chains, 0);
    if (how_.bands != 0) chains *= 2; // no side joins the chains along both levels of a band
    pieces_.expect(chains, 2 * chains);
}

bool Contours::read_values(const Page &page) {
    all_ranks_ = {INT64_MAX, INT64_MIN};
    for (int v = 0; v < page.vertices(); ++v) {
        attribute_.set(0, [&](int attribute) { return vertex_values_.value(page, v, attribute); });
        values_[v] = attribute_.value(0, 0);
        if (!std::isfinite(values_[v])) {
            values_[v] = std::numeric_limits<double>::quiet_NaN();
            continue;
        }
        points_[v] = {page.point(v), page.id(v)};
        ranks_[v] = levels_.rank(values_[v]);
        all_ranks_ = {std::min(all_ranks_.least, ranks_[v]),
                      std::max(all_ranks_.greatest, ranks_[v])};
    }
    return all_ranks_.least < all_ranks_.greatest || how_.bands != 0;
}

double Contours::most_pieces(const Page &page) const {
    const double levels =
        static_cast<double>(all_ranks_.greatest) - static_cast<double>(all_ranks_.least);
    return levels > 0 ? static_cast<double>(page.simplices()) * levels : 0;
}

template <class Take> void Contours::each_triangle(const Page &page, Take take) {
    std::array<int, 3> vertices;
    std::array<double, 3> values;
    std::array<std::int64_t, 3> ranks;
    for (int triangle = 0; triangle < page.simplices(); ++triangle) {
        if (page.is_ghost(triangle)) continue;
        bool has_values = true;
        for (int i = 0; i < 3; ++i) {
            vertices[i] = page.corner(triangle, i);
            values[i] = values_[vertices[i]];
            ranks[i] = ranks_[vertices[i]];
            has_values = has_values && !std::isnan(values[i]);
        }
        if (!has_values) continue;
        if (how_.bands == 0 && ranks[0] == ranks[1] && ranks[0] == ranks[2]) continue;
        const ContourCorners corners{&points_[vertices[0]], &points_[vertices[1]],
                                     &points_[vertices[2]]};
        if (is_in<2>(how_.extent, page, triangle) && cut_.take(corners, values, ranks))
            take(vertices);
    }
}

void Contours::read_page(const Page &page) {
    if (how_.bands != 0) {
        edges_.resize(edge_slots);
        std::fill(edges_.begin(), edges_.end(), PageEdge{});
    }
    each_triangle(page, [&](const std::array<int, 3> &vertices) {
        include_levels();
        cut_.each([this](const ContourPiece &piece) { pieces_.add(piece); });
        for (int i = 0; how_.bands != 0 && i < 3; ++i)
            note_edge(vertices[i], vertices[(i + 1) % 3]);
    });
    note_rims();
}

void Contours::note_edge(int from, int to) {
    const std::size_t lesser = std::min(from, to), greater = std::max(from, to);
    for (std::size_t i = lesser * 2654435761 + greater * 40503;; ++i) {
        PageEdge &edge = edges_[i % edge_slots];
        const bool is_new = edge.from == edge.to;
        if (is_new)
            edge = {static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(to), false};
        if (is_new || (edge.from == from && edge.to == to)) return;
        if (edge.from != to || edge.to != from) continue;
        edge.has_two = true;
        return;
    }
}

/// Notes the edges that have only one triangle in the page.
void Contours::note_rims() {
    for (const PageEdge &edge : edges_)
        if (edge.from != edge.to && !edge.has_two)
            rims_.add(points_[edge.from], values_[edge.from], points_[edge.to], values_[edge.to]);
}

void Contours::report_lines(abacus_contour_report report, void *context) {
    std::int64_t id = 0;
    PathParts parts(host_);
    pieces_.each([&](std::int64_t level, bool is_closed, const Arena<Point<2>> &path) {
        if (path.size() < 2 || (is_closed && path.size() < 3)) return; // a single point
        const auto put = [&](const Arena<Point<2>> &part, bool closed) {
            report_path(report, context, ++id, levels_.level(level), closed, part);
        };
        if (const Polygon *polygon = polygon_of(how_.extent))
            parts.each(*polygon, path, is_closed, put);
        else
            put(path, is_closed);
    });
}

void Contours::report_bands(abacus_contour_report report, void *context) {
    ContourRings rings(host_);
    std::int64_t id = 0, last = 0;
    pieces_.each([&](std::int64_t band, bool, const Arena<Point<2>> &path) {
        rings.each(path, [&](const Arena<Point<2>> &ring) {
            if (id == 0 || band != last) ++id;
            last = band;
            report_path(report, context, id, levels_.level(band), true, ring);
        });
    });
}

} // namespace abacus
