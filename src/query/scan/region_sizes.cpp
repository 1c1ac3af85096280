#include "query/scan/region_sizes.hpp"

#include "geometry/box.hpp"
#include "geometry/exact_sum.hpp"
#include "geometry/ordered.hpp"

namespace abacus {

namespace {

// Triangles of a region in a page: the region, 0, how many. An edge of its border: the region, 1,
// 0, both ends with the region on the left.
enum Kind : std::uint64_t { are_triangles, is_edge };
constexpr std::size_t size_words = 7, size_key = 2;

/// Adds the border's edges of a triangle in a region.
void add_border_edges(Cache<2> &cache, Handle h, RecordSort &sort) {
    const RegionNumber region = cache.region(h);
    for (int i = 0; i < 3; ++i) {
        if (!cache.is_fixed(make_link(h, i)) ||
            cache.region(link_simplex(cache.cross(h, i))) == region)
            continue;
        const auto &vertex = cache.simplex(h).vertex;
        std::uint64_t *const record = sort.add();
        record[0] = region;
        record[1] = is_edge;
        record[2] = 0;
        put_ordered(record + 3, cache.point(vertex[(i + 1) % 3]));
        put_ordered(record + 5, cache.point(vertex[(i + 2) % 3]));
    }
}

void collect_sizes(Reader<2> &reader, RecordSort &sort) {
    Cache<2> &cache = reader.cache();
    RegionNumber region = no_region;
    std::uint64_t triangles = 0;
    const auto end_run = [&] {
        if (region == no_region || triangles == 0) return;
        std::uint64_t *const record = sort.add();
        std::fill_n(record, size_words, 0);
        record[0] = region;
        record[2] = triangles;
        triangles = 0;
    };
    for (Key page = first_key; page < end_key;) {
        cache.trim();
        cache.poll();
        page = cache.visit(page, [&](Handle h) {
            const RegionNumber here = cache.region(h);
            if (here == no_region) return;
            if (here != region) end_run();
            region = here;
            ++triangles;
            add_border_edges(cache, h, sort);
        });
    }
    end_run();
}

} // namespace

void region_sizes(Reader<2> &reader, std::size_t memory,
                  const std::function<void(const abacus_region_size &)> &visit) {
    RecordSort sort(reader.cache().host(), size_words, size_key, memory);
    if (!reader.is_empty()) collect_sizes(reader, sort);
    sort.finish();
    abacus_region_size size{};
    WideSum area;
    Box<2> box;
    const auto end_region = [&] {
        if (size.region == no_region) return;
        size.area = area.value();
        std::copy_n(box.lower.begin(), 2, size.lower);
        std::copy_n(box.upper.begin(), 2, size.upper);
        visit(size);
    };
    while (const std::uint64_t *const record = sort.next()) {
        if (record[0] != size.region) {
            end_region();
            size = {};
            size.region = static_cast<RegionNumber>(record[0]);
            area = {};
            box = {};
        }
        if (record[1] == are_triangles) {
            size.triangles += record[2];
            continue;
        }
        ++size.edges;
        const Point<2> a = point_from_ordered<2>(record + 3), b = point_from_ordered<2>(record + 5);
        box.extend(a); // each vertex begins an edge
        add_product(area, a[0], b[1], -1);
        add_product(area, -b[0], a[1], -1);
    }
    end_region();
    sort.close();
}

} // namespace abacus
