// Many places located at once (the seismograph query of dissertation §1.1, for all seismographs).
//
// Places in the order in which they come lie anywhere; each costs a page that is read and in
// part decoded, or memory that was not used for long. So they are sorted along the curve first,
// as points to be inserted are (staging/stage.hpp): then neighbours come one after the other,
// and a page is read and decoded once for all places in it.
#pragma once

#include "query/reader.hpp"
#include "staging/stage.hpp"

#include <abacus/read.h>

namespace abacus {

template <int D> class Places {
public:
    /// Sorts within `memory` bytes and spools, and keeps `cache_bytes` of simplices.
    Places(const Host &host, const abacus_header &header, std::size_t memory,
           std::size_t cache_bytes);

    /// Adds places: an id and D coordinates each.
    void add(const std::uint64_t *places, std::size_t count) { stage_.add(places, count); }
    /// No more come. Reports each of them, along the curve; once.
    void locate(abacus_place_report report, void *context);

private:
    class Locator;

    abacus_header shape_; ///< of places: a mesh's, without attributes
    Stage<D> stage_;
    Reader<D> reader_;
};

extern template class Places<2>;
extern template class Places<3>;

} // namespace abacus
