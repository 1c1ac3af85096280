#include "query/check/region_check.hpp"

#include "constrain/outline_sides.hpp"
#include "query/locate/edges_along.hpp"
#include "query/scan/region_sizes.hpp"

#include <algorithm>

namespace abacus {

namespace {

constexpr std::size_t edge_words = 4;

// A face with its region, its name, and whether it comes from a seed (0) or an edge (1).
constexpr std::size_t face_words = 1 + edge_words + 1;

void put_edge(std::uint64_t *words, const Faces::Edge &edge) {
    put_ordered(words, edge.from);
    put_ordered(words + 2, edge.to);
}
Faces::Edge edge_at(const std::uint64_t *words) {
    return {point_from_ordered<2>(words), point_from_ordered<2>(words + 2)};
}
void add_face(RecordSort &faces, RegionNumber region, const Faces::Edge &name, bool is_edge) {
    std::uint64_t *const record = faces.add();
    record[0] = region;
    put_edge(record + 1, name);
    record[face_words - 1] = is_edge;
}

Faces::Access access_to(Reader<2> &reader) {
    return {[&reader](const Point<2> &p) {
                const std::optional<Link> corner = corner_at(reader, p);
                if (!corner) throw_corrupted("A fixed edge ends where no vertex is.");
                return *corner;
            },
            [&reader] { reader.cache().trim(); }};
}

} // namespace

RegionCheck::RegionCheck(Reader<2> &reader, std::size_t memory)
    : reader_(reader), cache_(reader.cache()), memory_(memory / 4),
      faces_(cache_, access_to(reader)), seeded_(cache_.host()) {}

RegionNumber RegionCheck::find_wrong(RegionParts &parts) {
    const RegionNumber wrong = check_outlines(parts);
    return wrong != no_region ? wrong : check_seeds(parts);
}

RegionNumber RegionCheck::region_beside(const Point<2> &from, const Point<2> &to) {
    const std::optional<Link> corner = corner_at(reader_, from);
    const Way way = corner ? straight_on(cache_, *corner, to) : Way{};
    if (way.triangle == no_handle) throw_corrupted("An outline of a region is not an edge.");
    const RegionNumber region = cache_.region(way.triangle);
    cache_.trim();
    return region;
}

RegionNumber RegionCheck::check_outlines(RegionParts &parts) {
    OutlineSides sides(cache_.host(), memory_);
    RegionNumber wrong = no_region;
    parts.each(
        [&](RegionNumber region, const Point<2> &a, const Point<2> &b) {
            cache_.poll();
            if (!edges_along(reader_, a, b, [&](VertexIndex v, VertexIndex w, Fixed) {
                    sides.add(region, cache_.point(v), cache_.point(w));
                }))
                wrong = region;
            cache_.trim();
        },
        [](RegionNumber, const Point<2> &) {});
    RecordSpool borders(cache_.host(), 2); // of regions in order: edges on the border
    region_sizes(reader_, memory_, [&](const abacus_region_size &size) {
        std::uint64_t *const record = borders.add();
        record[0] = size.region;
        record[1] = size.edges;
    });
    borders.rewind();
    const std::uint64_t *border = borders.next();
    std::optional<Point<2>> open;
    while (wrong == no_region) {
        std::uint64_t edges = 0;
        RegionNumber left = no_region;
        bool are_right = true;
        const RegionNumber region = sides.next(
            [&](const Point<2> &from, const Point<2> &to) {
                if (edges == 0) left = region_beside(from, to);
                are_right =
                    are_right && region_beside(from, to) == left && region_beside(to, from) != left;
                if (++edges % 1024 == 0) cache_.poll();
            },
            open);
        if (region == no_region) break;
        while (border != nullptr && border[0] < region) border = borders.next();
        if (open || !are_right || left != region || border == nullptr || border[0] != region ||
            border[1] != edges)
            wrong = region;
    }
    sides.close();
    borders.close();
    return wrong;
}

RegionNumber RegionCheck::check_seeds(RegionParts &parts) {
    RecordSort faces(cache_.host(), face_words, face_words, memory_);
    RegionNumber wrong = no_region;
    parts.each([](RegionNumber, const Point<2> &, const Point<2> &) {},
               [&](RegionNumber region, const Point<2> &p) {
                   if (wrong != no_region) return;
                   cache_.poll();
                   const Handle h = reader_.simplex_around(p);
                   std::optional<Faces::Edge> name;
                   if (h != no_handle && cache_.region(h) == region) name = faces_.name(h);
                   if (name)
                       add_face(faces, region, *name, false);
                   else
                       wrong = region;
                   if (seeded_.empty() || seeded_.back() != region) seeded_.push_back(region);
                   cache_.trim();
               });
    if (wrong == no_region && !seeded_.empty()) {
        RecordSort edges(cache_.host(), edge_words + 1, edge_words, memory_);
        collect_edges(edges);
        wrong = add_faces(edges, faces);
        edges.close();
        if (wrong == no_region) wrong = first_without_seed(faces);
    }
    faces.close();
    return wrong;
}

void RegionCheck::collect_edges(RecordSort &edges) {
    for (Key page = first_key; page < end_key;) {
        cache_.trim();
        cache_.poll();
        page = cache_.visit(page, [&](Handle h) {
            const RegionNumber region = cache_.region(h);
            if (region == no_region || !std::binary_search(seeded_.begin(), seeded_.end(), region))
                return;
            for (int i = 0; i < 3; ++i) {
                if (!cache_.is_fixed(make_link(h, i))) continue;
                const auto &vertex = cache_.simplex(h).vertex;
                std::uint64_t *const record = edges.add();
                put_edge(record,
                         {cache_.point(vertex[(i + 1) % 3]), cache_.point(vertex[(i + 2) % 3])});
                record[edge_words] = region;
            }
        });
    }
}

RegionNumber RegionCheck::add_faces(RecordSort &edges, RecordSort &faces) {
    const std::size_t at_once = std::max<std::size_t>(memory_ / 64, 1024);
    Arena<RegionNumber> regions(cache_.host());
    edges.finish();
    const std::uint64_t *record = edges.next();
    while (record != nullptr) {
        faces_.clear();
        regions.clear();
        for (; record != nullptr && regions.size() < at_once; record = edges.next()) {
            faces_.add(edge_at(record));
            regions.push_back(static_cast<RegionNumber>(record[edge_words]));
        }
        for (std::size_t i = 0; i < regions.size(); ++i) {
            const auto name = faces_.name(faces_[i]);
            if (!name) return regions[i];
            add_face(faces, regions[i], *name, true);
            cache_.trim();
        }
    }
    return no_region;
}

RegionNumber RegionCheck::first_without_seed(RecordSort &faces) {
    std::array<std::uint64_t, face_words - 1> seeded{}; // the last face that has a seed
    faces.finish();
    while (const std::uint64_t *const record = faces.next()) {
        if (record[face_words - 1] == 0)
            std::copy_n(record, seeded.size(), seeded.begin());
        else if (!std::equal(seeded.begin(), seeded.end(), record))
            return static_cast<RegionNumber>(record[0]);
    }
    return no_region;
}

} // namespace abacus
