// Simplices by the names that readers give them: their code and the ids of their corners.
//
// Who gives labels and markers to simplices does not look for them; a room above brings that.
#pragma once

#include <abacus/simplex.h>

#include <cstdint>

namespace abacus {

template <int D> class NamedSimplices {
public:
    /// The simplex with this code and these D + 1 ids. Throws Error (argument) if there is none, or
    /// several.
    virtual void describe(std::uint64_t code, const std::int64_t *ids, abacus_simplex &simplex) = 0;
    /// The one across a facet of it; false at the hull.
    virtual bool walk(std::uint64_t code, const std::int64_t *ids, int facet,
                      abacus_simplex &simplex) = 0;

protected:
    ~NamedSimplices() = default;
};

} // namespace abacus
