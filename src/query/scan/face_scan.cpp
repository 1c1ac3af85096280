#include "query/scan/face_scan.hpp"

#include "blocks/bit_column.hpp"
#include "geometry/direction.hpp"
#include "query/locate/edges_along.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/scan/narrowed.hpp"

#include <algorithm>
#include <bit>
#include <map>

namespace abacus {

namespace {

template <int D>
typename RangeScan<D>::Wants pages_with(const std::optional<abacus_range> &range,
                                        const VertexValues<D> &values) {
    if (!range || values.are_elsewhere()) return {}; // their pages do not know the values
    return [range = *range](const PageView<D> &page) {
        return page.may_have_attribute(static_cast<int>(range.attribute), range.least,
                                       range.greatest);
    };
}

/// The region on the left of the edge from a to b.
RegionNumber region_across(Reader<2> &reader, const Point<2> &a, const Point<2> &b) {
    const std::optional<Link> corner = corner_at(reader, a);
    if (!corner) throw_corrupted("An edge has no vertex where it begins.");
    return reader.cache().region(straight_on(reader.cache(), *corner, b).triangle);
}

} // namespace

template <int D>
FaceScan<D>::FaceScan(const Host &host, const abacus_facts &facts, const abacus_window &window,
                      int corners, const abacus_extent &extent, std::size_t cache_bytes,
                      std::optional<abacus_range> range)
    : host_(host), facts_(facts), corners_(corners), extent_(extent), cache_bytes_(cache_bytes),
      range_(range), window_(narrowed<D>(window, extent)), vertex_values_(host, facts),
      pages_(host, facts, window_.region(), pages_with<D>(range, vertex_values_)), memory_(host),
      known_(&memory_) {}

template <int D> bool FaceScan<D>::advance() {
    for (;;) {
        if (!in_page_) {
            if (!pages_.advance()) return false;
            in_page_ = true;
            if (range_) compare_values();
            simplex_ = 0;
            face_ = 0;
        }
        for (; simplex_ < page().simplices(); ++simplex_, face_ = 0)
            while (face_ < 1u << (D + 1))
                if (const unsigned face = face_++; take(simplex_, face)) return true;
        in_page_ = false;
    }
}

template <int D> bool FaceScan<D>::take(int simplex, unsigned face) {
    const bool is_ghost = page().is_ghost(simplex);
    if (std::popcount(face) != corners_ || (is_ghost && (face >> D & 1) != 0)) return false;
    int n = 0;
    for (int i = 0; i <= D; ++i)
        if ((face >> i & 1) != 0) vertices_[n++] = page().corner(simplex, i);
    if (!is_wanted()) return false;
    if (!is_ghost) return leads_into<D>(corners_of(page(), simplex), face);
    return is_of_ghost(simplex);
}

/// Compares the values of all vertices of the page with the range; a missing value is never in it.
template <int D> void FaceScan<D>::compare_values() {
    const auto attribute = static_cast<int>(range_->attribute);
    for (int v = 0; v < page().vertices(); ++v) {
        const double value = vertex_values_.value(page(), v, attribute);
        is_in_range_[v] = range_->least <= value && value <= range_->greatest;
    }
}

template <int D> bool FaceScan<D>::touches_region() {
    if (extent_.region == no_region || page().region(simplex_) == extent_.region) return true;
    if constexpr (D == 2) {
        if (!is_fixed()) return false; // the region is the same beyond
        if (!reader_) reader_.emplace(host_, facts_, cache_bytes_);
        return region_across(*reader_, point(0), point(1)) == extent_.region ||
               region_across(*reader_, point(1), point(0)) == extent_.region;
    }
    return false;
}

template <int D> bool FaceScan<D>::is_wanted() {
    if (range_ && !is_in_range_[vertices_[0]]) return false;
    if (corners_ == 1) return window_.contains(point(0));
    if (limits_edges(extent_) && !is_within<D>(extent_.max_edge, point(0), point(1))) return false;
    if (!window_.meets(point(0), point(1))) return false;
    if constexpr (D == 2)
        if (const Polygon *polygon = polygon_of(extent_))
            return polygon->overlaps(point(0), point(1));
    return touches_region();
}

template <int D> std::size_t FaceScan<D>::place(const FaceCorners &face) {
    std::uint64_t hash = 0;
    for (const Corner &corner : face)
        for (const double x : corner.point) hash = (hash ^ ordered(x)) * 0x9e3779b97f4a7c15;
    return hash >> 32 & (most_known - 1);
}

template <int D> bool FaceScan<D>::is_of_ghost(int ghost) {
    FacetCorners facet;
    Corners<D> corners{}; // the last one is not read
    for (int i = 0; i < D; ++i) {
        facet[i] = corner(page().corner(ghost, i));
        corners[i] = &facet[i].point;
    }
    if (corners_ == D) return leads_inside(corners, D); // as seen from outside the facet
    const FaceCorners face{corner(vertices_[0]), corner(vertices_[corners_ - 1])};
    known_.resize(most_known);
    std::optional<Known> &known = known_[place(face)];
    if (!known || known->face != face) known = Known{face, find_owner()};
    std::sort(facet.begin(), facet.end());
    return known->owner == facet;
}

template <int D> auto FaceScan<D>::find_owner() -> std::optional<FacetCorners> {
    if (!reader_) reader_.emplace(host_, facts_, cache_bytes_);
    const Cache<D> &cache = reader_->cache();
    std::pmr::map<FacetCorners, int> facets(&memory_); // around the face: simplices of each
    const auto add = [&](const Simplex<D> &s, int left_out) {
        FacetCorners facet;
        for (int i = 0, n = 0; i <= D; ++i)
            if (i != left_out)
                facet[n++] = {cache.point(s.vertex[i]), cache.vertices().id(s.vertex[i])};
        std::sort(facet.begin(), facet.end());
        ++facets[facet];
    };
    bool leads_outside = true;
    reader_->containing(point(0), [&](Handle h) {
        const Simplex<D> &s = cache.simplex(h);
        const Corners<D> corners = cache.corners(s);
        unsigned here = 0; // the face's corners in this simplex
        for (int i = 0; i <= D; ++i)
            for (int k = 0; k < corners_; ++k)
                if (*corners[i] == point(k) &&
                    cache.vertices().id(s.vertex[i]) == page().id(vertices_[k]))
                    here |= 1u << i;
        if (std::popcount(here) != corners_) return;
        leads_outside = leads_outside && !leads_into<D>(corners, here);
        for (int i = 0; i <= D; ++i)
            if ((here >> i & 1) == 0) add(s, i);
    });
    if (!leads_outside) return std::nullopt;
    for (const auto &[facet, simplices] : facets)
        if (simplices == 1) return facet;
    throw_corrupted("A facet of the boundary has no simplex.");
}

template class FaceScan<2>;
template class FaceScan<3>;

} // namespace abacus
