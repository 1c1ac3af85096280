// The triangulation that a change of a mesh works on, with all that belongs to it: attributes that
// are apart, repeated points, the facts of the mesh, and the log of simplices, if there is one.
// Insertion, deletion and the other parts of a change (build.hpp) share it.
//
// A point is in one place at a time. It waits on a vertex page (vertex_page.hpp), is a vertex of
// simplex pages, or, if it equals a vertex, is a repeated point (repeated_points.hpp). While the
// points span no simplex all of them wait.
#pragma once

#include "attributes/attribute_pages.hpp"
#include "change/simplex_changes.hpp"
#include "delaunay/insertion.hpp"
#include "delaunay/removal.hpp"
#include "host/pages_in_hand.hpp"
#include "points/record.hpp"
#include "points/record_sink.hpp"
#include "points/repeated_points.hpp"

#include <abacus/facts.h>

#include <algorithm>
#include <array>
#include <optional>

namespace abacus {

/// A record of a point with the most attributes.
template <int D>
using AnyRecord = std::array<std::uint64_t, record_words(D, ABACUS_MAX_ATTRIBUTES)>;

template <int D> struct Workspace {
    Workspace(const Host &the_host, const abacus_facts &the_facts, std::size_t the_bytes);
    Workspace(const Workspace &) = delete;
    Workspace &operator=(const Workspace &) = delete;

    /// The triangulation in memory. All of it goes when the mesh collapses.
    struct Core {
        Core(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
             AttributePages<D> *attributes);
        Cache<D> cache;
        Delaunay<D> mesh;
        Insertion<D> insertion;
        Removal<D> removal;
    };

    bool has_simplices() const { return facts->census.vertices > 0; }
    /// Vertices are listed in pages of their own: in a loaded mesh that is not Delaunay.
    bool lists_vertices() const { return abacus_lists_vertices(facts->standing) != 0; }
    bool has_waiting() const { return facts->census.inserted < facts->census.staged; }
    /// Of all kinds.
    std::uint64_t simplices() const {
        return static_cast<std::uint64_t>(core->mesh.simplices() + core->mesh.ghosts());
    }
    std::size_t record_size() const { return record_words(D, attributes); } ///< in words
    abacus_counters &counters() { return core->cache.counters; }
    PagesMoved pages_moved() const {
        return {core->cache.counters.loads, core->cache.counters.stores};
    }

    /// From now on logs the simplices that are created and removed.
    void log_to(SimplexChanges<D> &log);
    void set_lines(LineSource *source);
    /// Makes a new vertex.
    VertexIndex create(const std::uint64_t *record);
    /// Makes the first simplex.
    void start(const std::array<VertexIndex, D + 1> &vertices);
    /// A vertex of the cache as a record.
    void read_vertex(VertexIndex v, std::uint64_t *record);
    /// Gives the vertex there the id and the attributes of a record.
    void rename(const Point<D> &p, const std::uint64_t *record);
    /// Removes the repeated points at p.
    void forget_repeated(const Point<D> &p);
    /// `taken` repeated points have been removed.
    void count_repeated_taken(std::uint64_t taken);
    /// Erases all pages of a kind.
    void erase_pages(abacus_page_kind kind);
    /// A cache for one pass over all simplex pages; `former`: see FormerAttributes.
    CacheOptions pass_options(const FormerAttributes &former) const;
    /// Starts over without a triangulation.
    void forget_simplices();
    /// Drops the cache, all of whose pages are written. The next one takes at most `budget` bytes.
    void forget_cache();
    /// Writes everything; what is known of the pages of repeated points and attributes is
    /// forgotten.
    void flush();
    void report(abacus_phase phase, std::uint64_t done, std::uint64_t total);

    /// For any thread.
    void find_codes(const std::uint64_t *records, std::size_t n, std::size_t stride,
                    std::uint64_t *codes) const {
        for (std::size_t i = 0; i < n; ++i)
            codes[i] = domain.code(record_point<D>(records + i * stride));
    }
    /// Calls take(records, codes, n) for some points at a time, with their codes.
    template <class Take>
    void with_codes(const std::uint64_t *records, std::size_t n, std::size_t stride,
                    Take take) const;
    static constexpr std::size_t most_at_once = 64; ///< points whose codes are computed together

    const Host &host;
    PagesInHand in_hand;           ///< of simplices, on their way to threads
    const Host cache_host;         ///< the host, but for these
    const unsigned attributes;     ///< their number
    const std::size_t cache_bytes; ///< for all caches and what is gathered for them
    std::size_t budget;            ///< of them the bytes for the cache of the core
    Domain<D> domain;
    std::optional<AttributePages<D>> apart;    ///< if the mesh has its attributes apart
    std::optional<Core> core;                  ///< always there; optional, to be replaced
    std::optional<RepeatedPoints<D>> repeated; ///< as well
    SimplexChanges<D> *changes = nullptr;      ///< the log, if there is one
    LineSource *lines = nullptr;               ///< of a constrained mesh, if they are known
    abacus_facts *facts = nullptr;             ///< of the current change

private:
    void make_core(const abacus_facts &of);
    void log_all_gone();
};

// Each code is a chain of table look-ups. In a loop of their own many of these run at once.
template <int D>
template <class Take>
void Workspace<D>::with_codes(const std::uint64_t *records, std::size_t n, std::size_t stride,
                              Take take) const {
    std::array<std::uint64_t, most_at_once> codes;
    while (n > 0) {
        const std::size_t some = std::min(n, codes.size());
        find_codes(records, some, stride, codes.data());
        take(records, codes.data(), some);
        records += some * stride;
        n -= some;
    }
}

extern template struct Workspace<2>;
extern template struct Workspace<3>;

} // namespace abacus
