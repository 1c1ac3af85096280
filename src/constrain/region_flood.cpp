#include "constrain/region_flood.hpp"

#include "geometry/ordered.hpp"
#include "traverse/straight.hpp"

#include <utility>

namespace abacus {

RegionFlood::RegionFlood(Delaunay<2> &mesh)
    : mesh_(mesh), cache_(mesh.cache()), near_(cache_.host()), far_(cache_.host()),
      pending_(cache_.host()) {}

Link RegionFlood::left_of(Delaunay<2> &mesh, const Point<2> &a, const Point<2> &b) {
    Cache<2> &cache = mesh.cache();
    const Link corner = vertex_at(mesh, a);
    const Way way = corner == unset ? Way{} : straight_on(cache, corner, b);
    if (!way.is_edge || cache.point(cache.simplex(way.triangle).vertex[(way.corner + 1) % 3]) != b)
        throw_corrupted("An outline of a region is not an edge of the mesh.");
    return make_link(way.triangle, (way.corner + 2) % 3);
}

void RegionFlood::begin(Rule rule, RegionNumber region, TouchingEdges *touching) {
    rule_ = rule;
    region_ = region;
    touching_ = touching;
    near_.clear();
    far_.clear();
    pending_.clear();
    page_ = no_block;
    box_ = {};
}

void RegionFlood::set(Handle h) {
    cache_.set_region(h, clears() ? no_region : region_);
    cache_.mark_dirty(h);
}

void RegionFlood::take(Handle h) {
    set(h);
    (cache_.block_of(h) == page_ ? near_ : far_).push_back(h);
}

bool RegionFlood::look_around(Handle h, abacus_region_fault &fault) {
    const auto fail = [&](abacus_region_fault_kind kind, RegionNumber other, VertexIndex v) {
        fault = region_fault(kind, region_, other, cache_.point(v));
        return false;
    };
    for (int i = 0; i < 3; ++i) {
        if (ends_at_fixed() && cache_.is_fixed(make_link(h, i))) {
            for (const int corner : {(i + 1) % 3, (i + 2) % 3})
                box_.extend(cache_.point(cache_.simplex(h).vertex[corner]));
            continue;
        }
        const Handle beyond = link_simplex(cache_.cross(h, i));
        const VertexIndex v = cache_.simplex(h).vertex[(i + 1) % 3];
        const RegionNumber there = cache_.region(beyond);
        if (cache_.simplex(beyond).is_ghost()) {
            if (rule_ == Rule::seed) return fail(ABACUS_REGION_LEAK, no_region, v);
        } else if (clears()) {
            if (there == region_) take(beyond);
        } else if (there == no_region) {
            take(beyond);
        } else if (there != region_ && there != outside) {
            if (rule_ == Rule::seed) return fail(ABACUS_REGION_TWICE, there, v);
            const VertexIndex w = cache_.simplex(h).vertex[(i + 2) % 3];
            touching_->add_met(cache_.point(v), cache_.point(w), there);
        }
    }
    return true;
}

bool RegionFlood::next(Handle &h) {
    Arena<Handle> &from = near_.empty() ? far_ : near_;
    if (from.empty()) return false;
    h = from.back();
    from.pop_back();
    page_ = cache_.block_of(h);
    return true;
}

bool RegionFlood::run(abacus_region_fault &fault) {
    do {
        Handle h;
        for (std::size_t n = 0; next(h); ++n) {
            if (n == triangles_at_once) {
                put_off(h);
                put_off();
                break;
            }
            if (n % 1024 == 1023) cache_.poll();
            if (!look_around(h, fault)) return false;
        }
        mesh_.finish(mesh_.anywhere);
        page_ = no_block;
    } while (resume());
    return true;
}

void RegionFlood::put_off(Handle h) {
    const auto &vertex = cache_.simplex(h).vertex;
    Edge edge;
    for (int i = 0; i < 2; ++i) put_ordered(edge.data() + 2 * i, cache_.point(vertex[i]));
    if (pending_.size() < most_pending) {
        pending_.push_back(edge);
        return;
    }
    std::optional<RecordSpool> &spool = spools_[writing_];
    if (!spool) spool.emplace(cache_.host(), edge_words);
    std::copy(edge.begin(), edge.end(), spool->add());
}

void RegionFlood::put_off() {
    for (Arena<Handle> *const handles : {&far_, &near_}) {
        for (const Handle h : *handles) put_off(h);
        handles->clear();
    }
}

void RegionFlood::read_back() {
    std::optional<RecordSpool> *from = &spools_[1 - writing_];
    if (!*from) {
        from = &spools_[writing_];
        if (!*from) return;
        writing_ = 1 - writing_;
        (*from)->rewind();
    }
    while (pending_.size() < most_pending / 2) {
        const std::uint64_t *const edge = (*from)->next();
        if (edge == nullptr) {
            (*from)->close();
            from->reset();
            return;
        }
        std::copy_n(edge, edge_words, pending_.extend(1)->begin());
    }
}

bool RegionFlood::resume() {
    while (pending_.empty()) {
        if (!spools_[0] && !spools_[1]) return false;
        read_back();
    }
    const Edge edge = pending_.back();
    pending_.pop_back();
    far_.push_back(link_simplex(left_of(mesh_, point_from_ordered<2>(edge.data()),
                                        point_from_ordered<2>(edge.data() + 2))));
    return true;
}

} // namespace abacus
