// Staging (dissertation §4.12.2): takes points in any order and writes them to
// vertex pages in the order in which they are to be inserted.
//
// The order is a function of the set of points (and of the input order of equal
// ones) alone: not of the memory, nor of how the points came in.
#pragma once

#include "staging/external_sort.hpp"

#include <optional>

namespace abacus {

template <int D> class Stage {
public:
    Stage(const Host &host, const abacus_header &header, std::size_t memory);

    /// Adds records as in abacus_stage_add.
    void add(const std::uint64_t *points, std::size_t count);
    /// Writes the pages and brings the header up to date.
    void finish(abacus_header &header);

private:
    void copy(const std::uint64_t *points, std::size_t count);
    void spill();
    std::uint64_t points() const { return spool_.size() + buffered_; }

    const Host &host_;
    const unsigned attributes_;
    const std::size_t stride_;
    const std::uint64_t first_; ///< sequence number of the first point
    std::optional<Domain<D>> domain_;
    const SortBudget budget_;
    Pacer pacer_;
    Sample<D> sample_;
    Box<D> box_;
    Arena<std::uint64_t> buffer_;
    std::size_t buffered_ = 0; ///< records in the buffer
    std::size_t room_;         ///< records that may be in the buffer
    Spool spool_;              ///< the records before those, once they are too many
};

extern template class Stage<2>;
extern template class Stage<3>;

} // namespace abacus
