// Point location and walking over a stored mesh (dissertation §4.11.3), in a cache
// that lives as long as the reader.
#pragma once

#include "delaunay/walk.hpp"

#include <optional>

namespace abacus {

template <int D> class Reader {
public:
    Reader(const Host &host, const abacus_header &header, std::size_t cache_bytes)
        : Reader(host, header, CacheOptions{.budget = cache_bytes}) {}
    Reader(const Host &host, const abacus_header &header, const CacheOptions &options);

    /// The simplex that contains p; of several, the first by comes_before(). False
    /// outside the hull.
    bool locate(const Point<D> &p, abacus_simplex &simplex);
    /// The neighbour across facet `facet` of the simplex with this code and these ids.
    /// False at the hull; throws an Error (argument) if there is no such simplex.
    bool walk(std::uint64_t code, const std::int64_t *ids, int facet, abacus_simplex &simplex);
    /// Id and attributes of the vertex at p, if there is one; the attributes stay valid
    /// until the next call.
    struct Found {
        std::int64_t id;
        const double *attributes;
    };
    std::optional<Found> vertex_at(const Point<D> &p);

    const Cache<D> &cache() const { return cache_; }
    Cache<D> &cache() { return cache_; }

private:
    /// A simplex with p in its closure, or a ghost that sees p; no_handle in an empty mesh.
    Handle find(const Point<D> &p);
    void describe(Handle h, abacus_simplex &simplex) const;
    /// All simplices around a point on a facet of h; the first of them.
    void first_around(const Point<D> &p, Handle h, abacus_simplex &simplex);

    std::uint64_t size_; // simplices and ghosts
    Cache<D> cache_;
    Walk<D> walk_;
    Handle last_ = no_handle;
};

} // namespace abacus
