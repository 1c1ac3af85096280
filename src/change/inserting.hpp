// Points on their way into the triangulation: those of a stage, or those that wait on vertex pages.
//
// With several threads they are gathered as long as they come along the curve, and inserted
// together (gathering.hpp).
#pragma once

#include "change/gathering.hpp"
#include "delaunay/first_simplex.hpp"
#include "points/record_sink.hpp"
#include "staging/stage.hpp"

#include <abacus/build.h>

#include <array>

namespace abacus {

template <int D> class Inserting final : private Gathering<D>::User {
public:
    Inserting(Workspace<D> &work, Gathering<D> &gathering) : work_(work), gathering_(gathering) {}
    Inserting(const Inserting &) = delete;
    Inserting &operator=(const Inserting &) = delete;

    /// Inserts at most `limit` of the points that wait (0 = all).
    void insert_waiting(std::uint64_t limit);
    /// Inserts the points of a stage; points that equal others as on_duplicate says.
    void insert(Stage<D> &stage, abacus_on_duplicate on_duplicate);

    // For the records of a sink, one after the other (intake.hpp):
    /// About `points` points come.
    void begin(std::uint64_t points);
    /// Makes the first simplex of points of these records.
    void start(const std::array<const std::uint64_t *, D + 1> &records);
    /// Adds points, which may be gathered.
    void add(const std::uint64_t *records, std::size_t n);
    void add(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n);
    /// After the last.
    void finish() { gathering_.finish(); }
    /// While the next ones are looked for.
    void meanwhile() { gathering_.meanwhile(); }
    std::size_t held_back() const { return gathering_.size(); }
    Workspace<D> &work() { return work_; }

private:
    Deed deed() const override { return Deed::insert; }
    bool is_shared() const override { return true; }
    bool keeps_left() const override { return on_duplicate_ == ABACUS_REPLACE; }
    void take(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n) override;
    void finish_here() override {}
    void take_left(const std::uint64_t *record) override { add_duplicate(record); }
    const typename Gathering<D>::Removing *begin_sharing() override { return nullptr; }
    void end_sharing() override {}
    bool counts_crowded() const override { return counts_crowded_; }

    void insert_stage(Stage<D> &stage);
    /// The same while all points wait, one for each place; or refuses a second point at a place.
    void insert_distinct(Stage<D> &stage, bool refuses);
    /// Makes the first simplex of points that wait; false if they span none.
    bool start_waiting(FirstSimplex<D> &first);
    void store_attributes(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n);
    /// Adds a point that equals a vertex.
    void add_duplicate(const std::uint64_t *record);
    /// Counts the point just inserted as one that the domain does not fit if the simplices around
    /// it share a code with more simplices than a page takes.
    void count_crowded() {
        if (work_.core->mesh.is_crowded()) ++work_.facts->census.outside;
    }

    Workspace<D> &work_;
    Gathering<D> &gathering_;
    abacus_on_duplicate on_duplicate_ = ABACUS_KEEP;
    bool counts_crowded_ = false; ///< the mesh had vertices before these points
};

extern template class Inserting<2>;
extern template class Inserting<3>;

} // namespace abacus
