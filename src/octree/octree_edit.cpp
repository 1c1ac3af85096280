#include "octree/octree_edit.hpp"

#include "blocks/counters.hpp"
#include "octree/outside.hpp"

#include <cstring>

namespace abacus {

template <int D> void OctreeEdit<D>::merge_at(const Point<D> &place, std::int64_t level) {
    Cell<D> cell;
    if (!grid_.find(place, cell)) throw_outside<D>(place);
    if (level < 0 || level > finest_level<D>) throw_no_level(level, finest_level<D>);
    const auto octant =
        Octant<D>{morton<D>(cell), finest_level<D>}.ancestor(static_cast<int>(level));
    const std::uint64_t number = changes_.size();
    std::uint64_t *const record = changes_.add();
    record[0] = octant.code;
    record[1] = static_cast<std::uint64_t>(level);
    record[2] = number;
    std::fill_n(record + 3, attributes_, 0);
}

template <int D> void OctreeEdit<D>::set_at(std::uint64_t cell, const double *values) {
    if (cell >= domain_cells<D>)
        throw Error(ABACUS_ERROR_ARGUMENT,
                    "no octant has the code " + std::to_string(static_cast<std::int64_t>(cell)));
    const std::uint64_t number = changes_.size();
    std::uint64_t *const record = changes_.add();
    record[0] = cell;
    record[1] = 0;
    record[2] = number;
    std::memcpy(record + 3, values, attributes_ * sizeof *values);
}

template <int D> std::uint64_t OctreeEdit<D>::merge(abacus_header &header) {
    // If several begin at the same cell, the coarsest comes first.
    changes_.finish();
    pacer_.begin(ABACUS_PHASE_LOCATING, changes_.size());
    std::uint64_t merged = 0, done = 0;
    while (const std::uint64_t *change = changes_.next()) {
        const std::uint64_t leaves = cache_.merge({change[0], static_cast<int>(change[1])});
        if (leaves > 1) {
            merged += leaves;
            header.facts.census.leaves -= leaves - 1;
        }
        reached(++done);
    }
    finish(header);
    return merged;
}

template <int D> std::uint64_t OctreeEdit<D>::set(abacus_header &header) {
    changes_.finish();
    pacer_.begin(ABACUS_PHASE_LOCATING, changes_.size());
    std::uint64_t set = 0, done = 0, end = 0, last = 0;
    while (const std::uint64_t *change = changes_.next()) {
        const Handle h = cache_.find(change[0]);
        // The rows of a leaf follow one another, ordered by their cells.
        if (cache_.octant(h).end() != end) {
            ++set;
            end = cache_.octant(h).end();
            last = 0;
        }
        if (change[2] >= last) {
            last = change[2];
            cache_.set_values(h, reinterpret_cast<const double *>(change + 3));
        }
        reached(++done);
    }
    finish(header);
    return set;
}

template <int D> void OctreeEdit<D>::reached(std::uint64_t done) {
    host_.poll();
    if (done % 64 == 0) pacer_.reached(done, {cache_.counters.loads, cache_.counters.stores});
}

template <int D> void OctreeEdit<D>::finish(abacus_header &header) {
    changes_.close();
    cache_.flush();
    header.counters += cache_.counters;
}

template class OctreeEdit<2>;
template class OctreeEdit<3>;

} // namespace abacus
