// The vertices nearest to a place, nearest first, exactly; of vertices equally far away the
// lexicographically least comes first, of those at one place the one with the least id.
//
// In a Delaunay mesh they are found along edges. Let q be a vertex at the distance d from the place
// p, and let some vertex be nearer. Starting from a point, blow up a ball that touches q from
// inside the ball of radius d around p. When it first meets other vertices, these are within the
// larger ball, so nearer than q. The ball is empty, so the vertices on it are joined to one
// another, however the cells of cospherical ones are cut, and q has a nearer neighbour. Therefore
//
//   descent   from any vertex a way along nearer and nearer neighbours leads to one at the
//             least distance;
//   plateau   all vertices at the least distance are on one empty sphere around p, and are
//             connected;
//   the next  vertex after these is a neighbour of one found before: those found are visited in
//             order, and their neighbours compete for the following ranks.
//
// A candidate that k others come before is dropped. So memory grows with k, and with the simplices
// around what is found, which are in the cache.
//
// In a mesh with fixed edges a nearest vertex need have no nearer neighbour, but the simplices that
// meet a ball around p are connected where the mesh is convex. So simplices are met in order of the
// distance of the facet that leads to them, until the next one is farther away than the k-th
// vertex. None is missed: take a vertex v within that distance, and one that was met. In the ball,
// a straight way leads from it to v, and around each vertex on the way simplices are joined across
// facets of that vertex; so all facets that are crossed meet the ball.
//
// In other meshes pages are read in order of the distance of their boxes, until the next one is
// farther away than the k-th vertex.
#pragma once

#include "geometry/distance.hpp"
#include "host/memory_resource.hpp"
#include "points/record.hpp"
#include "query/locate/reader.hpp"

#include <set>

namespace abacus {

template <int D> class Nearest {
public:
    /// Cheap enough to create for each place: the reader owns what takes long to create.
    explicit Nearest(Reader<D> &reader)
        : reader_(reader), cache_(reader.cache()), memory_(cache_.host()),
          words_(record_words(D, reader.vertex_values().count())), records_(cache_.host()),
          candidates_(Order{p_}, &memory_) {}
    Nearest(const Nearest &) = delete;
    Nearest &operator=(const Nearest &) = delete;

    /// Calls visit(record) for the k vertices nearest to p, all if there are fewer; a record is
    /// valid during the call, in which the reader must not be used.
    template <class Visit> void find(const Point<D> &p, std::uint64_t k, Visit visit) {
        search(p, k);
        for (const Candidate &candidate : candidates_) {
            std::uint64_t *const words = records_.data() + candidate.slot * words_;
            if (reader_.vertex_values().are_elsewhere())
                reader_.vertex_values().all_of(candidate.id, candidate.point,
                                               reinterpret_cast<double *>(words + 1 + D));
            visit(static_cast<const std::uint64_t *>(words));
        }
    }

private:
    struct Candidate {
        Point<D> point;
        std::int64_t id;
        mutable std::size_t slot; // of its record; not part of the order
        Handle simplex;           // with the candidate as a corner, ...
        VertexIndex vertex;
    };
    struct Order {
        const Point<D> &p;
        bool operator()(const Candidate &a, const Candidate &b) const {
            return a.point == b.point ? a.id < b.id : comes_nearer<D>(p, a.point, b.point);
        }
    };
    using Candidates = std::pmr::set<Candidate, Order>;

    void search(const Point<D> &p, std::uint64_t k);
    void search_edges();
    void search_outward();
    void search_pages();
    /// Visits the simplices around all vertices as far away as nearest_, and lets their corners
    /// compete. If one is nearer, it becomes nearest_, and the result is false.
    bool look_around_plateau();
    void look_around(const Candidate &candidate);
    /// Lets a vertex compete.
    void offer(Handle simplex, VertexIndex vertex);
    void offer_corners(Handle simplex) {
        const Simplex<D> &s = cache_.simplex(simplex);
        for (int i = 0; i < s.finite_vertices(); ++i) offer(simplex, s.vertex[i]);
    }
    void forget() {
        candidates_.clear();
        records_.clear();
    }

    Reader<D> &reader_;
    Cache<D> &cache_;
    HostMemory memory_;
    const std::size_t words_; // of a record
    Point<D> p_{};
    std::uint64_t k_ = 0;
    Candidate nearest_{}; // of the vertices met in the descent; without a record
    Arena<std::uint64_t> records_;
    Candidates candidates_; // the first k of all that have been met
};

extern template class Nearest<2>;
extern template class Nearest<3>;

} // namespace abacus
