// Simplices by the names under which readers return them: their code and the ids of their corners.
//
// Code that gives labels and markers to simplices does not look them up itself; a room above
// provides that.
#pragma once

#include <abacus/simplex.h>

#include <cstdint>

namespace abacus {

template <int D> class NamedSimplices {
public:
    /// The simplex with this code and these D + 1 ids. Throws Error (argument) if there is none, or
    /// several.
    virtual void describe(std::uint64_t code, const std::int64_t *ids, abacus_simplex &simplex) = 0;
    /// Its neighbour across a facet; false at the hull.
    virtual bool walk(std::uint64_t code, const std::int64_t *ids, int facet,
                      abacus_simplex &simplex) = 0;

protected:
    ~NamedSimplices() = default;
};

} // namespace abacus
