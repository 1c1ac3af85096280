#include "query/check.hpp"

#include "cache/domain_of.hpp"
#include "delaunay/conflict.hpp"

#include <bit>
#include <cstdio>

namespace abacus {

template <int D>
Check<D>::Check(const Host &host, const abacus_header &header, std::size_t cache_bytes,
                std::size_t limit)
    : host_(host), header_(header), cache_bytes_(cache_bytes), limit_(limit), memory_(host),
      domain_(domain_of<D>(header)), faults_(&memory_) {
    run("page", [&] { check_pages(); });
    // A mesh with broken pages has no topology to speak of.
    if (faults_.empty() && pages_ > 0) run("link", [&] { check_topology(); });
    if (faults_.empty()) run("point", [&] { check_points(); });
}

template <int D> void Check<D>::fault(const char *kind, const Key &key, const char *message) {
    if (faults_.size() >= limit_) return;
    abacus_fault fault{key, kind, {}};
    std::snprintf(fault.message, sizeof fault.message, "%s", message);
    faults_.push_back(fault);
}

template <int D> template <class Pass> void Check<D>::run(const char *kind, Pass pass) {
    try {
        pass();
    } catch (const Error &error) {
        if (error.kind != ABACUS_ERROR_CORRUPTED) throw;
        fault(kind, at_key_, error.detail.c_str());
    }
}

template <int D> void Check<D>::report(std::uint64_t pages) {
    if (pages % 64 == 0) host_.progress({ABACUS_PHASE_CHECKING, pages, pages_, pages, 0});
}

template <int D> void Check<D>::check_pages() {
    Key expected = first_key;
    PageScan<D> scan(host_, header_.attributes);
    for (;;) {
        bool more = false;
        run("page", [&] { more = scan.advance(); });
        if (!more) break;
        at_key_ = scan.key();
        report(++pages_);
        if (!(scan.page().lower() == scan.key()))
            fault("interval", at_key_, "A page is stored under another page's key.");
        if (!(scan.page().lower() == expected))
            fault("interval", at_key_, "The pages leave out or share a part of the curve.");
        expected = scan.page().upper();
        check_page(scan.page());
    }
    if (pages_ > 0 && faults_.empty() && !(expected == end_key))
        fault("interval", at_key_, "The last page does not reach the end of the curve.");
    if (simplices_ != header_.simplices || ghosts_ != header_.ghosts)
        fault("count", first_key, "The header counts other simplices than the pages hold.");
}

template <int D> void Check<D>::check_page(const PageView<D> &page) {
    for (int s = 0; s < page.simplices(); ++s) {
        const bool ghost = page.is_ghost(s);
        ++(ghost ? ghosts_ : simplices_);
        std::array<Point<D>, D + 1> points;
        std::array<Cell<D>, D + 1> cells;
        std::array<const Cell<D> *, D + 1> cell;
        Corners<D> corners;
        for (int i = 0; i < D + !ghost; ++i) {
            points[i] = page.point(page.corner(s, i));
            cells[i] = domain_.cell(points[i]);
            cell[i] = &cells[i];
            corners[i] = &points[i];
        }
        const std::uint64_t code = simplex_code<D>(cell, ghost);
        // Parts are compared by the topology pass, when a neighbour looks for its key.
        if (code < page.lower().code || page.upper() <= Key{code, 0})
            if (code != page.upper().code || page.upper().part == 0)
                fault("key", at_key_, "A simplex lies in a page that does not own its key.");
        if (!ghost && orientation<D>(corners) <= 0)
            fault("orientation", at_key_, "A simplex is flat or negatively oriented.");
    }
}

template <int D> void Check<D>::check_topology() {
    Reader<D> reader(host_, header_, cache_bytes_, true);
    Cache<D> &cache = reader.cache();
    std::uint64_t pages = 0;
    for (Key key = first_key; key < end_key;) {
        at_key_ = key;
        key = cache.visit(key, [&](Handle h) { check_simplex(cache, h); });
        cache.trim();
        host_.poll();
        report(++pages);
    }
}

template <int D> void Check<D>::check_simplex(Cache<D> &cache, Handle h) {
    for (int i = 0; i <= D; ++i) {
        const Link link = cache.cross(h, i); // throws unless it leads to a true neighbour
        const Simplex<D> &neighbour = cache.simplex(link_simplex(link));
        const VertexIndex opposite = neighbour.vertex[link_facet(link)];
        if (opposite == infinite_vertex) continue;
        const Simplex<D> &s = cache.simplex(h);
        switch (side_of<D>(cache, s, cache.point(opposite))) {
        case Side::outside: break;
        case Side::vertex:
            fault("vertex", at_key_, "Two vertices have the same coordinates.");
            break;
        case Side::inside:
            if (s.is_ghost()) fault("hull", at_key_, "The convex hull is not convex.");
            else fault("delaunay", at_key_, "A vertex lies inside a circumsphere.");
        }
    }
}

template <int D> void Check<D>::check_points() {
    if (header_.inserted > header_.points ||
        header_.vertices + header_.duplicates != header_.inserted)
        fault("count", first_key, "The header counts more or fewer vertices than points.");
    if (D == 2 && header_.simplices > 0 &&
        header_.simplices + header_.ghosts + 2 != 2 * header_.vertices)
        fault("euler", first_key, "Vertices, triangles and hull edges do not add up.");
    if ((header_.simplices == 0) != (pages_ == 0))
        fault("count", first_key, "A mesh without simplices has pages, or the other way round.");

    Reader<D> mesh(host_, header_, cache_bytes_);
    VertexReader<D> points(host_, header_.attributes, 0, header_.points);
    std::pmr::vector<double> values(header_.attributes, &memory_);
    Point<D> previous{};
    while (points.advance()) {
        const std::uint64_t sequence = points.sequence();
        at_key_ = {sequence, 0};
        const Point<D> p = points.point();
        if (header_.simplices == 0 || sequence >= header_.inserted) continue;
        const bool repeated = sequence > 0 && previous == p;
        previous = p;
        if (repeated) continue;
        const auto vertex = mesh.vertex_at(p);
        if (!vertex) {
            fault("point", at_key_, "An inserted point is no vertex of the mesh.");
            continue;
        }
        // Later batches may repeat a point under another id.
        if (sequence >= header_.first_batch) continue;
        points.attributes(values.data());
        bool same = vertex->id == points.id();
        for (std::size_t i = 0; i < values.size(); ++i)
            same = same && std::bit_cast<std::uint64_t>(values[i]) ==
                               std::bit_cast<std::uint64_t>(vertex->attributes[i]);
        if (!same) fault("vertex", at_key_, "A vertex has another id or attribute than its point.");
    }
}

template class Check<2>;

} // namespace abacus
