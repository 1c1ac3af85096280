#include "query/shapes/outline.hpp"

#include "blocks/bit_column.hpp"
#include "query/locate/hull_ghost.hpp"
#include "query/locate/require_delaunay.hpp"
#include "query/pages/page_flood.hpp"

#include <algorithm>

namespace abacus {

namespace {

Kept kept_by(const abacus_outline_kind &kind) {
    Kept kept{kind.extent, std::nullopt};
    if (kind.has_alpha != 0) kept.alpha = kind.alpha;
    return kept;
}

template <int D> void require(const Reader<D> &reader, const abacus_outline_kind &kind) {
    if (kind.has_alpha != 0)
        require_delaunay(
            reader, "an alpha shape needs",
            "Use abacus_hull with max_edge, or load the mesh with retriangulate => true.");
}

} // namespace

// ---- The plane --------------------------------------------------------------------------

Outline<2>::Outline(const Host &host, const abacus_facts &facts, const abacus_outline_kind &kind,
                    std::size_t memory, std::size_t cache_bytes)
    : reader_(host, facts, cache_bytes),
      rings_((require(reader_, kind), reader_), kept_by(kind), memory) {
    if (kind.fills_holes != 0)
        nesting_.emplace(reader_, kept_by(kind), rings_,
                         facts.census.simplices + facts.census.ghosts, memory);
}

bool Outline<2>::next(abacus_outline_row &row) {
    Rings::Visit visit;
    do
        if (!rings_.next(visit)) return false;
    while (nesting_ && !nesting_->is_outermost(visit.ring));
    ring_ += visit.ring != last_;
    last_ = visit.ring;
    row = {ring_, visit.position + 1, visit.id, {visit.point[0], visit.point[1]}};
    return true;
}

// ---- Space ------------------------------------------------------------------------------

Outline<3>::Outline(const Host &host, const abacus_facts &facts, const abacus_outline_kind &kind,
                    std::size_t memory, std::size_t cache_bytes)
    : borders_(host), triangles_(host, words, 9, kind.fills_holes != 0 ? memory / 2 : memory) {
    Reader<3> reader(host, facts, cache_bytes);
    require(reader, kind);
    const Kept kept = kept_by(kind);
    if (!reader.is_empty() && kept.is_all() && reader.is_convex())
        find_hull(host, facts, reader);
    else if (!reader.is_empty()) {
        if (kind.fills_holes != 0) cavities_.emplace(host, memory / 2);
        find_border(reader, kept);
    }
    triangles_.finish();
}

/// Adds a triangle whose corners are counterclockwise as seen from outside.
void Outline<3>::add(std::array<Corner, 3> corners, std::uint32_t part) {
    const auto least =
        std::min_element(corners.begin(), corners.end(), [](const Corner &a, const Corner &b) {
            return lexicographically_less<3>(a.point, b.point);
        });
    std::rotate(corners.begin(), least, corners.end());
    std::uint64_t *const record = triangles_.add();
    for (int i = 0; i < 3; ++i) {
        for (int axis = 0; axis < 3; ++axis) record[3 * i + axis] = ordered(corners[i].point[axis]);
        record[9 + i] = static_cast<std::uint64_t>(corners[i].id);
    }
    record[12] = part;
}

void Outline<3>::find_hull(const Host &host, const abacus_facts &facts, Reader<3> &reader) {
    triangles_.expect(static_cast<double>(facts.census.ghosts));
    PageFlood<3> flood(host, facts);
    flood.reach(reader.cache().lower(hull_ghost<3>(reader)));
    while (flood.advance()) {
        const PageView<3> &page = flood.page();
        for (int s = 0; s < page.simplices(); ++s) {
            if (!page.is_ghost(s)) continue;
            std::array<Corner, 3> corners;
            // A ghost is positively oriented around the half-space beyond its facet.
            for (int i = 0; i < 3; ++i)
                corners[i] = {page.point(page.corner(s, i)), page.id(page.corner(s, i))};
            add(corners, 0);
        }
        flood.spread([&](int s, int facet) { return facet < 3 && page.is_ghost(s); });
    }
}

template <class End> void Outline<3>::each_page(Reader<3> &reader, const Kept &kept, End end_page) {
    Cache<3> &cache = reader.cache();
    Arena<Handle> handles(cache.host());
    Pacer pacer(cache.host());
    pacer.begin(ABACUS_PHASE_SCANNING, reader.size());
    std::uint64_t seen = 0;
    for (Key page = first_key; page < end_key;) {
        cache.trim();
        handles.clear();
        page = cache.visit(page, [&](Handle h) { handles.push_back(h); });
        pacer.reached(seen += handles.size());
        if (handles.empty()) continue;
        borders_.clear();
        if (cavities_) cavities_->begin_page(cache, handles[0]);
        for (const Handle h : handles) {
            if (is_kept<3>(kept, cache, h)) continue;
            const bool is_ghost = cache.simplex(h).is_ghost();
            if (cavities_ && is_ghost) cavities_->meet_outside(h);
            // All ghosts are outside, so their ridges can be skipped.
            for (int facet = is_ghost ? 3 : 0; facet < 4; ++facet) {
                const Handle beyond = link_simplex(cache.cross(h, facet));
                if (is_kept<3>(kept, cache, beyond))
                    borders_.push_back(make_link(h, facet));
                else if (cavities_)
                    cavities_->meet(h, facet, beyond);
            }
        }
        end_page();
    }
}

void Outline<3>::find_border(Reader<3> &reader, const Kept &kept) {
    // The borders of cavities are omitted in the end, and their number is not known before.
    const double most = 4.0 * static_cast<double>(reader.size());
    if (!cavities_ && !reader.cache().host().spool_fits(triangles_.spool_bytes(most)))
        count(reader, kept);
    each_page(reader, kept, [&] { add_borders(reader.cache()); });
    if (cavities_) cavities_->finish();
}

void Outline<3>::count(Reader<3> &reader, const Kept &kept) {
    double triangles = 0;
    each_page(reader, kept, [&] { triangles += static_cast<double>(borders_.size()); });
    triangles_.expect(triangles);
}

/// Adds triangles that are counterclockwise as seen from the side that is not kept. A ghost is
/// positively oriented around the half-space beyond its facet, which is the last one.
void Outline<3>::add_borders(Cache<3> &cache) {
    constexpr int inward[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    if (cavities_) cavities_->number_page();
    for (const Link link : borders_) {
        const Handle h = link_simplex(link);
        const std::uint32_t part = cavities_ ? cavities_->number(h) : 0;
        if (part == Cavities::shut_in) continue;
        std::array<Corner, 3> corners;
        for (int i = 0; i < 3; ++i) {
            const VertexIndex v = cache.simplex(h).vertex[inward[link_facet(link)][i]];
            corners[i] = {cache.point(v), cache.vertices().id(v)};
        }
        add(corners, part);
    }
}

bool Outline<3>::next(abacus_outline_row &row) {
    if (position_ == 3) {
        const std::uint64_t *record;
        do
            if ((record = triangles_.next()) == nullptr) return false;
        while (cavities_ && !cavities_->is_outside(static_cast<std::uint32_t>(record[12])));
        std::copy_n(record, words, triangle_.begin());
        position_ = 0;
        ++ring_;
    }
    row.ring = ring_;
    row.position = static_cast<std::uint64_t>(position_) + 1;
    row.vertex = static_cast<std::int64_t>(triangle_[9 + position_]);
    for (int axis = 0; axis < 3; ++axis)
        row.point[axis] = from_ordered(triangle_[3 * position_ + axis]);
    ++position_;
    return true;
}

} // namespace abacus
