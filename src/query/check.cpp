#include "query/check.hpp"

#include "delaunay/cached_conflict.hpp"
#include "keys/domain_of.hpp"
#include "query/page_simplex.hpp"

#include <cstdio>
#include <limits>

namespace abacus {

template <int D>
Check<D>::Check(const Host &host, const abacus_header &header, std::size_t cache_bytes,
                std::size_t limit)
    : host_(host), header_(header), cache_bytes_(cache_bytes), limit_(limit), memory_(host),
      domain_(domain_of<D>(header)), faults_(&memory_) {
    check_header();
    check_pages();
    // A mesh with broken pages has no topology to speak of. Where only checksums and boxes are
    // wrong, the other passes may tell what has been changed.
    const auto is_sound = [&] { return faults_.size() == contents_; };
    if (is_sound() && pages_ > 0) run("link", [&] { check_topology(); });
    if (is_sound()) run("point", [&] { check_repeated_points(); });
    if (is_sound())
        run("point",
            [&] { header.not_delaunay != 0 ? check_listed_vertices() : check_waiting_points(); });
    if (header.apart == 0) return;
    run("attributes", [&] { check_attribute_pages(); });
    if (is_sound()) run("vertex", [&] { check_attributes(); });
}

template <int D> void Check<D>::fault(const char *kind, const Key &key, const char *message) {
    if (faults_.size() >= limit_) return;
    abacus_fault fault{key, kind, {}};
    std::snprintf(fault.message, sizeof fault.message, "%s", message);
    faults_.push_back(fault);
}

template <int D> void Check<D>::fault_of_content(const char *kind, const char *message) {
    const std::size_t before = faults_.size();
    fault(kind, at_key_, message);
    contents_ += faults_.size() - before;
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
    // Every page is read twice; how many there are is known after the first time.
    const std::uint64_t total = is_counted_ ? 2 * pages_ : 0;
    if (pages % 64 == 0) host_.progress({ABACUS_PHASE_CHECKING, pages, total, pages, 0});
}

/// What need not hold of a header that can be read; the rest capi/header.cpp has seen to.
template <int D> void Check<D>::check_header() {
    const abacus_header &h = header_;
    if (D == 2 && h.simplices > 0 && h.not_delaunay == 0 &&
        h.simplices + h.ghosts + 2 != 2 * h.vertices)
        fault("euler", first_key, "Vertices, triangles and hull edges do not add up.");
}

template <int D> void Check<D>::check_pages() {
    Key expected = first_key;
    bool expecting = true; // not after a page that tells nothing
    PageScan<D> scan(host_, header_);
    while (scan.fetch()) {
        at_key_ = scan.key();
        report(++pages_);
        bool sound = false;
        run("page", [&] {
            if (!scan.parse_unsealed())
                fault_of_content("checksum", "A page has been changed since it was written.");
            sound = true;
        });
        if (sound) {
            if (!(scan.page().lower() == scan.key()))
                fault("interval", at_key_, "A page is stored under another page's key.");
            if (expecting && !(scan.page().lower() == expected))
                fault("interval", at_key_, "The pages leave out or share a part of the curve.");
            expected = scan.page().upper();
            check_page(scan.page());
        }
        expecting = sound;
    }
    is_counted_ = true;
    if (pages_ > 0 && expecting && !(expected == end_key))
        fault("interval", at_key_, "The last page does not reach the end of the curve.");
    if (simplices_ != header_.simplices || ghosts_ != header_.ghosts)
        fault("count", first_key, "The header counts other simplices than the pages hold.");
}

template <int D> void Check<D>::check_page(const PageView<D> &page) {
    page_vertices_ += static_cast<std::uint64_t>(page.vertices());
    check_simplices(page);
    for (int patch = 0; patch < page.patches(); ++patch) check_box(page, patch);
    bool has_parts = false;
    for (int i = 0; i < page.links(); ++i) has_parts = has_parts || page.link_part(i) != 0;
    if (page.has_parts() && !has_parts)
        fault("link", at_key_, "A page has room for parts of keys but none in it.");
}

template <int D> void Check<D>::check_simplices(const PageView<D> &page) {
    for (int s = 0; s < page.simplices(); ++s) {
        const bool ghost = page.is_ghost(s);
        ++(ghost ? ghosts_ : simplices_);
        const std::uint64_t code = code_of(page, s, domain_);
        // Parts are compared by the topology pass, which has to compute them.
        const Key lowest{code, 0}, highest{code, key_word_end - 1};
        if (highest < page.lower() || page.upper() <= lowest)
            fault("key", at_key_, "A simplex lies in a page that does not own its key.");
        if (!ghost && orientation<D>(corners_of(page, s)) <= 0)
            fault("orientation", at_key_, "A simplex is flat or negatively oriented.");
    }
}

template <int D> void Check<D>::check_box(const PageView<D> &page, int patch) {
    const auto simplices = page.simplices_of(patch);
    for (int axis = 0; axis < D; ++axis) {
        Column::Prefix least = std::numeric_limits<Column::Prefix>::max(), greatest = -1;
        for (int s = simplices.begin; s < simplices.end; ++s)
            for (int i = 0; i < D + !page.is_ghost(s); ++i) {
                const auto vertex = static_cast<std::size_t>(page.corner(s, i));
                const Column::Prefix prefix = page.ranks(axis).prefix_at(vertex);
                least = std::min(least, prefix);
                greatest = std::max(greatest, prefix);
            }
        if (page.patch(patch).least[axis] != least || page.patch(patch).greatest[axis] != greatest)
            fault_of_content("page",
                             "The box of a patch of simplices is not that of its vertices.");
    }
}

template <int D> void Check<D>::check_topology() {
    Reader<D> reader(host_, header_,
                     {.budget = cache_bytes_, .verify_links = true, .verify_checksums = false});
    Cache<D> &cache = reader.cache();
    OwnVertices<D> own(cache);
    Stars<D> stars(cache);
    std::uint64_t pages = 0;
    for (Key key = first_key; key < end_key;) {
        at_key_ = key;
        const Key next = cache.visit(key, [&](Handle h) {
            if (!cache.is_home(h))
                fault("key", at_key_, "A simplex lies in a page that does not own its key.");
            check_simplex(cache, h);
        });
        if (header_.not_delaunay == 0)
            own.collect(key, [&](VertexIndex v, const Arena<Handle> &star) {
                if (!stars.add(v, star))
                    fault("overlap", at_key_, "Simplices wind around a vertex or an edge twice.");
            });
        key = next;
        cache.trim();
        host_.poll();
        report(pages_ + ++pages);
    }
    if (header_.not_delaunay == 0) check_whole(stars);
}

template <int D> void Check<D>::check_whole(const Stars<D> &stars) {
    if (stars.count() != header_.vertices)
        fault("count", first_key, "The header counts other vertices than the pages hold.");
    if (stars.corners() != (D + 1) * simplices_ + D * ghosts_)
        fault("overlap", first_key, "A vertex has two separate stars.");
    else if (stars.are_wound_once() && stars.least() != 1)
        fault("overlap", first_key, "The mesh is in more than one piece.");
}

template <int D> void Check<D>::check_simplex(Cache<D> &cache, Handle h) {
    for (int i = 0; i <= D; ++i) {
        const Link link = cache.cross(h, i); // throws unless it leads to a true neighbour
        const Simplex<D> &neighbour = cache.simplex(link_simplex(link));
        const VertexIndex opposite = neighbour.vertex[link_facet(link)];
        if (opposite == infinite_vertex || header_.not_delaunay != 0) continue;
        check_empty_sphere(cache, cache.simplex(h), cache.point(opposite));
    }
}

template <int D>
void Check<D>::check_empty_sphere(const Cache<D> &cache, const Simplex<D> &s,
                                  const Point<D> &opposite) {
    switch (side_of<D>(cache, s, opposite)) {
    case Side::outside:
        break;
    case Side::vertex:
        fault("vertex", at_key_, "Two vertices have the same coordinates.");
        break;
    case Side::inside:
        if (s.is_ghost())
            fault("hull", at_key_, "The convex hull is not convex.");
        else
            fault("delaunay", at_key_, "A vertex lies inside a circumsphere.");
    }
}

template <int D> void Check<D>::check_repeated_points() {
    Reader<D> mesh(host_, header_, {.budget = cache_bytes_, .verify_checksums = false});
    RepeatedReader<D> points(host_, domain_, header_.attributes);
    std::uint64_t count = 0;
    for (; points.advance(); ++count) {
        at_key_ = points.key();
        if (!mesh.vertex_at(record_point<D>(points.record())))
            fault("point", at_key_, "A repeated point equals no vertex of the mesh.");
        if (points.serial() >= header_.serials)
            fault("count", at_key_, "A repeated point has a serial number yet to be given.");
    }
    if (count != header_.duplicates)
        fault("count", first_key, "The header counts other repeated points than there are.");
}

/// A reader goes from a page to the one with the next point; who begins with a point further on
/// might come to another one that lies between them.
template <int D> void Check<D>::check_follows(const Key &last, const Key &at) {
    abacus_page page;
    if (at == last || !host_.next(ABACUS_STAGED_PAGES, &last, page) || page.key == at) return;
    fault("point", page.key, "A page of points lies where another one has its points.");
}

template <int D> void Check<D>::check_waiting_points() {
    at_key_ = {header_.inserted, 0};
    VertexReader<D> points(host_, header_.attributes, header_.inserted, header_.staged);
    Key last = at_key_;
    while (points.advance()) {
        at_key_ = {points.sequence(), 0};
        if (points.sequence() > header_.inserted) check_follows(last, points.page_key());
        last = points.page_key();
    }
    const Key begin{header_.inserted, 0};
    abacus_page first, page;
    if (!host_.next(ABACUS_STAGED_PAGES, nullptr, first)) return;
    if (header_.inserted == header_.staged)
        fault("count", first.key, "There are points that wait, and the header counts none.");
    else if (!host_.find(ABACUS_STAGED_PAGES, begin, page) || !(page.key == first.key))
        fault("count", first.key, "There are points before the first that waits.");
    else if (host_.next(ABACUS_STAGED_PAGES, &last, page))
        fault("count", page.key, "There are points behind the last that waits.");
}

template <int D> void Check<D>::check_listed_vertices() {
    Reader<D> mesh(host_, header_, {.budget = cache_bytes_, .verify_checksums = false});
    VertexReader<D> list(host_, static_cast<unsigned>(page_attributes(header_)), 0, header_.staged);
    std::uint64_t in_pages = 0;
    // Along the curve, and those of one code by their coordinates as words: so abacus_load sorts.
    std::array<std::uint64_t, 1 + D> place{}, previous{};
    Key last = first_key;
    while (list.advance()) {
        at_key_ = {list.sequence(), 0};
        check_follows(last, list.page_key());
        last = list.page_key();
        place[0] = domain_.code(list.point());
        std::copy_n(list.record() + 1, D, place.begin() + 1);
        if (list.sequence() > 0 && place <= previous)
            fault("vertex", at_key_, "The list of vertices is not in order.");
        previous = place;
        const std::uint64_t pages = mesh.pages_with(list.record());
        if (pages == 0)
            fault("vertex", at_key_, "A vertex of the list is none of the mesh, or another one.");
        in_pages += pages;
    }
    if (in_pages != page_vertices_)
        fault("vertex", first_key, "The mesh has vertices that are not in the list.");
    abacus_page page;
    if (host_.next(ABACUS_STAGED_PAGES, &last, page))
        fault("count", page.key, "There are pages behind the list of vertices.");
}

template <int D> void Check<D>::check_attribute_pages() {
    const AttributeGroups groups(header_.attributes);
    AttributeScan<D> scan(host_, domain_, header_.attributes);
    std::array<std::uint64_t, AttributeGroups(ABACUS_MAX_ATTRIBUTES).count()> vertices{};
    while (scan.fetch()) {
        at_key_ = scan.key();
        scan.read();
        vertices[scan.group()] += scan.vertices();
    }
    for (unsigned group = 0; group < groups.count(); ++group)
        if (vertices[group] != header_.vertices)
            fault("attributes", group_begin(group),
                  "The attribute pages have another number of vertices than the mesh.");
}

/// There are as many vertices with attributes as vertices; so it is enough that each of these has
/// some.
template <int D> void Check<D>::check_attributes() {
    AttributeReader<D> attributes(host_, domain_, header_.attributes, cache_bytes_ / 2);
    PageScan<D> scan(host_, header_);
    while (scan.fetch()) {
        at_key_ = scan.key();
        scan.parse_unsealed();
        for (int v = 0; v < scan.page().vertices(); ++v)
            if (!attributes.contains(scan.page().point(v))) {
                fault("vertex", at_key_, "A vertex has no attributes.");
                break;
            }
    }
}

template class Check<2>;
template class Check<3>;

} // namespace abacus
