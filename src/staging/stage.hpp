// Staging (dissertation §4.12.2) takes points in any order and hands them on in insertion order,
// to vertex pages or straight into the mesh. It hands on places to be located in the order of the
// curve.
//
// The order depends on the set of points alone, and on the input order of equal ones. It
// does not depend on the memory, nor on how the points came in. One exception: points for a
// mesh that has vertices near nearly all of them may come in one round (density.hpp).
//
// The order depends on the domain, which is certain only with the last point. But a domain is a
// coarse box around the points (domain_of.hpp), or around nearly all of them (spread.hpp). Once
// the points are too many for memory, the domain of those so far is most often that of all. So
// points are distributed over the parts of the order as they come in. If the domain turns out to
// be another one, they are distributed anew.
#pragma once

#include "points/spread.hpp"
#include "staging/distributor_threads.hpp"
#include "staging/external_sort.hpp"

#include <abacus/facts.h>
#include <optional>

namespace abacus {

template <int D> class Stage {
public:
    /// Without rounds the order is that of the curve alone, as places are best looked for.
    Stage(const Host &host, const abacus_facts &facts, std::size_t memory, bool with_rounds = true);

    /// Adds records as in abacus_stage_add.
    void add(const std::uint64_t *points, std::size_t count);
    /// No more points come. A mesh without a domain gets theirs; of any other the census counts
    /// the points outside its domain.
    void end(abacus_facts &facts);
    /// Hands the points on: in insertion order, or with the rounds in reverse order, in which
    /// points are best taken away. Once, with the facts that end() has seen.
    void emit(RecordSink &sink, const abacus_facts &facts, bool reversed = false);
    /// Ends, writes the points to vertex pages and brings the facts up to date.
    void finish(abacus_facts &facts);

    /// Frees the points, which are not needed after all.
    void drop();

    /// Points so far.
    std::uint64_t points() const { return spilled_ + buffered_; }
    /// Whether its points have so many attributes.
    bool has_attributes(unsigned attributes) const {
        return stride_ == record_words(D, attributes);
    }
    /// Where these are.
    const Spread<D> &spread() const { return spread_; }
    /// What it may use, in bytes.
    std::size_t memory() const { return memory_; }

private:
    /// Copies records in canonical form.
    void copy(const std::uint64_t *points, std::size_t count, std::uint64_t *to);
    void fill_buffer(const std::uint64_t *points, std::size_t count);
    void spill();
    /// Copies records to where the threads take them from.
    void hand_to_threads(const std::uint64_t *points, std::size_t count);
    /// Begins to distribute the points that come, if they are enough for several
    /// rounds.
    void begin_to_distribute();
    /// Adds records to the distributor.
    void distribute(const std::uint64_t *records, std::size_t n);
    /// Ends it: its parts in their order.
    Arena<Part<D>> finish_distributing();
    void stop_distributing();
    /// Ends it as well if the points so far have another domain than the first ones.
    void look_at_domain();
    /// What the points so far would have.
    Domain<D> domain_so_far();
    bool is_distributed_over(const Domain<D> &domain) const;
    bool is_distributed_by(const Slice<D> &slice) const;
    bool mesh_stands_in(const abacus_facts &facts, const Domain<D> &domain);

    const Host &host_;
    const std::size_t stride_;
    const std::size_t memory_;
    const bool with_rounds_;
    const SortBudget budget_;
    Pacer pacer_;
    Sample<D> sample_;
    Spread<D> spread_;
    Arena<std::uint64_t> buffer_;
    std::size_t buffered_ = 0;        ///< records in the buffer
    std::size_t room_;                ///< records that may be in the buffer
    std::uint64_t spilled_ = 0;       ///< the records before those
    std::optional<Domain<D>> domain_; ///< if the header has one from the start
    std::uint64_t outside_ = 0;       ///< points that it does not contain
    std::optional<Rounds<D>> rounds_; ///< of the distributor's slice, if it has any
    std::optional<Distributor<D>> distributor_;
    std::optional<DistributorThreads<D>> threads_; ///< that work on it
    Box<D> distributed_; ///< box of the points when its domain was last looked at
    Arena<Spool> piles_; ///< what is in no distributor; the last one takes more
};

extern template class Stage<2>;
extern template class Stage<3>;

} // namespace abacus
