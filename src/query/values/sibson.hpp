// Natural neighbours: the weights of Sibson ("A brief description of natural neighbour
// interpolation", 1981), in the plane and in space.
//
// If p were a vertex, its Voronoi cell would consist of parts of the cells of others. The weight of
// a vertex is its share of that cell. The part taken from v is a polytope. Its corners are the
// circumcentres x of the simplices at v whose circumsphere contains p, which form the zone, and the
// circumcentres y of p with the facets on the rim of the zone at v. Its facets are parts of the
// bisectors of v and its neighbours w, and of p and v. By the divergence theorem, with p as the
// origin, its volume is 1/D of the sum of each facet's area times its distance from p:
//
//   share(v) = Σ A(v, w) s(v, w) + A(p, v) |v| / 2,   s(v, w) = (w² − v²) / (2 |w − v|) = −s(w, v).
//
// So an error in A(v, w) moves from one share to another but does not change their sum, and the
// distances s come from vertices, not from circumcentres, which may be far away. No order of the
// corners is needed. In the plane A is the length of an edge of a cell, and each of its ends
// contributes its part. In space it is the area of a polygon; each of its sides, which is dual to a
// facet of the mesh, adds ½ (x × x') · n, and it has the same x and x' in three polygons, those of
// the edges of that facet. The facets are those between two simplices of the zone, those on its
// rim, and those that p would form with the ridges of the rim.
//
// In a mesh with lines the zone ends at hard edges, as a cell's share does at the hull: what lies
// beyond is not seen, and the cell of p goes on there as if nothing did. Soft edges do not matter:
// see soft_zone.hpp.
//
// The predicates of the triangulation find the zone, so it is star-shaped around p, as when p is
// inserted.
//
// Everything is added in an order of the coordinates: that of neighbours, of simplices by their
// neighbours, and of the corners of each. So the weights are the same to the last bit whatever the
// history of the mesh, and whichever simplex around p the search began with.
#pragma once

#include "delaunay/ridges.hpp"
#include "query/locate/reader.hpp"
#include "query/values/soft_zone.hpp"
#include "query/values/zone.hpp"

namespace abacus {

template <int D> class Sibson {
public:
    explicit Sibson(const Host &host)
        : soft_zone_(host), marks_(host), met_(host), beyond_(host), places_(host), zone_(host),
          members_(host), ranks_(host), numbers_(host), seen_(host), shares_(host), centres_(host),
          rim_(host), ridges_(host) {}

    /// Finds the natural neighbours of p, which lies in the closure of a finite simplex of a
    /// Delaunay mesh, constrained or not, and is not a vertex. False if p is on the hull or on a
    /// hard edge, where cells are unbounded, or if doubles cannot represent the weights.
    bool find(Cache<D> &cache, Handle h, const Point<D> &p, bool has_soft_lines);

    /// The result of find(): the neighbours and their weights, which sum to 1.
    std::size_t count() const { return numbers_.size(); }
    VertexIndex vertex(std::size_t i) const { return numbers_[i]; }
    double weight(std::size_t i) const { return shares_[i]; }

private:
    /// A facet on the rim of the zone, seen from outside counterclockwise (in the plane the zone is
    /// to the left of it); by numbers of neighbours.
    struct RimFacet {
        std::array<std::uint32_t, D> vertex;
        Point<D> centre; ///< of the sphere through them and p
    };

    /// A simplex of the zone: its corners by their numbers, the least first, and which corner of
    /// the simplex each is.
    struct Member {
        std::array<std::uint32_t, D + 1> number;
        std::array<std::uint8_t, D + 1> corner;
        std::uint32_t found; ///< its place in zone_
    };

    /// A simplex of the cache, and its number in the zone.
    struct Place {
        Handle simplex;
        std::uint32_t number;
    };

    bool find_zone(Cache<D> &cache, Handle h, const Point<D> &p);
    /// Describes the zone that has been met in the cache.
    void describe_zone(Cache<D> &cache);
    void see(Cache<D> &cache, const Point<D> &p);
    void order_zone(Cache<D> &cache);
    /// The facet of a simplex as in RimFacet, its least neighbour first.
    std::array<std::uint32_t, D> facet_of(Cache<D> &cache, const ZoneSimplex<D> &s, int facet);
    /// Adds the contributions across the facets of the n-th member.
    void add_simplex(Cache<D> &cache, std::size_t n);
    /// Adds a side, from circumcentre `from` to `to`, of the dual of a facet.
    void add_side(const std::array<std::uint32_t, D> &facet, const Point<D> &from,
                  const Point<D> &to);
    /// Adds the facets between p and the rim.
    void add_ridges();
    bool normalize();
    Point<D> centre(const std::uint32_t *numbers, int n) const;

    SoftZone soft_zone_;
    Marks marks_;
    Arena<Handle> met_;    // the zone in the cache, in the order of discovery
    Arena<Handle> beyond_; // D + 1 for each, across its facets
    Arena<Place> places_;  // of these by handles
    Arena<ZoneSimplex<D>> zone_;
    Arena<Member> members_;      // the zone in order
    Arena<std::uint32_t> ranks_; // of the zone: the numbers of the members
    typename VertexHeap<D>::Numbering numbers_;
    Arena<Point<D>> seen_; // the neighbours from p, scaled
    Arena<double> shares_;
    Arena<Point<D>> centres_; // of the members
    Arena<RimFacet> rim_;
    Ridges ridges_;
    const Cache<D> *cache_ = nullptr; // of the neighbours
    Point<D> p_{};
    std::array<double, 3> scale_{1, 1, 1};
};

template <> void Sibson<2>::add_ridges();
template <> void Sibson<3>::add_ridges();
extern template class Sibson<2>;
extern template class Sibson<3>;

} // namespace abacus
