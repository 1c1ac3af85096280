#include "query/shapes/ring_nesting.hpp"

#include "blocks/bit_column.hpp"
#include "geometry/direction.hpp"

namespace abacus {

namespace {

// An edge: from, to, ring, whether the ring is a hole. A ray: the edge where it ends, its ring.
constexpr std::size_t edge_words = 6, ray_words = 5, edge_key = 4;

void put_edge(std::uint64_t *words, const Point<2> &from, const Point<2> &to) {
    put_ordered(words, from);
    put_ordered(words + 2, to);
}

} // namespace

RingNesting::RingNesting(Reader<2> &reader, const Kept &kept, Rings &rings, std::uint64_t longest,
                         std::size_t memory)
    : host_(reader.cache().host()), cache_(reader.cache()), border_(cache_, kept),
      longest_(longest), is_outermost_(host_) {
    is_outermost_.resize(rings.count() / 64 + 1);
    std::fill(is_outermost_.begin(), is_outermost_.end(), 0);
    RecordSort edges(host_, edge_words, edge_key, memory / 3);
    RecordSort rays(host_, ray_words, edge_key, memory / 3);
    list_edges(rings, edges, rays);
    decide(edges, rays, memory / 3);
    edges.close();
    rays.close();
}

void RingNesting::add_edge(RecordSort &edges, const Rings::Visit &from, const Point<2> &to) const {
    std::uint64_t *const record = edges.add();
    put_edge(record, from.point, to);
    record[4] = from.ring;
    record[5] = from.is_hole;
}

void RingNesting::list_edges(Rings &rings, RecordSort &edges, RecordSort &rays) {
    Rings::Visit visit, before{}, first{};
    const auto add_ray = [&](const Point<2> &to) {
        Border::Edge edge{first.point, to, first.page, no_handle, 0};
        if (follow_ray(edge)) {
            std::uint64_t *const record = rays.add();
            put_edge(record, edge.from, edge.to);
            record[4] = first.ring;
        } else {
            is_outermost_[first.ring / 64] |= std::uint64_t{1} << first.ring % 64;
        }
    };
    bool is_any = false;
    while (rings.next(visit)) {
        if (visit.position == 0) {
            if (is_any) add_edge(edges, before, first.point);
            first = visit;
        } else {
            add_edge(edges, before, visit.point);
            if (visit.position == 1 && !visit.is_hole) add_ray(visit.point);
        }
        before = visit;
        is_any = true;
    }
    if (is_any) add_edge(edges, before, first.point);
    edges.finish();
    rays.finish();
    rings.rewind();
}

bool RingNesting::has_ray(Handle h, int corner) const {
    const Corners<2> corners = cache_.corners(cache_.simplex(h));
    return !leads_inside(corners, (corner + 1) % 3) && !leads_inside(corners, (corner + 2) % 3);
}

bool RingNesting::turn_to_ray(Border::Edge &edge, bool &is_at_ray) {
    Link at = cache_.cross(edge.triangle, edge.facet);
    const VertexIndex v = cache_.simplex(edge.triangle).vertex[(edge.facet + 1) % 3];
    is_at_ray = false;
    for (std::uint64_t turns = 1;; ++turns) {
        if (turns % 1024 == 0) cache_.poll();
        const Handle h = link_simplex(at);
        if (cache_.simplex(h).is_ghost()) return false;
        if (border_.is_kept(h)) {
            edge = border_.edge(h, link_facet(at));
            return true;
        }
        const int corner = cache_.simplex(h).index_of(v);
        is_at_ray = has_ray(h, corner);
        if (is_at_ray) {
            edge = border_.edge(h, corner);
            return true;
        }
        at = cache_.cross(h, 3 - link_facet(at) - corner);
    }
}

bool RingNesting::follow_ray(Border::Edge &edge) {
    const double level = edge.from[1];
    border_.make_room<0>({});
    border_.find(edge);
    bool is_at_ray = false;
    if (!turn_to_ray(edge, is_at_ray)) return false;
    // Across edges between triangles that are not kept.
    for (std::uint64_t steps = 1; is_at_ray; ++steps) {
        if (steps % 1024 == 0) cache_.poll();
        if (steps > longest_) throw_corrupted("A ray through the mesh does not end.");
        border_.make_room<1>({&edge});
        const Link link = cache_.cross(edge.triangle, edge.facet);
        const Handle h = link_simplex(link);
        if (cache_.simplex(h).is_ghost()) return false;
        if (border_.is_kept(h)) {
            edge = border_.edge(h, link_facet(link));
            return true;
        }
        // Continue across the edge whose ends are on different sides of the ray.
        const int apex = link_facet(link), next = (apex + 1) % 3;
        const auto is_above = [&](int corner) {
            return cache_.point(cache_.simplex(h).vertex[corner])[1] >= level;
        };
        edge = border_.edge(h, is_above(apex) == is_above(next) ? next : (apex + 2) % 3);
    }
    return true;
}

void RingNesting::decide(RecordSort &edges, RecordSort &rays, std::size_t memory) {
    RecordSort ends(host_, 3, 1, memory); // ring, where its ray ends, whether the ring is a hole
    const std::uint64_t *edge = edges.next();
    while (const std::uint64_t *ray = rays.next()) {
        while (edge != nullptr &&
               std::lexicographical_compare(edge, edge + edge_key, ray, ray + edge_key))
            edge = edges.next();
        if (edge == nullptr || !std::equal(edge, edge + edge_key, ray))
            throw_corrupted("A ring of the border is not closed.");
        std::uint64_t *const end = ends.add();
        end[0] = ray[4];
        end[1] = edge[4];
        end[2] = edge[5];
    }
    ends.finish();
    while (const std::uint64_t *end = ends.next())
        if (end[2] == 0 && is_outermost(end[1]))
            is_outermost_[end[0] / 64] |= std::uint64_t{1} << end[0] % 64;
    ends.close();
}

} // namespace abacus
