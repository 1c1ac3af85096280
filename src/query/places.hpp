// Many places answered at once (the seismograph query of dissertation §1.1, for all seismographs).
//
// Places in the order in which they come lie anywhere; each costs a page that is read and in
// part decoded, or memory that was not used for long. So they are sorted along the curve first,
// as points to be inserted are (staging/stage.hpp): then neighbours come one after the other,
// and a page is read and decoded once for all places in it. What is asked at each place is the
// caller's: which simplex, which value, which vertices.
#pragma once

#include "points/record.hpp"
#include "query/reader.hpp"
#include "staging/stage.hpp"

#include <abacus/read.h>

namespace abacus {

template <int D> class Places {
public:
    /// Sorts within `memory` bytes and spools, and keeps `cache_bytes` of simplices.
    Places(const Host &host, const abacus_header &header, std::size_t memory,
           std::size_t cache_bytes)
        : shape_(without_attributes(header)), stage_(host, shape_, memory, false),
          reader_(host, header, CacheOptions{.budget = cache_bytes}, true) {}

    /// Adds places: an id and D coordinates each.
    void add(const std::uint64_t *places, std::size_t count) { stage_.add(places, count); }
    /// No more come. Calls answer(reader, id, place) for each of them, along the curve; once.
    template <class Answer> void each(Answer answer) {
        stage_.end(shape_); // a mesh without points has no domain
        Visitor<Answer> visitor(reader_, answer);
        stage_.emit(visitor, shape_);
    }

private:
    /// Gets the places in order.
    template <class Answer> class Visitor final : public RecordSink {
    public:
        Visitor(Reader<D> &reader, Answer &answer) : reader_(reader), answer_(answer) {}

        void add(const std::uint64_t *record) override {
            answer_(reader_, record_id(record), record_point<D>(record));
        }
        void finish() override {}

        abacus_phase phase() const override { return ABACUS_PHASE_LOCATING; }
        PagesMoved pages_moved() const override { return {reader_.pages_read(), 0}; }

    private:
        Reader<D> &reader_;
        Answer &answer_;
    };

    static abacus_header without_attributes(abacus_header header) {
        header.attributes = 0;
        return header;
    }

    abacus_header shape_; ///< of places: a mesh's, without attributes
    Stage<D> stage_;
    Reader<D> reader_;
};

} // namespace abacus
