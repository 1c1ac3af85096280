// Numbers of things that are named more than once: dense, from 0, in the order of their keys. So
// a number depends on the keys alone, not on the order in which they come.
//
// Pages name the same vertices and edges, and none knows how many others have named. No table is
// kept, which would grow with the mesh: the names are sorted by their keys, counted, and sorted
// back into the order in which they came.
#pragma once

#include "sort/record_sort.hpp"

namespace abacus {

class DenseRanks {
public:
    /// Keys of so many words, compared one after the other as unsigned numbers.
    DenseRanks(const Host &host, std::size_t key, std::size_t memory);

    /// At least so many names will be added: throws if spools have no room for them.
    void expect(double names) const { names_.expect(names); }
    /// That so many names take in spools at least.
    double spool_bytes(double names) const { return names_.spool_bytes(names); }
    /// Room for the key of one more name, to be filled before the next call.
    std::uint64_t *add();
    /// Ends adding; returns how many different keys there are.
    std::uint64_t finish();
    /// The number of the name that was added first, then second, and so on; for each one call.
    std::uint64_t next() { return ranks_.next()[1]; }
    /// Gives memory and spools back.
    void close() { ranks_.close(); }

private:
    const std::size_t key_;
    Pacer pacer_;
    Arena<std::uint64_t> last_; // the key counted last
    RecordSort names_;          // the key, and the place among those added
    RecordSort ranks_;          // that place, and the number
};

} // namespace abacus
