// Many places in an octree at once: sorted along the curve first, so that a page is read and
// decoded once for all places in it.
#pragma once

#include "octree/octree_reader.hpp"
#include "sort/pacer.hpp"
#include "sort/record_sort.hpp"

#include <bit>

namespace abacus {

template <int D> class OctreePlaces {
public:
    /// Sorts within `memory` bytes and spools, and keeps `cache_bytes` of leaves.
    OctreePlaces(const Host &host, const abacus_facts &facts, std::size_t memory,
                 std::size_t cache_bytes)
        : pacer_(host), places_(host, words, words, memory), reader_(host, facts, cache_bytes) {
        pacer_.begin(ABACUS_PHASE_READING, 0);
    }

    OctreeReader<D> &reader() { return reader_; }

    /// A place: an id and D coordinates. Outside the domain it comes where the domain is nearest.
    void add(const std::uint64_t *place) {
        std::uint64_t *const record = places_.add();
        std::copy_n(place, 1 + D, record + 1);
        record[0] = morton<D>(reader_.grid().nearest_cell(point(record)));
        if (places_.size() % Pacer::stride == 0) pacer_.reached(places_.size());
    }
    /// Calls visit(id, place) for each of them, along the curve; once.
    template <class Visit> void each(Visit visit) {
        places_.finish();
        pacer_.begin(ABACUS_PHASE_LOCATING, places_.size());
        std::uint64_t done = 0;
        while (const std::uint64_t *record = places_.next()) {
            visit(static_cast<std::int64_t>(record[1]), point(record));
            pacer_.reached(++done, {reader_.cache().counters.loads, 0});
        }
        places_.close();
    }

private:
    static constexpr std::size_t words = 2 + D;

    static Point<D> point(const std::uint64_t *record) {
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = std::bit_cast<double>(record[2 + i]);
        return p;
    }

    Pacer pacer_;
    RecordSort places_; // code, id, coordinates
    OctreeReader<D> reader_;
};

} // namespace abacus
