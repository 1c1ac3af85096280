#include "query/levels/isosurface.hpp"

#include "blocks/bit_column.hpp"
#include "geometry/tetrahedron_cut.hpp"

#include <bit>
#include <cmath>

namespace abacus {

namespace {

constexpr unsigned number_bits = 16; // of a corner in its page
// Two triangles, and four corners: their names, coordinates and a value.
constexpr double most_bytes_a_simplex = 8.0 * (2 + 4 * (9 + 4));
constexpr std::uint64_t number_mask = (std::uint64_t{1} << number_bits) - 1;

} // namespace

Isosurface::Isosurface(const Host &host, const abacus_facts &facts,
                       const abacus_isosurface_query &query, std::size_t memory)
    : query_(query), is_split_(facts.census.split > 0), host_(host), facts_(facts),
      filter_(query.window, query.extent), vertex_values_(host, facts), pacer_(host), edges_(host),
      numbers_(host, facts.census.split > 0 ? 8 : 6, memory), pages_made_(host, 1),
      corners_(host, query.carried >= 0 ? 4 : 3), triangles_(host, 1), corners_here_(host) {
    if (!host.spool_fits(most_bytes_a_simplex * static_cast<double>(facts.census.simplices)))
        count();
    scan();
    numbers_.finish();
    pages_made_.rewind();
    corners_.rewind();
    triangles_.rewind();
}

// ---- From pages to spools -----------------------------------------------------------------

template <class End> void Isosurface::each_page(End end_page) {
    std::uint64_t seen = 0; // simplices
    pacer_.begin(ABACUS_PHASE_SCANNING,
                 filter_.region() == nullptr ? facts_.census.simplices + facts_.census.ghosts : 0);
    RangeScan<3> pages(host_, facts_, filter_.region(), [&](const PageView<3> &page) {
        pacer_.reached(seen += static_cast<std::uint64_t>(page.simplices()));
        return vertex_values_.may_have(page, static_cast<int>(query_.attribute), query_.value,
                                       query_.value);
    });
    while (pages.advance()) {
        triangles_here_ = 0;
        edges_.clear();
        take(pages.page());
        end_page();
    }
}

void Isosurface::scan() {
    each_page([this] {
        if (triangles_here_ > 0) *pages_made_.add() = edges_.size() << 32 | triangles_here_;
    });
}

void Isosurface::count() {
    double corners = 0, triangles = 0;
    only_counts_ = true;
    each_page([&] {
        corners += static_cast<double>(edges_.size());
        triangles += static_cast<double>(triangles_here_);
    });
    only_counts_ = false;
    host_.spool_expect(numbers_.spool_bytes(corners) + corners_.spool_bytes(corners) +
                       triangles_.spool_bytes(triangles));
}

void Isosurface::take(const PageView<3> &page) {
    for (int v = 0; v < page.vertices(); ++v) {
        const double value = vertex_values_.value(page, v, static_cast<int>(query_.attribute));
        sides_[v] = !std::isfinite(value)  ? Side::nowhere
                    : value < query_.value ? Side::below
                                           : Side::above;
    }
    for (int s = 0; s < page.simplices(); ++s)
        if (!page.is_ghost(s)) cut(page, s);
}

void Isosurface::cut(const PageView<3> &page, int simplex) {
    unsigned above = 0;
    for (int i = 0; i < 4; ++i) {
        const Side side = sides_[page.corner(simplex, i)];
        if (side == Side::nowhere) return;
        above |= static_cast<unsigned>(side == Side::above) << i;
    }
    const TetrahedronCut &cut = tetrahedron_cuts[above];
    if (cut.corners == 0 || !filter_.wants(page, simplex)) return;
    std::size_t corners[4];
    for (int i = 0; i < cut.corners; ++i)
        corners[i] = corner(page, page.corner(simplex, cut.edge[i].below),
                            page.corner(simplex, cut.edge[i].above));
    if (cut.corners == 3) {
        add_triangle(corners[0], corners[1], corners[2]);
        return;
    }
    // The edges of the first and the third corner share no vertex, nor do those of the others. The
    // quadrilateral is divided from the corner between the lesser vertices on both sides.
    const auto is_less = [&](int i, int j) {
        return page.point(page.corner(simplex, i)) < page.point(page.corner(simplex, j));
    };
    const bool from_first = is_less(cut.edge[0].below, cut.edge[2].below) ==
                            is_less(cut.edge[0].above, cut.edge[2].above);
    const int first = from_first ? 0 : 1;
    add_triangle(corners[first], corners[first + 1], corners[first + 2]);
    add_triangle(corners[first], corners[first + 2], corners[(first + 3) % 4]);
}

/// The number of a corner in the page.
std::size_t Isosurface::corner(const PageView<3> &page, int below, int above) {
    const std::size_t known = edges_.size();
    const std::size_t number = edges_.number(below, above);
    if (number < known || only_counts_) return number;
    const bool is_turned = page.point(above) < page.point(below);
    const int from = is_turned ? above : below, to = is_turned ? below : above;
    const auto attribute = static_cast<int>(query_.attribute);
    const double share = share_at(query_.value, vertex_values_.value(page, from, attribute),
                                  vertex_values_.value(page, to, attribute));
    std::uint64_t *word = numbers_.add(); // by the ends of the edge
    for (const int end : {from, to})
        for (const double x : page.point(end)) *word++ = ordered(x);
    if (is_split_) // an edge on each side of a fault
        for (const int end : {from, to}) *word++ = static_cast<std::uint64_t>(page.id(end));
    word = corners_.add();
    for (const double x : point_between(page.point(from), page.point(to), share))
        *word++ = std::bit_cast<std::uint64_t>(x);
    if (query_.carried >= 0)
        *word = std::bit_cast<std::uint64_t>(
            value_between(vertex_values_.value(page, from, query_.carried),
                          vertex_values_.value(page, to, query_.carried), share));
    return number;
}

void Isosurface::add_triangle(std::size_t a, std::size_t b, std::size_t c) {
    ++triangles_here_;
    if (!only_counts_) *triangles_.add() = a << 2 * number_bits | b << number_bits | c;
}

// ---- From spools to triangles -------------------------------------------------------------

bool Isosurface::read_page() {
    const std::uint64_t *page = pages_made_.next();
    if (page == nullptr) return false;
    triangles_here_ = *page & 0xffffffff;
    corners_here_.resize(*page >> 32);
    for (Corner &corner : corners_here_) {
        const std::uint64_t *word = corners_.next();
        for (double &x : corner.point) x = std::bit_cast<double>(*word++);
        corner.value = query_.carried >= 0 ? std::bit_cast<double>(*word) : NAN;
        corner.number = static_cast<std::int64_t>(numbers_.next());
    }
    return true;
}

void Isosurface::read(abacus_surface_triangle &triangle) {
    const std::uint64_t word = *triangles_.next();
    const Corner *corners[3] = {&corners_here_[word >> 2 * number_bits],
                                &corners_here_[word >> number_bits & number_mask],
                                &corners_here_[word & number_mask]};
    int first = 0;
    for (int i = 1; i < 3; ++i)
        if (corners[i]->number < corners[first]->number) first = i;
    for (int i = 0; i < 3; ++i) {
        const Corner &corner = *corners[(first + i) % 3];
        triangle.corner[i] = corner.number;
        std::copy_n(corner.point.begin(), 3, triangle.point[i]);
        triangle.value[i] = corner.value;
    }
}

void Isosurface::close() {
    pages_made_.close();
    corners_.close();
    triangles_.close();
    numbers_.close();
}

} // namespace abacus
