// Faces between the fixed edges of a mesh in the plane: which one lies beside an edge.
//
// A face is a set of triangles that can be reached from each other without crossing a fixed edge.
// Its border is a closed walk around it, and one around each group of fixed edges within it. Every
// walk has the face on its left, and turns at each end of an edge to the next fixed one clockwise.
// A face is named by the least edge of its outer walk.
//
// From an inner walk the outer one is found so: no fixed edge leads from its least vertex to a
// lesser one, so straight on towards lesser x the face goes on, up to another fixed edge. That is
// on the outer walk, or on an inner one whose least vertex is less.
//
// The least vertex of a walk shows which kind it is. An outer walk has the face on the greater side
// of it. If the face comes round that vertex on the lesser side as well, the walk is an inner one.
#pragma once

#include "host/arena.hpp"
#include "mesh/cache.hpp"

#include <functional>
#include <optional>

namespace abacus {

class Faces {
public:
    /// A fixed edge, with a face on its left.
    struct Edge {
        Point<2> from, to;
        auto operator<=>(const Edge &) const = default;
    };
    /// What walks need of those whose cache it is.
    struct Access {
        /// A triangle at this vertex, and its corner there; throws if there is none.
        std::function<Link(const Point<2> &)> corner_at;
        /// Trims the cache; called at times, when no handle is needed any more.
        std::function<void()> trim;
    };
    Faces(Cache<2> &cache, Access access);

    /// Edges whose faces will be asked for: what is found out about one of them is kept.
    void clear();
    void add(const Edge &edge) { known_.push_back({edge, unknown}); }
    /// After all have been added.
    void sort();
    std::size_t size() const { return known_.size(); }
    const Edge &operator[](std::size_t i) const { return known_[i].edge; }

    /// The name of the face on the left of an edge; none if it reaches the border of the mesh. All
    /// that was cached may be gone.
    std::optional<Edge> name(const Edge &edge);
    /// The same for the face that has a triangle.
    std::optional<Edge> name(Handle triangle);
    /// Edges passed and triangles crossed so far.
    std::uint64_t steps() const { return steps_; }

private:
    static constexpr std::uint32_t unknown = ~std::uint32_t{0};
    static constexpr std::uint64_t most_steps_at_once = 4096;
    struct Known {
        Edge edge;
        std::uint32_t name; // its number in names_
    };
    /// What a walk has shown.
    struct Walked {
        Edge least;
        bool is_inner = false;
        std::uint32_t name = unknown; // if a known edge is on it
    };

    Edge edge_of(Link edge) const;
    Link find(const Edge &edge);
    Known *known(const Edge &edge);
    /// Counts a step; whether the cache should be trimmed.
    bool step() { return ++steps_ % most_steps_at_once == 0; }
    /// Trims the cache, and finds the edge again.
    void rest(Link &edge);
    /// Gives the face that is being named its name.
    std::optional<Edge> end(std::uint32_t name);

    /// The next fixed edge clockwise around the beginning of an edge; `unset` after a whole turn.
    /// None if there is a ghost before it.
    std::optional<Link> turn(Link edge);
    std::optional<Walked> walk(const Edge &begin);
    /// The fixed edge that comes first on the way from a vertex towards lesser x; none if that
    /// leaves the mesh.
    std::optional<Link> straight_to_lesser(Point<2> at);
    /// The same for a way across a triangle, up to a vertex; then a corner is returned.
    struct Met {
        Link link = unset;
        bool is_edge = false;
    };
    Met cross(Link edge, const Point<2> &from, const Point<2> &to);
    /// A fixed edge at the corner of a triangle, with the face of the triangle on its left; `unset`
    /// if there is none at that vertex, none as in turn().
    std::optional<Link> border_at(Link corner) {
        return turn(make_link(link_simplex(corner), (link_facet(corner) + 2) % 3));
    }

    Cache<2> &cache_;
    const Access access_;
    Arena<Known> known_;
    Arena<Edge> names_;
    Arena<std::size_t> passed_; // of known_: beside the face that is being named
    std::uint64_t steps_ = 0;
};

} // namespace abacus
