// Answers many places at once (the seismograph query of dissertation §1.1, for all seismographs).
//
// Consecutive places of the input may be far apart; then each costs a page that is read and partly
// decoded, or memory that is cold. So they are first sorted along the curve, like points to be
// inserted (staging/stage.hpp): then neighbours come one after the other, and a page is read and
// decoded once for all places in it. The caller decides what to find at each place: which simplex,
// which value, which vertices (question.hpp).
//
// Several threads answer if there are many (places_threads.hpp).
#pragma once

#include "query/places/question.hpp"
#include "staging/stage.hpp"

#include <abacus/facts.h>

namespace abacus {

template <int D> class Places {
public:
    /// Sorts within `memory` bytes and spools, and keeps `cache_bytes` of simplices.
    Places(const Host &host, const abacus_facts &facts, std::size_t memory, std::size_t cache_bytes)
        : host_(host), facts_(facts), cache_bytes_(cache_bytes), shape_(without_attributes(facts)),
          stage_(host, shape_, memory, false) {}

    /// Of the mesh.
    const abacus_facts &facts() const { return facts_; }
    /// Adds places: an id and D coordinates each.
    void add(const std::uint64_t *places, std::size_t count) { stage_.add(places, count); }
    /// No more places come. Answers all of them and reports the answers along the curve; once.
    void each(const Question<D> &question);

private:
    class Visitor;

    static abacus_facts without_attributes(abacus_facts facts) {
        facts.columns.attributes = 0;
        return facts;
    }

    const Host &host_;
    const abacus_facts facts_;
    const std::size_t cache_bytes_;
    abacus_facts shape_; ///< of places: a mesh's, without attributes
    Stage<D> stage_;
};

extern template class Places<2>;
extern template class Places<3>;

} // namespace abacus
