// Point location and walking over a stored mesh (dissertation §4.11.3), in a cache
// that lives as long as the reader.
//
// In a mesh that Abacus has not made a walk may miss a point that the mesh contains: it ends at the
// border of a hole, and it may take too long. Then, and for a point on a facet, around which not
// all simplices need be connected, all pages whose boxes contain the point are searched
// (page_boxes.hpp, page_search.hpp). Such places come together; so after one of them the next is
// searched for in pages at once.
#pragma once

#include "query/locate/glance.hpp"
#include "query/pages/extent.hpp"
#include "query/pages/page_boxes.hpp"
#include "query/pages/page_search.hpp"
#include "query/pages/pages_of_code.hpp"
#include "query/pages/read_ahead.hpp"
#include "query/pages/vertex_values.hpp"
#include "traverse/flood.hpp"
#include "traverse/walk.hpp"

#include <abacus/simplex.h>
#include <functional>
#include <optional>

namespace abacus {

template <int D> class Reader {
public:
    Reader(const Host &host, const abacus_facts &facts, std::size_t cache_bytes)
        : Reader(host, facts, CacheOptions{.budget = cache_bytes}) {}
    /// `in_order`: places come along the curve. Then a page need not be loaded to be looked into,
    /// whether or not the cache has room for it.
    Reader(const Host &host, const abacus_facts &facts, const CacheOptions &options,
           bool in_order = false);

    /// The simplex that contains p; of several, the first by comes_before(). False
    /// outside the hull. `values` gets the values at its corners. Simplices outside of the
    /// extent count as outside.
    bool locate(const Point<D> &p, abacus_simplex &simplex, CornerValues *values = nullptr,
                const abacus_extent &extent = {});
    /// The neighbour across facet `facet` of the simplex with this code and these ids.
    /// False at the hull; throws an Error (argument) if there is no such simplex, or several,
    /// as there may be where points have equal ids.
    bool walk(std::uint64_t code, const std::int64_t *ids, int facet, abacus_simplex &simplex);
    /// The simplex with this code and these ids, as in walk().
    void describe(std::uint64_t code, const std::int64_t *ids, abacus_simplex &simplex);
    /// Calls visit(handle) for all finite simplices that contain p, in no order.
    void containing(const Point<D> &p, const std::function<void(Handle)> &visit);
    /// Calls visit(simplex) for all that contain p.
    void star(const Point<D> &p, const std::function<void(const abacus_simplex &)> &visit);
    /// ... for the simplex with this code and these ids, as in walk(), and those that can be
    /// reached from it across at most `steps` facets, the nearest first.
    void neighbours(std::uint64_t code, const std::int64_t *ids, std::uint32_t steps,
                    const std::function<void(const abacus_simplex &)> &visit);
    /// Id of the vertex at p, if there is one.
    std::optional<std::int64_t> vertex_at(const Point<D> &p);

    /// In a mesh with convex border: the page of the simplex around p or, outside the hull, of a
    /// ghost that has p strictly beyond its facet. None if the mesh is empty.
    struct Around {
        Key page;
        bool is_inside;
    };
    std::optional<Around> page_around(const Point<D> &p);

    /// In a mesh with convex border: the simplex around p or, outside the hull, a ghost that has p
    /// strictly beyond its facet; no_handle in an empty mesh. It stays until the next call.
    Handle simplex_around(const Point<D> &p) { return find(p, cache_.domain().code(p)); }
    /// Whether that point is on a facet of the simplex, which is no ghost.
    bool is_on_facet() const { return walk_.ends_on_facet(); }
    /// In a mesh that is not convex, and not empty: where its pages are.
    const PageBoxes<D> &boxes();
    /// Whether all of the mesh can be reached by walking: it fills its convex hull, and one can
    /// walk around that.
    bool is_convex() const { return convex_; }
    /// Whether the mesh is Delaunay: nearest vertices are neighbours.
    bool is_delaunay() const { return abacus_is_delaunay(facts_.standing) != 0; }
    /// Whether the mesh is a triangulation of its points and lines, if it has any.
    bool is_own() const { return abacus_is_own(facts_.standing) != 0; }
    bool has_soft_lines() const { return facts_.census.soft_lines > 0; }
    bool is_empty() const { return size_ == 0; }
    const abacus_facts &facts() const { return facts_; }
    /// Simplices and ghosts.
    std::uint64_t size() const { return size_; }
    /// A simplex of the cache as users see it, with the values at its corners.
    void describe(Handle h, abacus_simplex &simplex, CornerValues *values = nullptr) const;
    /// A flood over the cache, for use between two calls.
    Flood<D> &flood() { return around_; }

    /// In a mesh that is not convex: how many pages have this vertex, with its id and with the
    /// attributes that pages have.
    std::uint64_t pages_with(const std::uint64_t *vertex);

    /// Pages loaded or searched.
    std::uint64_t pages_read() const {
        return cache_.counters.loads + glance_.pages_read() + (search_ ? search_->pages_read() : 0);
    }

    /// Attributes of the vertices of cache and pages.
    const VertexValues<D> &vertex_values() const { return vertex_values_; }

    const Cache<D> &cache() const { return cache_; }
    Cache<D> &cache() { return cache_; }

private:
    /// A simplex with p in its closure, or a ghost that sees p; no_handle in an empty mesh.
    /// Here and below `code` is p's, or that of where its simplex may be expected.
    Handle find(const Point<D> &p, std::uint64_t code);
    /// Locates p in a page that is not in the cache, if the cache has been full, or places come in
    /// order, and if it is worthwhile. Otherwise says where a walk should begin.
    bool glance(const Point<D> &p, std::uint64_t &code, abacus_simplex &simplex,
                CornerValues *values);
    /// Where a walk to p begins; no_handle in an empty mesh.
    Handle start(const Point<D> &p, std::uint64_t code);
    /// Whether the block of the simplex found last owns the code.
    bool is_at_hand(std::uint64_t code) const {
        return cache_.is_live(last_) && cache_.near(last_, code);
    }
    /// In a mesh that is not convex: the simplex with p inside to which a short walk leads,
    /// or no_handle.
    Handle walk_to_inside(const Point<D> &p);
    /// Calls visit(key) for the pages that may contain p, until it returns false; visit
    /// returns the key of the next page.
    template <class Visit> void search_pages(const Point<D> &p, Visit visit);
    /// Calls visit(handle) for every simplex that contains p, until it returns false.
    template <class Visit> void search(const Point<D> &p, Visit visit);
    /// As in_simplex(); every point is outside of a ghost.
    int position(Handle h, const Point<D> &p) const;
    /// The same in the pages themselves: visit(page, simplex, position) for every simplex near p,
    /// all that contain it among them, until one returns false.
    template <class Visit> void search_near(const Point<D> &p, Visit visit);
    /// The held pages, once needed; the cache then gets less memory.
    PageSearch<D> &page_search();
    /// The first of all simplices that contain p, found in the pages themselves.
    bool search_first(const Point<D> &p, abacus_simplex &simplex, CornerValues *values,
                      const abacus_extent &extent);
    /// The simplex with this code and these ids; throws as walk() does.
    Handle named(std::uint64_t code, const std::int64_t *ids);
    /// Whether these are the ids of the simplex's corners, in any order.
    bool has_ids(Handle h, const std::int64_t *ids) const;
    /// The corner of the simplex that corner `facet` of the ids stands for.
    int named_corner(Handle h, const std::int64_t *ids, int facet) const;
    /// Calls visit(handle) for all finite simplices around a point that h contains.
    template <class Visit> void flood_around(const Point<D> &p, Handle h, Visit visit);
    /// The first of all simplices around a point on a facet of h, which `simplex` describes.
    void first_around(const Point<D> &p, Handle h, abacus_simplex &simplex, CornerValues *values,
                      const abacus_extent &extent);

    const abacus_facts facts_;
    std::uint64_t size_; // simplices and ghosts
    bool convex_;
    const bool in_order_;
    /// The last place that a walk searched for was outside or on a facet, where a glance finds
    /// nothing.
    bool is_no_glance_ = false;
    std::size_t budget_;
    std::optional<PageBoxes<D>> boxes_; // once needed
    std::optional<PageSearch<D>> search_;
    /// The last place searched for was not strictly inside a simplex: most likely the next one will
    /// not be either, and a walk to it would be in vain.
    bool is_search_ = false;
    VertexValues<D> vertex_values_;
    Cache<D> cache_;
    Glance<D> glance_;
    ReadAhead<D> read_ahead_;
    Walk<D, Cache<D>> walk_;
    Flood<D> around_;
    PagesOfCode<D> pages_of_code_;
    Handle last_ = no_handle;
};

} // namespace abacus
