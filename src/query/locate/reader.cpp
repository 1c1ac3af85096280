#include "query/locate/reader.hpp"

#include "host/memory.hpp"
#include "keys/domain_of.hpp"
#include "points/record.hpp"
#include "query/locate/preferred.hpp"
#include "query/pages/describe.hpp"

#include <algorithm>
#include <string>

namespace abacus {

namespace {

/// The share of the memory for attributes that are elsewhere than in the simplex pages.
constexpr std::size_t attributes_share = 8;

CacheOptions linked_as(const abacus_facts &facts, CacheOptions options) {
    options.linked_ghosts = abacus_links_ghosts(facts.standing);
    options.split_nodes = facts.census.split > 0;
    if (facts.columns.apart != 0 || facts.columns.by_id != 0)
        options.budget -= options.budget / attributes_share;
    return options;
}

template <int D> [[noreturn]] void throw_no_such_simplex() {
    throw Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such simplex", {},
                "Use a simplex that abacus_locate, abacus_walk or abacus_simplices returned for "
                "this mesh, and a facet from 0 to " +
                    std::to_string(D) + ".");
}

} // namespace

template <int D>
Reader<D>::Reader(const Host &host, const abacus_facts &facts, const CacheOptions &options,
                  bool in_order)
    : facts_(facts),
      size_(facts.census.simplices == 0 ? 0 : facts.census.simplices + facts.census.ghosts),
      convex_(abacus_is_convex(facts.standing) != 0), in_order_(in_order),
      budget_(linked_as(facts, options).budget),
      vertex_values_(host, facts, options.budget / attributes_share),
      cache_(host, domain_of<D>(facts.form), page_attributes(facts.columns),
             linked_as(facts, options)),
      glance_(cache_, vertex_values_, options.budget / 10, in_order), read_ahead_(cache_),
      walk_(cache_, /*far=*/true), around_(host),
      pages_of_code_(host, page_attributes(facts.columns), options.budget / 16) {}

template <int D> Handle Reader<D>::start(const Point<D> &p, std::uint64_t code) {
    if (size_ == 0) return no_handle;
    cache_.trim();
    if (is_at_hand(code)) {
        read_ahead_.follow(last_);
        return last_;
    }
    if (cache_.is_live(last_) && walk_.is_close(last_, p)) return last_;
    const Handle from = cache_.start(code, p);
    if (from == no_handle) throw_corrupted("The mesh has no simplices.");
    return from;
}

template <int D> Handle Reader<D>::find(const Point<D> &p, std::uint64_t code) {
    const Handle from = start(p, code);
    return from == no_handle ? no_handle
                             : last_ = walk_.to(p, from, longest_walk(size_, !is_delaunay()));
}

// ---- Meshes that are not convex ------------------------------------------------------

template <int D> int Reader<D>::position(Handle h, const Point<D> &p) const {
    const Simplex<D> &s = cache_.simplex(h);
    return s.is_ghost() ? -1 : in_simplex<D>(cache_.corners(s), p);
}

template <int D> Handle Reader<D>::walk_to_inside(const Point<D> &p) {
    // From the block around p a walk takes some dozens of steps.
    constexpr std::uint64_t longest = 1024;
    const Handle from = start(p, cache_.domain().code(p));
    if (from == no_handle) return no_handle;
    const Handle h = walk_.within(p, from, longest);
    if (h == no_handle || cache_.simplex(h).is_ghost() || walk_.ends_on_facet()) return no_handle;
    return last_ = h;
}

template <int D> const PageBoxes<D> &Reader<D>::boxes() {
    if (!boxes_) boxes_.emplace(cache_.host(), facts_, budget_ / 8);
    return *boxes_;
}

template <int D>
template <class Visit>
void Reader<D>::search_pages(const Point<D> &p, Visit visit) {
    if (size_ == 0) return;
    boxes().around(p, [&](Key key, const Key &end) {
        while (key < end) {
            cache_.trim();
            cache_.poll();
            const std::optional<Key> next = visit(key);
            if (!next) return false;
            key = *next;
        }
        return true;
    });
}

template <int D> template <class Visit> void Reader<D>::search(const Point<D> &p, Visit visit) {
    search_pages(p, [&](const Key &page) -> std::optional<Key> {
        bool go_on = true;
        const Key next = cache_.visit(page, [&](Handle h) {
            if (go_on && position(h, p) >= 0) go_on = visit(last_ = h);
        });
        return go_on ? std::optional(next) : std::nullopt;
    });
}

template <int D> PageSearch<D> &Reader<D>::page_search() {
    if (!search_) {
        search_.emplace(cache_.host(), cache_.vertices().attribute_count(), budget_ / 4);
        cache_.set_budget(budget_ - std::min(budget_, search_->bytes()));
    }
    return *search_;
}

template <int D>
template <class Visit>
void Reader<D>::search_near(const Point<D> &p, Visit visit) {
    bool go_on = true;
    search_pages(p, [&](const Key &page) -> std::optional<Key> {
        const Key next =
            page_search().near(page, {p, p}, [&](const PageView<D> &view, int simplex) {
                go_on = go_on && visit(view, simplex);
            });
        return go_on ? std::optional(next) : std::nullopt;
    });
}

template <int D> std::uint64_t Reader<D>::pages_with(const std::uint64_t *vertex) {
    const Point<D> p = record_point<D>(vertex);
    const VertexHeap<D> &heap = cache_.vertices();
    std::uint64_t pages = 0;
    bool same = true;
    search_pages(p, [&](const Key &page) -> std::optional<Key> {
        bool here = false;
        const Key next = cache_.visit(page, [&](Handle h) {
            const Simplex<D> &s = cache_.simplex(h);
            for (int i = 0; i < s.finite_vertices(); ++i) {
                const VertexIndex v = s.vertex[i];
                if (!(cache_.point(v) == p)) continue;
                if (facts_.census.split > 0 && heap.id(v) != record_id(vertex)) continue;
                here = true;
                same = same && heap.id(v) == record_id(vertex) &&
                       (heap.attribute_count() == 0 ||
                        std::memcmp(heap.attributes(v), record_attributes<D>(vertex),
                                    heap.attribute_count() * sizeof(double)) == 0);
            }
        });
        pages += here;
        return next;
    });
    return same ? pages : 0;
}

template <int D>
bool Reader<D>::search_first(const Point<D> &p, abacus_simplex &simplex, CornerValues *values,
                             const abacus_extent &extent) {
    bool found = false;
    is_search_ = true;
    search_pages(p, [&](const Key &page) -> std::optional<Key> {
        return page_search().around(page, p,
                                    [&](const PageView<D> &view, int number, int position) {
                                        abacus_simplex other;
                                        abacus::describe(view, number, cache_.domain(), other);
                                        if (!found || is_preferred<D>(other, simplex, extent))
                                            abacus::describe(view, number, cache_.domain(), simplex,
                                                             values, vertex_values_);
                                        found = true;
                                        if (position > 0) is_search_ = false;
                                    });
    });
    return found && is_in<D>(extent, simplex);
}

// ---- All meshes ------------------------------------------------------------------------

template <int D>
void Reader<D>::describe(Handle h, abacus_simplex &simplex, CornerValues *values) const {
    const Simplex<D> &s = cache_.simplex(h);
    DescribedCorners<D> corners;
    for (int i = 0; i < s.finite_vertices(); ++i) {
        corners.id[i] = cache_.vertices().id(s.vertex[i]);
        corners.point[i] = &cache_.point(s.vertex[i]);
    }
    corners.region = cache_.region(h);
    const auto &order = abacus::describe(corners, cache_.code(s), s.is_ghost(), simplex);
    if (values == nullptr) return;
    for (int i = 0; i < s.finite_vertices(); ++i)
        values->set(i, [&](int attribute) {
            return vertex_values_.value(cache_.vertices(), s.vertex[order[i]], attribute);
        });
}

template <int D>
bool Reader<D>::locate(const Point<D> &p, abacus_simplex &simplex, CornerValues *values,
                       const abacus_extent &where) {
    if (!may_count<D>(where, p)) return false;
    const abacus_extent extent = without_polygon(where);
    if (!convex_) {
        // When the cache is full, a walk needs pages that were evicted; a search keeps other pages.
        const bool is_walk = !is_search_ && cache_.counters.evictions == 0;
        const Handle inside = is_walk ? walk_to_inside(p) : no_handle;
        if (inside == no_handle) return search_first(p, simplex, values, extent);
        describe(inside, simplex, values);
        return is_in<D>(extent, simplex);
    }
    std::uint64_t code = cache_.domain().code(p);
    if (glance(p, code, simplex, values)) return is_in<D>(extent, simplex);
    const Handle h = find(p, code);
    const bool is_inside = h != no_handle && !cache_.simplex(h).is_ghost();
    is_no_glance_ = !is_inside || walk_.ends_on_facet();
    if (!is_inside) return false;
    describe(h, simplex, values);
    if (walk_.ends_on_facet()) first_around(p, h, simplex, values, extent);
    return is_in<D>(extent, simplex);
}

template <int D>
std::optional<typename Reader<D>::Around> Reader<D>::page_around(const Point<D> &p) {
    const Handle h = simplex_around(p);
    if (h == no_handle) return std::nullopt;
    return Around{cache_.lower(h), !cache_.simplex(h).is_ghost()};
}

template <int D>
bool Reader<D>::glance(const Point<D> &p, std::uint64_t &code, abacus_simplex &simplex,
                       CornerValues *values) {
    if (cache_.counters.evictions == 0 && !in_order_) return false; // the cache finds more
    if (size_ == 0) return false;
    // In order, places that no glance finds also come one after another.
    if ((!in_order_ || is_no_glance_) && is_at_hand(code)) return false;
    cache_.poll();
    const bool is_found = glance_.find(code, p, simplex, values);
    cache_.set_budget(budget_ - std::min(budget_, glance_.bytes()));
    return is_found;
}

template <int D>
void Reader<D>::first_around(const Point<D> &p, Handle h, abacus_simplex &simplex,
                             CornerValues *values, const abacus_extent &extent) {
    flood_around(p, h, [&](Handle met) {
        abacus_simplex other;
        describe(met, other);
        if (is_preferred<D>(other, simplex, extent)) describe(met, simplex, values);
    });
}

template <int D>
template <class Visit>
void Reader<D>::flood_around(const Point<D> &p, Handle h, Visit visit) {
    // Across every facet that p lies on there is another simplex that contains p.
    const auto has_p = [&](Handle at, int facet) {
        const Simplex<D> &s = cache_.simplex(at);
        return !s.is_ghost() && facet_side<D>(cache_.corners(s), facet, p) == 0;
    };
    around_.from(cache_, h, has_p, [&](Handle met) {
        if (!cache_.simplex(met).is_ghost()) visit(met);
        return true;
    });
}

template <int D>
void Reader<D>::containing(const Point<D> &p, const std::function<void(Handle)> &visit) {
    if (!convex_) {
        search(p, [&](Handle found) {
            visit(found);
            return true;
        });
    } else if (const Handle h = simplex_around(p);
               h != no_handle && !cache_.simplex(h).is_ghost()) {
        flood_around(p, h, visit);
    }
}

template <int D> bool Reader<D>::has_ids(Handle h, const std::int64_t *ids) const {
    const Simplex<D> &s = cache_.simplex(h);
    if (s.is_ghost()) return false;
    std::array<std::int64_t, D + 1> here;
    for (int i = 0; i <= D; ++i) here[i] = cache_.vertices().id(s.vertex[i]);
    return std::is_permutation(here.begin(), here.end(), ids);
}

template <int D> int Reader<D>::named_corner(Handle h, const std::int64_t *ids, int facet) const {
    // If several corners have this id, their order in the returned simplex decides which one is
    // meant.
    const Simplex<D> &s = cache_.simplex(h);
    abacus_simplex given;
    describe(h, given);
    auto before = std::count(ids, ids + facet, ids[facet]);
    int named = 0;
    while (given.id[named] != ids[facet] || before-- > 0) ++named;
    int corner = 0;
    while (!std::equal(given.corner[named], given.corner[named] + D,
                       cache_.point(s.vertex[corner]).begin()))
        ++corner;
    return corner;
}

template <int D> Handle Reader<D>::named(std::uint64_t code, const std::int64_t *ids) {
    Handle h = no_handle;
    Key page{}; // the page that has the simplex
    bool is_unique = true;
    const auto is_it = [&](Handle candidate) {
        return cache_.is_live(candidate) && cache_.code(cache_.simplex(candidate)) == code &&
               has_ids(candidate, ids);
    };
    const auto look = [&](const Key &key) {
        cache_.trim();
        cache_.visit(key, [&](Handle candidate) {
            if (!is_it(candidate)) return;
            is_unique = h == no_handle;
            h = candidate;
            page = cache_.lower(h);
        });
    };
    if (size_ != 0 && code < key_word_end) {
        if (is_at_hand(code))
            look({code, 0});
        else
            pages_of_code_.with_ids(code, ids, look);
    }
    if (h == no_handle) throw_no_such_simplex<D>();
    if (!is_unique)
        throw Error(ABACUS_ERROR_ARGUMENT,
                    "several simplices of the mesh have this code and these ids",
                    "Their vertices include points with equal ids.",
                    "Give the points unique ids to walk from one simplex to another.");
    if (!is_it(h)) // evicted for other pages with the code
        cache_.visit(page, [&](Handle candidate) {
            if (is_it(candidate)) h = candidate;
        });
    return h;
}

template <int D>
bool Reader<D>::walk(std::uint64_t code, const std::int64_t *ids, int facet,
                     abacus_simplex &simplex) {
    if (facet < 0 || facet > D) throw_no_such_simplex<D>();
    const Handle h = named(code, ids);
    const Handle neighbour = link_simplex(cache_.cross(h, named_corner(h, ids, facet)));
    if (cache_.simplex(neighbour).is_ghost()) return false;
    last_ = neighbour;
    describe(neighbour, simplex);
    return true;
}

template <int D>
void Reader<D>::star(const Point<D> &p, const std::function<void(const abacus_simplex &)> &visit) {
    if (convex_)
        return containing(p, [&](Handle h) {
            abacus_simplex simplex;
            describe(h, simplex);
            visit(simplex);
        });
    search_near(p, [&](const PageView<D> &view, int number) {
        if (in_simplex<D>(corners_of(view, number), p) < 0) return true;
        abacus_simplex simplex;
        abacus::describe(view, number, cache_.domain(), simplex);
        visit(simplex);
        return true;
    });
}

template <int D> std::optional<std::int64_t> Reader<D>::vertex_at(const Point<D> &p) {
    if (!convex_) {
        std::optional<std::int64_t> id;
        search_near(p, [&](const PageView<D> &view, int simplex) {
            for (int i = 0; i <= D && !id; ++i)
                if (const int v = view.corner(simplex, i); view.point(v) == p) id = view.id(v);
            return !id;
        });
        return id;
    }
    const Handle h = find(p, cache_.domain().code(p));
    if (h == no_handle) return std::nullopt;
    const Simplex<D> &s = cache_.simplex(h);
    for (int i = 0; i < s.finite_vertices(); ++i) {
        const VertexIndex v = s.vertex[i];
        if (cache_.point(v) == p) return cache_.vertices().id(v);
    }
    return std::nullopt;
}

template class Reader<2>;
template class Reader<3>;

} // namespace abacus
