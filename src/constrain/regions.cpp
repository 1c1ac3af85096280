#include "constrain/regions.hpp"

#include "geometry/ordered.hpp"

namespace abacus {

Regions::Regions(Delaunay<2> &mesh, std::size_t memory)
    : mesh_(mesh), cache_(mesh.cache()), flood_(mesh), memory_(memory / 2),
      touching_(cache_.host(), memory / 4) {}

bool Regions::fill(RegionParts &parts, const Report &report, abacus_region_fault &fault) {
    if (!fill_outlines(parts, report, fault)) return false;
    bool is_sound = true;
    parts.each([](RegionNumber, const Point<2> &, const Point<2> &) {},
               [&](RegionNumber region, const Point<2> &p) {
                   is_sound = is_sound && fill_seed(region, p, report, fault);
               });
    return is_sound;
}

bool Regions::fill_outlines(RegionParts &parts, const Report &report, abacus_region_fault &fault) {
    OutlineSides sides(cache_.host(), memory_);
    parts.each(
        [&](RegionNumber region, const Point<2> &a, const Point<2> &b) {
            each_edge_on(mesh_, a, b, [&](Link edge) {
                const auto &vertex = cache_.simplex(link_simplex(edge)).vertex;
                sides.add(region, cache_.point(vertex[(link_facet(edge) + 1) % 3]),
                          cache_.point(vertex[(link_facet(edge) + 2) % 3]));
            });
        },
        [](RegionNumber, const Point<2> &) {});
    std::optional<Point<2>> open;
    bool is_sound = true;
    while (is_sound) {
        edges_.emplace(cache_.host(), 4);
        Box<2> box;
        const RegionNumber region = sides.next(
            [&](const Point<2> &from, const Point<2> &to) {
                std::uint64_t *const record = edges_->add();
                put_ordered(record, from);
                put_ordered(record + 2, to);
                box.extend(from);
                box.extend(to);
            },
            open);
        if (region == no_region) break;
        if (open) fault = region_fault(ABACUS_REGION_OPEN, region, no_region, *open);
        is_sound = !open && flood_outline(region, fault);
        if (is_sound) report(region, box);
        edges_->close();
    }
    edges_.reset();
    sides.close();
    return is_sound;
}

bool Regions::flood_outline(RegionNumber region, abacus_region_fault &fault) {
    touching_.begin();
    flood_.begin(RegionFlood::Rule::outline, region, &touching_);
    bool is_any = false;
    edges_->rewind();
    while (const std::uint64_t *const record = edges_->next()) {
        is_any = true;
        if (!fill_beside(region, point_from_ordered<2>(record), point_from_ordered<2>(record + 2),
                         fault))
            return false;
    }
    if (!is_any) {
        fault = region_fault(ABACUS_REGION_EMPTY, region, no_region);
        return false;
    }
    if (!flood_.run(fault)) return false;
    if (const auto overlap = touching_.overlap()) {
        fault = region_fault(ABACUS_REGION_TWICE, region, overlap->other, overlap->a, overlap->a,
                             overlap->b);
        return false;
    }
    unmark_outside();
    return true;
}

bool Regions::fill_beside(RegionNumber region, const Point<2> &from, const Point<2> &to,
                          abacus_region_fault &fault) {
    const Link edge = RegionFlood::left_of(mesh_, from, to);
    const Handle inner = link_simplex(edge), outer = right_of(cache_, edge);
    const RegionNumber here = cache_.region(inner), there = cache_.region(outer);
    if (here != no_region && here != region) {
        fault = region_fault(ABACUS_REGION_TWICE, region, here, from, from, to);
        return false;
    }
    if (there == no_region && !cache_.simplex(outer).is_ghost()) {
        cache_.set_region(outer, RegionFlood::outside);
        cache_.mark_dirty(outer);
    } else if (there != no_region && there != RegionFlood::outside) {
        touching_.add_known(from, to);
    }
    if (here == no_region) flood_.take_later(inner);
    mesh_.finish(mesh_.anywhere);
    return true;
}

void Regions::unmark_outside() {
    edges_->rewind();
    while (const std::uint64_t *const record = edges_->next()) {
        const Handle outer =
            right_of(cache_, RegionFlood::left_of(mesh_, point_from_ordered<2>(record),
                                                  point_from_ordered<2>(record + 2)));
        if (cache_.region(outer) == RegionFlood::outside) {
            cache_.set_region(outer, no_region);
            cache_.mark_dirty(outer);
        }
        mesh_.finish(mesh_.anywhere);
    }
}

Link Regions::fixed_edge_at(Handle h, const Point<2> &p) {
    Link found = unset;
    const int at = mesh_.corner_at(h, p);
    if (at >= 0) {
        turn_around(cache_, make_link(h, at), [&](Handle around, int corner) {
            const Link edge = make_link(around, (corner + 2) % 3);
            if (cache_.is_fixed(edge)) found = edge;
            return found == unset;
        });
        return found;
    }
    for (int i = 0; i < 3; ++i) {
        const auto &vertex = cache_.simplex(h).vertex;
        if (cache_.is_fixed(make_link(h, i)) &&
            orientation(cache_.point(vertex[(i + 1) % 3]), cache_.point(vertex[(i + 2) % 3]), p) ==
                0)
            found = make_link(h, i);
    }
    return found;
}

Handle Regions::at_seed(RegionNumber region, const Point<2> &p, abacus_region_fault &fault) {
    fault = region_fault(ABACUS_REGION_SEED_OUTSIDE, region, no_region, p);
    Handle h = mesh_.locate(p, cache_.domain().code(p), mesh_.any_recent());
    if (const int at = mesh_.corner_at(h, p); at >= 0)
        turn_around(cache_, make_link(h, at), [&](Handle around, int) {
            h = around;
            return cache_.simplex(h).is_ghost();
        });
    if (cache_.simplex(h).is_ghost()) return no_handle;
    const Link edge = fixed_edge_at(h, p);
    if (edge == unset) return h;
    const auto &vertex = cache_.simplex(link_simplex(edge)).vertex;
    fault = region_fault(ABACUS_REGION_SEED_FIXED, region, no_region, p,
                         cache_.point(vertex[(link_facet(edge) + 1) % 3]),
                         cache_.point(vertex[(link_facet(edge) + 2) % 3]));
    return no_handle;
}

bool Regions::fill_seed(RegionNumber region, const Point<2> &p, const Report &report,
                        abacus_region_fault &fault) {
    const Handle h = at_seed(region, p, fault);
    if (h == no_handle) return false;
    const RegionNumber here = cache_.region(h);
    fault = region_fault(ABACUS_REGION_TWICE, region, here, p);
    if (here != no_region) return here == region;
    flood_.begin(RegionFlood::Rule::seed, region);
    flood_.take(h);
    if (!flood_.run(fault)) return false;
    report(region, flood_.box());
    return true;
}

void Regions::clear(RegionParts &parts) {
    abacus_region_fault none;
    const auto clear_from = [&](Handle h, RegionNumber region) {
        if (cache_.region(h) != region) return;
        flood_.begin(RegionFlood::Rule::clear, region);
        flood_.take(h);
        flood_.run(none);
    };
    parts.each(
        [&](RegionNumber region, const Point<2> &a, const Point<2> &b) {
            each_edge_on(mesh_, a, b, [&](Link edge) {
                const auto &vertex = cache_.simplex(link_simplex(edge)).vertex;
                const Point<2> from = cache_.point(vertex[(link_facet(edge) + 1) % 3]),
                               to = cache_.point(vertex[(link_facet(edge) + 2) % 3]);
                clear_from(link_simplex(edge), region);
                clear_from(link_simplex(RegionFlood::left_of(mesh_, to, from)), region);
            });
        },
        [&](RegionNumber region, const Point<2> &p) {
            clear_from(mesh_.locate(p, cache_.domain().code(p), mesh_.any_recent()), region);
            mesh_.finish(mesh_.anywhere);
        });
}

} // namespace abacus
