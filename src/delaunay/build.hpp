// A build: staged points, in their order, into the mesh (dissertation §4.12.5).
#pragma once

#include "delaunay/insertion.hpp"
#include "staging/vertex_reader.hpp"

namespace abacus {

template <int D> class Build {
public:
    Build(const Host &host, const abacus_header &header, std::size_t cache_bytes);

    /// Inserts at most `limit` further points (0 = all), writes all changed pages and
    /// brings the header up to date. While the points span no simplex the mesh stays
    /// empty: all of them are looked at again when more have been staged.
    void run(std::uint64_t limit, abacus_header &header);

private:
    using Sequences = std::array<std::uint64_t, D + 1>;

    /// Sequence numbers of the first affinely independent points: what the mesh starts
    /// with, since no mesh of fewer dimensions is kept. Depends on the points alone.
    bool find_first_simplex(const abacus_header &header, Sequences &sequences);
    void start(const Sequences &sequences);
    void report(abacus_phase phase, std::uint64_t done, std::uint64_t total);

    const Host &host_;
    unsigned attributes_;
    Cache<D> cache_;
    Delaunay<D> mesh_;
    Insertion<D> insertion_;
    Arena<double> values_; // attributes of the point at hand
};

/// Adds up counters of several builds; peaks are maxima.
void add_counters(abacus_counters &sum, const abacus_counters &more);

} // namespace abacus
