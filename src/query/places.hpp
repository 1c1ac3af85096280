// Many places answered at once (the seismograph query of dissertation §1.1, for all seismographs).
//
// Places in the order in which they come lie anywhere; each costs a page that is read and in
// part decoded, or memory that was not used for long. So they are sorted along the curve first,
// as points to be inserted are (staging/stage.hpp): then neighbours come one after the other,
// and a page is read and decoded once for all places in it. What is asked at each place is the
// caller's: which simplex, which value, which vertices (question.hpp).
//
// Several threads answer many (places_threads.hpp).
#pragma once

#include "query/question.hpp"
#include "staging/stage.hpp"

#include <abacus/read.h>

namespace abacus {

template <int D> class Places {
public:
    /// Sorts within `memory` bytes and spools, and keeps `cache_bytes` of simplices.
    Places(const Host &host, const abacus_header &header, std::size_t memory,
           std::size_t cache_bytes)
        : host_(host), header_(header), cache_bytes_(cache_bytes),
          shape_(without_attributes(header)), stage_(host, shape_, memory, false) {}

    /// Of the mesh.
    const abacus_header &header() const { return header_; }
    /// Adds places: an id and D coordinates each.
    void add(const std::uint64_t *places, std::size_t count) { stage_.add(places, count); }
    /// No more come. Asks at each of them, and tells the answers along the curve; once.
    void each(const Question<D> &question);

private:
    class Visitor;

    static abacus_header without_attributes(abacus_header header) {
        header.attributes = 0;
        return header;
    }

    const Host &host_;
    const abacus_header header_;
    const std::size_t cache_bytes_;
    abacus_header shape_; ///< of places: a mesh's, without attributes
    Stage<D> stage_;
};

extern template class Places<2>;
extern template class Places<3>;

} // namespace abacus
