// Corners of the hull of a mesh's vertices that span a simplex, found without a triangulation.
//
// The vertices that come first or last on an axis, of several the lexicographically least or
// greatest, are corners of the hull. If all of them lie on a line or in a plane, the vertex
// farthest from it is one more: of several as far, the lexicographically least is a corner.
#pragma once

#include "geometry/predicates.hpp"
#include "thin/source_vertices.hpp"

namespace abacus {

template <int D> class Extremes {
public:
    /// `words`: of a vertex, as in a candidate.
    Extremes(const Host &host, const abacus_facts &facts, std::uint32_t attribute,
             std::size_t words);

    /// Finds them; throws if the vertices with values span no simplex.
    void find();
    std::size_t size() const { return count_; }
    const std::uint64_t *vertex(std::size_t i) const { return found_.data() + i * words_; }

private:
    template <class Visit> void each(Visit visit) const;
    Point<D> point(std::size_t i) const { return vertex_point<D>(vertex(i)); }
    void add(const std::uint64_t *vertex);
    void find_on_axes();
    /// The first of those found that are affinely independent, at most D + 1.
    std::size_t independent(std::array<Point<D>, D + 1> &points) const;
    void find_farthest(const std::array<Point<D>, D + 1> &from, std::size_t count);

    const Host &host_;
    const abacus_facts facts_;
    const std::uint32_t attribute_;
    const std::size_t words_;
    std::size_t count_ = 0;
    Arena<std::uint64_t> found_;
};

} // namespace abacus
