#include "query/check/check.hpp"

#include "keys/domain_of.hpp"
#include "labels/marker_sweep.hpp"
#include "query/check/check_threads.hpp"
#include "sort/record_sort.hpp"

#include <cmath>
#include <optional>

namespace abacus {

template <int D>
Check<D>::Check(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
                std::size_t limit)
    : host_(host), facts_(facts), cache_bytes_(cache_bytes), domain_(domain_of<D>(facts.form)),
      faults_(host, limit) {
    check_header();
    std::optional<Together> together;
    if (Together::is_worth_while(host, facts)) together.emplace(*this);
    if (!together || !together->check_pages()) check_pages();
    is_counted_ = true;
    if (counts_.simplices != facts_.census.simplices || counts_.ghosts != facts_.census.ghosts)
        faults_.add("count", first_key,
                    "The header counts more or fewer simplices than the pages hold.");
    if (counts_.fixed > 0 && facts_.standing != ABACUS_CONSTRAINED)
        faults_.add("fixed", first_key, "A mesh without lines has fixed edges.");
    const std::size_t before = faults_.size();
    check_links_and_points(together ? &*together : nullptr);
    // If two pages differ about a vertex, the cache finds that while it has both. In a convex
    // mesh it has both at some time, since all pages around a vertex are loaded together. In other
    // meshes it may not, so faults found by several threads are reported as one thread finds them.
    if (together && !abacus_is_convex(facts.standing) && faults_.size() > before) {
        faults_.shorten(before);
        check_links_and_points(nullptr);
    }
    const auto is_sound = [&] { return faults_.is_sound(); };
    const bool is_apart = facts_.columns.apart != 0;
    if (is_apart || facts_.columns.labels > 0 || facts_.census.marked > 0)
        faults_.run("attributes", [&] {
            check_attribute_pages<1>("attributes", is_apart ? facts_.columns.attributes : 0,
                                     facts_.census.vertices);
        });
    if (is_apart && is_sound()) faults_.run("vertex", [&] { check_attributes(); });
    check_labels("labels", facts_.columns.labels, facts_.census.labelled, first_group<D + 1>);
    check_labels("markers", D + 1, facts_.census.marked, marker_group);
    if (is_sound() && facts_.census.marked > 0) faults_.run("markers", [&] { check_markers(); });
}

template <int D> void Check<D>::check_links_and_points(Together *together) {
    // A mesh with broken pages has no usable topology. If only checksums and boxes are wrong, the
    // other passes may show what was changed.
    const auto is_sound = [&] { return faults_.is_sound(); };
    if (is_sound() && pages_ > 0 && (together == nullptr || !together->check_topology()))
        faults_.run("link", [&] { check_topology(); });
    if (is_sound()) faults_.run("point", [&] { check_repeated_points(); });
    if (is_sound())
        faults_.run("point", [&] {
            abacus_lists_vertices(facts_.standing) ? check_listed_vertices()
                                                   : check_waiting_points();
        });
}

template <int D> void Check<D>::report(std::uint64_t pages, unsigned threads) {
    // Every page is read twice, once more for attributes that are apart and for labels, and twice
    // more for markers. The number of pages is known after the first pass.
    const std::uint64_t passes = 2 + (facts_.columns.apart != 0 ? 1 : 0) +
                                 (facts_.census.labelled > 0 ? 1 : 0) +
                                 (facts_.census.marked > 0 ? 2 : 0);
    const std::uint64_t total = is_counted_ ? passes * pages_ : 0;
    host_.progress({ABACUS_PHASE_CHECKING, pages, total, pages, 0, threads});
}

/// Checks the facts of a readable header that need not hold; capi/header.cpp has checked the rest.
template <int D> void Check<D>::check_header() {
    const abacus_facts &h = facts_;
    if (D == 2 && h.census.simplices > 0 && abacus_is_convex(h.standing) &&
        h.census.simplices + h.census.ghosts + 2 != 2 * h.census.vertices)
        faults_.add("euler", first_key, "Vertices, triangles and hull edges do not add up.");
}

template <int D> void Check<D>::check_pages() {
    Key expected = first_key;
    bool is_expecting = true; // not after an unreadable page
    PageCheck<D> check(domain_, faults_);
    PageScan<D> scan(host_, facts_);
    pages_ = 0;
    while (scan.fetch()) {
        faults_.at = scan.key();
        report_some(++pages_);
        const bool is_read = check.read(scan.bytes(), scan.size(), page_attributes(facts_.columns));
        if (is_read) {
            if (is_expecting && !(check.page().lower() == expected))
                faults_.add("interval", "The pages leave out or share a part of the curve.");
            expected = check.page().upper();
            check.check();
        }
        is_expecting = is_read;
    }
    if (pages_ > 0 && is_expecting && !(expected == end_key))
        faults_.add("interval", "The last page does not reach the end of the curve.");
    counts_ = check.counts();
}

template <int D> void Check<D>::check_topology() {
    TopologyCheck<D> check(host_, facts_, cache_bytes_, faults_);
    std::uint64_t pages = pages_;
    check.check(first_key, end_key, [&] {
        report_some(++pages);
        return true;
    });
    if (abacus_is_convex(facts_.standing)) check_stars(check.stars().counts());
}

template <int D> void Check<D>::check_stars(const StarCounts &stars) {
    if (stars.count != facts_.census.vertices) faults_.add("count", first_key, other_vertex_count);
    if (stars.corners != (D + 1) * counts_.simplices + D * counts_.ghosts)
        faults_.add("overlap", first_key, "A vertex has two separate stars.");
    else if (stars.are_wound_once && stars.least != 1)
        faults_.add("overlap", first_key, "The mesh is in more than one piece.");
}

template <int D> void Check<D>::check_repeated_points() {
    Reader<D> mesh(host_, facts_, {.budget = cache_bytes_, .verify_checksums = false});
    RepeatedReader<D> points(host_, domain_, facts_.columns.attributes);
    std::uint64_t count = 0;
    for (; points.advance(); ++count) {
        faults_.at = points.key();
        if (!mesh.vertex_at(record_point<D>(points.record())))
            faults_.add("point", "A repeated point equals no vertex of the mesh.");
        if (points.serial() >= facts_.census.serials)
            faults_.add("count",
                        "A repeated point has a serial number that has not been assigned yet.");
    }
    if (count != facts_.census.duplicates)
        faults_.add("count", first_key,
                    "The header counts more or fewer repeated points than there are.");
}

/// A reader goes from a page to the one with the next point. A page between them would mislead a
/// reader that begins with a later point.
template <int D> void Check<D>::check_follows(const Key &last, const Key &at) {
    abacus_page page;
    if (at == last || !host_.next(ABACUS_STAGED_PAGES, &last, page) || page.key == at) return;
    faults_.add("point", page.key, "A page of points lies among the points of another page.");
}

template <int D> void Check<D>::check_waiting_points() {
    faults_.at = {facts_.census.inserted, 0};
    VertexReader<D> points(host_, facts_.columns.attributes, facts_.census.inserted,
                           facts_.census.staged);
    Key last = faults_.at;
    while (points.advance()) {
        faults_.at = {points.sequence(), 0};
        if (points.sequence() > facts_.census.inserted) check_follows(last, points.page_key());
        last = points.page_key();
    }
    const Key begin{facts_.census.inserted, 0};
    abacus_page first, page;
    if (!host_.next(ABACUS_STAGED_PAGES, nullptr, first)) return;
    if (facts_.census.inserted == facts_.census.staged)
        faults_.add("count", first.key, "There are points that wait, but the header counts none.");
    else if (!host_.find(ABACUS_STAGED_PAGES, begin, page) || !(page.key == first.key))
        faults_.add("count", first.key, "There are points before the first that waits.");
    else if (host_.next(ABACUS_STAGED_PAGES, &last, page))
        faults_.add("count", page.key, "There are points after the last that waits.");
}

template <int D> void Check<D>::check_listed_vertices() {
    Reader<D> mesh(host_, facts_, {.budget = cache_bytes_, .verify_checksums = false});
    VertexReader<D> list(host_, static_cast<unsigned>(page_attributes(facts_.columns)), 0,
                         facts_.census.staged);
    std::uint64_t in_pages = 0;
    // In the order of abacus_load: along the curve; with equal codes by their coordinates as words;
    // at one place by their ids.
    std::array<std::uint64_t, 1 + D> place{}, previous{};
    std::int64_t previous_id = 0;
    std::uint64_t split = 0, at_place = 0;
    Key last = first_key;
    while (list.advance()) {
        faults_.at = {list.sequence(), 0};
        check_follows(last, list.page_key());
        last = list.page_key();
        place[0] = domain_.code(list.point());
        std::copy_n(list.record() + 1, D, place.begin() + 1);
        const std::int64_t id = record_id(list.record());
        const bool shares = list.sequence() > 0 && place == previous;
        if (list.sequence() > 0 &&
            (shares ? facts_.census.split == 0 || id <= previous_id : place < previous))
            faults_.add("vertex", "The list of vertices is not in order.");
        at_place = shares ? at_place + 1 : 1;
        if (at_place > 1) split += at_place == 2 ? 2 : 1;
        previous = place;
        previous_id = id;
        const std::uint64_t pages = mesh.pages_with(list.record());
        if (pages == 0)
            faults_.add(
                "vertex",
                "A vertex of the list is not in the mesh, or differs from the vertex there.");
        in_pages += pages;
    }
    if (in_pages != counts_.vertices)
        faults_.add("vertex", first_key, "The mesh has vertices that are not in the list.");
    if (split != facts_.census.split)
        faults_.add(
            "count", first_key,
            "The header counts more or fewer vertices that share their places than there are.");
    abacus_page page;
    if (host_.next(ABACUS_STAGED_PAGES, &last, page))
        faults_.add("count", page.key, "There are pages after the list of vertices.");
}

template <int D>
template <int K>
void Check<D>::check_attribute_pages(const char *kind, unsigned attributes, std::uint64_t owners,
                                     unsigned first) {
    const AttributeGroups groups(attributes);
    AttributeScan<D, K> scan(host_, domain_, attributes, first);
    std::array<std::uint64_t, AttributeGroups(ABACUS_MAX_NAMES).count()> rows{};
    while (scan.fetch()) {
        faults_.at = scan.key();
        scan.read();
        rows[scan.group()] += scan.page().rows();
    }
    for (unsigned group = 0; group < groups.count(); ++group)
        if (rows[group] != owners)
            faults_.add(kind, group_begin(first + group),
                        K == 1 ? "The attribute pages have more or fewer vertices than the mesh."
                               : "The pages have more or fewer simplices than the header counts.");
}

/// There are as many vertices with attributes as vertices, so it is enough that each vertex has
/// some.
template <int D> void Check<D>::check_attributes() {
    AttributeReader<D> attributes(host_, domain_, facts_.columns.attributes, cache_bytes_ / 2);
    PageScan<D> scan(host_, facts_);
    PageView<D> page;
    std::uint64_t pages = passes_++ * pages_;
    while (scan.fetch()) {
        faults_.at = scan.key();
        report_some(++pages);
        page.read(scan.bytes(), scan.size(), page_attributes(facts_.columns),
                  PageView<D>::Checksum::ignore);
        for (int v = 0; v < page.vertices(); ++v)
            if (!attributes.contains(page.point(v))) {
                faults_.add("vertex", "A vertex has no attributes.");
                break;
            }
    }
}

/// A simplex has at most one row. So if as many simplices have rows as there are rows, every row
/// belongs to a simplex of the mesh.
template <int D>
void Check<D>::check_labels(const char *kind, unsigned columns, std::uint64_t owners,
                            unsigned first) {
    faults_.run(kind, [&] { check_attribute_pages<D + 1>(kind, columns, owners, first); });
    if (!faults_.is_sound() || owners == 0) return;
    faults_.run(kind, [&] {
        faults_.at = group_begin(first);
        AttributeReader<D, D + 1> labels(host_, domain_, columns, cache_bytes_ / 2, first);
        std::uint64_t found = 0;
        each_simplex([&](const PageView<D> &page, int s) {
            if (page.is_ghost(s)) return;
            std::array<Point<D>, D + 1> points;
            for (int i = 0; i <= D; ++i) points[i] = page.point(page.corner(s, i));
            found += labels.contains(owner_of<D, D + 1>(points));
        });
        if (found != owners)
            faults_.add(kind, group_begin(first),
                        "Some belong to simplices that the mesh does not have.");
    });
}

/// A facet has the same marker on both sides, or lies on the boundary: a ghost is beyond it. The
/// two sides of a fault both lie on the boundary, and have markers of their own.
template <int D> void Check<D>::check_markers() {
    constexpr std::size_t key_words = 2 + D * D; // key, coordinates; then the marker
    RecordSort sides(host_, key_words + 1, key_words, cache_bytes_ / 4);
    const auto add = [&](const Owner<D, D> &facet, double marker) {
        const Key key = attribute_key<D, D>(facet, code_of<D, D>(domain_, facet));
        std::uint64_t *const record = sides.add();
        record[0] = key.code;
        record[1] = key.part;
        std::memcpy(record + 2, facet.data(), sizeof facet);
        record[key_words] = std::bit_cast<std::uint64_t>(marker);
    };
    AttributeScan<D, D + 1> scan(host_, domain_, D + 1, marker_group);
    while (scan.fetch()) {
        scan.read();
        for (std::size_t row = 0; row < scan.page().rows(); ++row)
            for (int i = 0; i <= D; ++i)
                if (const double marker = scan.page().value(row, static_cast<unsigned>(i));
                    has_marker(marker))
                    add(facet_of<D>(scan.page().owner(row), i), marker);
    }
    each_simplex([&](const PageView<D> &page, int s) {
        if (!page.is_ghost(s)) return;
        std::array<Point<D>, D> points;
        for (int i = 0; i < D; ++i) points[i] = page.point(page.corner(s, i));
        add(owner_of<D, D>(points), null_value);
    });
    sides.finish();
    std::array<std::uint64_t, key_words + 1> first{};
    std::uint64_t ghosts = 0, marked = 0; // at the facet of the first
    bool agree = true;
    const auto end_facet = [&] {
        const std::uint64_t sides_of_boundary = facts_.census.split > 0 && ghosts == 2 ? 2 : 1;
        const bool is_sound = ghosts == 0 ? marked == 0 || (marked == 2 && agree)
                                          : ghosts <= sides_of_boundary && marked <= ghosts;
        if (!is_sound)
            faults_.add("markers", in_group({first[0], first[1]}, marker_group),
                        "The two sides of a facet have different markers.");
    };
    while (const std::uint64_t *record = sides.next()) {
        const auto marker = std::bit_cast<double>(record[key_words]);
        if (ghosts + marked == 0 || !std::equal(record, record + key_words, first.begin())) {
            end_facet();
            std::copy_n(record, key_words, first.begin());
            first[key_words] = std::bit_cast<std::uint64_t>(null_value);
            ghosts = marked = 0;
            agree = true;
        }
        if (std::isnan(marker)) {
            ++ghosts;
            continue;
        }
        const auto before = std::bit_cast<double>(first[key_words]);
        agree = agree && (std::isnan(before) || before == marker);
        first[key_words] = record[key_words];
        ++marked;
    }
    end_facet();
    sides.close();
}

template class Check<2>;
template class Check<3>;

} // namespace abacus
