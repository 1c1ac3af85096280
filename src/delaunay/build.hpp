// Changes of a mesh as a whole (dissertation §4.12.5): points that wait, or that a stage passes on,
// are inserted into the triangulation; others are removed from it.
//
// A point is in one place at a time. It waits on a vertex page (vertex_page.hpp), is a
// vertex of simplex pages, or, if it equals a vertex, is a repeated point
// (repeated_points.hpp). While the points span no simplex all of them wait.
//
// A mesh whose domain does not fit many of its points gets other keys (build_rekey.cpp). A mesh is
// also rebuilt when it loses so many points that triangulating the rest costs less (outlay.hpp,
// rest.hpp).
//
// With several threads, points are gathered as long as they come along the curve, and inserted or
// removed together (build_threads.cpp).
//
// Each change ends with all pages written and the header brought up to date.
#pragma once

#include "attributes/attribute_pages.hpp"
#include "delaunay/cuts.hpp"
#include "delaunay/first_simplex.hpp"
#include "delaunay/insertion.hpp"
#include "delaunay/interval.hpp"
#include "delaunay/outlay.hpp"
#include "delaunay/removal.hpp"
#include "delaunay/rest.hpp"
#include "host/crew.hpp"
#include "mesh/stored_pages.hpp"
#include "points/repeated_points.hpp"
#include "points/vertex_reader.hpp"
#include "staging/stage.hpp"

#include <abacus/build.h>
#include <abacus/mesh_header.h>
#include <chrono>
#include <optional>
#include <span>

namespace abacus {

template <int D> class Build {
public:
    /// `stored` learns from the host which pages are stored; null if simplices have no labels and
    /// facets no markers.
    Build(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
          StoredPages *stored = nullptr);

    /// From now on logs the simplices that are created and removed.
    void log_to(SimplexChanges<D> &changes);
    /// Until settle() labels and markers stay with the simplices of now: all changes until then
    /// count as one.
    void hold() { holds_ = true; }
    void settle(abacus_header &header);
    /// Inserts at most `limit` of the points that wait (0 = all).
    void run(std::uint64_t limit, abacus_header &header);
    /// Inserts what waits, then the points of a stage.
    void insert(Stage<D> &stage, abacus_on_duplicate on_duplicate, abacus_header &header);
    /// Inserts what waits, then removes a point for each point of a stage; with `exactly`, only one
    /// that has its id and attributes. Returns how many there were.
    std::uint64_t remove(Stage<D> &stage, bool exactly, abacus_header &header);
    /// Inserts what waits, then gives the points of the mesh the new values in a stage, which has
    /// only the attributes `which`. With `exactly` the old values of all attributes follow the new
    /// ones, and a point must have them. Returns how many records had a point in the mesh;
    /// `missing` becomes the first that had none.
    std::uint64_t update(Stage<D> &stage, std::span<const std::uint32_t> which, bool exactly,
                         abacus_header &header, abacus_named_place &missing);
    /// Removes all points, waiting ones included; returns how many there were.
    std::uint64_t clear(abacus_header &header);
    /// Gives all points other attributes: the i-th is their former attribute source[i], or has no
    /// value (no_attribute). `memory` is for sorting. No other change may follow.
    void change_attributes(std::span<const std::uint32_t> source, std::size_t memory,
                           abacus_header &header);
    /// Gives a mesh whose domain does not fit its points another one, with `memory` bytes for
    /// sorting; false if there is no better one.
    bool rekey(std::size_t memory, abacus_header &header);

private:
    class Attributes;
    class Intake;
    class Distinct;
    class Outlet;
    class Pass;
    class Revision;

    /// The triangulation in memory. All of it goes when the mesh collapses.
    struct Core {
        Core(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
             AttributePages<D> *attributes);
        Cache<D> cache;
        Delaunay<D> mesh;
        Insertion<D> insertion;
        Removal<D> removal;
    };

    static void check_attributes(const Stage<D> &stage, std::size_t attributes);
    bool has_simplices() const { return facts_->census.vertices > 0; }
    /// Of all kinds.
    std::uint64_t simplices() const {
        return static_cast<std::uint64_t>(core_->mesh.simplices() + core_->mesh.ghosts());
    }
    bool has_waiting() const { return facts_->census.inserted < facts_->census.staged; }
    void make_core(const abacus_facts &facts, std::size_t cache_bytes);
    VertexIndex create(const std::uint64_t *record);
    void store_attributes(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n);
    /// A vertex of the cache as a record.
    void read_vertex(VertexIndex v, std::uint64_t *record);
    /// Gives the vertex there the id and the attributes of a record.
    void rename(const Point<D> &p, const std::uint64_t *record);
    void start(const std::array<VertexIndex, D + 1> &vertices);
    /// Adds points, which may be gathered: change_gathered() comes after the last.
    void add(const std::uint64_t *records, std::size_t n);
    /// Calls take(records, codes, n) for some points at a time, with their codes.
    template <class Take>
    void with_codes(const std::uint64_t *records, std::size_t n, std::size_t stride,
                    Take take) const;
    void insert_some(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n);
    /// About `points` points come, and `words` words of each are used.
    void begin_to_gather(std::uint64_t points, std::size_t words);
    /// Whether there are threads, and room for enough points to be worth sharing.
    bool gathers() const;
    /// The memory for this many gathered points, with copies of those that have to wait.
    std::size_t gathered_bytes(std::size_t points) const;
    /// Those that leave may come without attributes.
    void gather(const std::uint64_t *records, std::size_t n, std::size_t stride);
    void gather_one(const std::uint64_t *record, std::size_t words, std::uint64_t code);
    /// Inserts the gathered points, or removes them.
    void change_gathered();
    std::size_t thread_cache_bytes() const;
    /// The memory for the session's cache: with threads, what the gathered points leave.
    std::size_t own_cache_bytes() const;
    bool is_worth_sharing() const;
    Cuts cuts_for_threads() const;
    void insert_gathered_here();
    void remove_gathered_here();
    void change_on_threads(Cuts &cuts);
    /// Adds the points that the threads have left to the session's thread to `left`.
    void run_passes(Cuts &cuts, Batch &left, const typename Interval<D>::Removing *how);
    /// For a gathered point that the threads have left to the session's thread: adds it to `left`
    /// if it needs the mesh.
    void deal_with_left(std::size_t i, Batch &left);
    /// Inserts gathered points that threads would put off.
    void insert_near_borders(const Cuts &cuts);
    void report_pass(std::uint64_t done);
    /// Writes everything and begins with an empty cache.
    void hand_over(const Cuts &cuts);
    void forget_cache();
    /// Adds a point that equals a vertex.
    void add_duplicate(const std::uint64_t *record);
    /// Takes in the points of a stage.
    void take_in(Stage<D> &stage);
    /// The same while all points wait, one for each place; or refuses a second point at a place.
    void take_in_distinct(Stage<D> &stage, bool refuses);
    void insert_waiting(std::uint64_t limit);
    /// Removes the repeated points at p.
    void forget_repeated(const Point<D> &p);
    /// Removes points that are all at one place of the triangulation. Returns how many there were.
    std::uint64_t erase(const Point<D> &p, Leaving &leaving);
    /// Removes the first point: the next one gives the vertex its id and attributes; if there is
    /// none, the vertex is removed. Returns 1.
    std::uint64_t pass_on(const Point<D> &p);
    /// Removes the vertex; if a want is given, only a vertex that it accepts. Returns whether there
    /// was one.
    std::uint64_t erase_vertex(const Point<D> &p, Leaving *want = nullptr);
    /// The points left, the neighbours of the vertex last found, span no simplex: they become
    /// waiting points.
    void collapse();
    /// From now on vertices that leave stay where they are, until the rest is triangulated.
    void put_off_removals(std::size_t memory);
    void triangulate_rest();
    /// Moves the repeated points to vertex pages.
    void make_repeated_wait(VertexPageWriter &pages);
    /// Erases all pages of a kind.
    void erase_pages(abacus_page_kind kind);
    /// Starts over without a triangulation.
    void forget_simplices();
    /// Reports every simplex as removed to the change log.
    void log_all_gone();
    void sweep_labels();
    /// Sorts labels and markers by the keys of the new domain; `from` is the old one.
    void rekey_labels(const Domain<D> &from, std::size_t memory);
    /// Counts the point just inserted as one that the domain does not fit if the simplices around
    /// it share a code with more simplices than a page takes.
    void count_crowded();
    /// With this many points to come.
    bool has_outgrown_domain(std::uint64_t coming) const;
    static constexpr std::size_t most_at_once = 64; ///< whose codes are computed together
    using Record = std::array<std::uint64_t, record_words(D, ABACUS_MAX_ATTRIBUTES)>;
    /// Chooses another domain, for all points and those to come, and rebuilds the triangulation
    /// over it. False if no domain serves them far better.
    bool change_domain(const Spread<D> &coming, std::size_t memory);
    void take_apart(Stage<D> &points, std::array<Record, D + 1> &corners);
    void take_repeated(Stage<D> &points);
    /// Runs a change, which returns how many points it has processed, and ends it.
    template <class Change> void change(abacus_header &header, Change change);
    void report(abacus_phase phase, std::uint64_t done, std::uint64_t total);

    const Host &host_;
    const unsigned attributes_;
    const std::size_t cache_bytes_;
    StoredPages *const stored_; ///< null if there are no labels and markers
    bool holds_ = false;        ///< labels and markers
    Domain<D> domain_;
    std::optional<AttributePages<D>> apart_;    ///< if the mesh has its attributes apart
    std::optional<Core> core_;                  ///< always there; optional, to be replaced
    std::optional<RepeatedPoints<D>> repeated_; ///< as well
    std::optional<Rest<D>> rest_;               ///< while removals are put off
    Outlet *outlet_ = nullptr;                  ///< while points leave
    SimplexChanges<D> *changes_ = nullptr;      ///< if somebody wants to know
    abacus_facts *facts_ = nullptr;             ///< of the current change
    abacus_on_duplicate on_duplicate_ = ABACUS_KEEP;
    bool counts_crowded_ = false; ///< the mesh had vertices before these points
    Batch gathered_;
    std::size_t most_gathered_ = 0;      ///< points
    std::uint64_t done_ = 0, to_do_ = 0; ///< gathered points, for reports
    std::chrono::steady_clock::time_point reported_{};
    std::optional<Crew> crew_; ///< the last member: the first to go
};

} // namespace abacus
