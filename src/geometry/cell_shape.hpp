// The shape of a Voronoi cell: a convex polygon or polytope around its vertex.
//
// It is a list of faces, each a ring of corners: in the plane one face, the cell itself; in space
// those with each neighbour, counterclockwise seen from outside. From each corner an edge leads to
// the next one. What lies beyond that edge is known by a label: a neighbour by its number, a side
// of the window as -1 - side. In space a face has a label too.
//
// A cell inside the window has the corners that the mesh gives it, circumcentres. Any other one
// begins as the window and is cut by the bisector with each neighbour. Which corners go is decided
// in doubles, where these neither underflow nor overflow. A new corner is the place that its labels
// have in common (equidistant.hpp), held between the ends of the edge it lies on: so what is wrong
// with a decision is as little as rounding. Each edge is in two faces with the same ends; therefore
// where a face is left another is entered, and the edges of the new face make closed rings.
#pragma once

#include "geometry/equidistant.hpp"
#include "host/arena.hpp"

#include <cmath>

namespace abacus {

template <int D> class CellShape {
public:
    static constexpr int no_label = std::numeric_limits<int>::min();
    static constexpr int side_label(int side) { return -1 - side; }

    struct Corner {
        Point<D> at; ///< NaN: at infinity
        int next;    ///< the label of the edge to the next corner

        bool is_infinite() const { return std::isnan(at[0]); }
    };
    struct Face {
        int label;
        std::size_t begin, end; ///< of its corners
    };

    explicit CellShape(const Memory &memory)
        : neighbours_(memory), corners_(memory), faces_(memory), cut_corners_(memory),
          cut_faces_(memory), entries_(memory) {}

    /// Forgets all there is.
    void begin(const Point<D> &vertex);
    /// All neighbours are added before anything else, in any order that they alone determine.
    void add_neighbour(const Point<D> &neighbour) { neighbours_.push_back(neighbour); }

    void add_face(int label) { faces_.push_back({label, corners_.size(), corners_.size()}); }
    void add_corner(const Point<D> &at, int next) {
        corners_.push_back({at, next});
        faces_.back().end = corners_.size();
    }
    void add_corner_at_infinity(int next) {
        Point<D> at;
        at.fill(std::numeric_limits<double>::quiet_NaN());
        add_corner(at, next);
    }

    /// The window itself, ...
    void fill(const Box<D> &window);
    /// ... of which what is nearer to a neighbour goes.
    void cut(int neighbour);
    /// Leaves out corners that equal the next one, and faces of fewer than three. Each ring begins
    /// with its least corner.
    void tidy();

    const Arena<Face> &faces() const { return faces_; }
    const Arena<Corner> &corners() const { return corners_; }
    bool is_empty() const { return faces_.empty(); }
    /// Area in the plane, volume in space.
    double content() const;
    /// Of a face.
    double area(const Face &face) const;

private:
    /// Where the new face, of what is cut off, has an edge: on that face, from the edge by which
    /// it is entered to the one by which it is left.
    struct Entry {
        int face, entered, left;
        Point<D> at;
    };

    /// Whether the neighbour is not nearer to a place than the vertex is.
    bool keeps(const Point<D> &at, const Point<D> &neighbour) const;
    Point<D> crossing(int face, int edge, int cut, const Corner &inside,
                      const Corner &outside) const;
    void cut_face(const Face &face, int neighbour);
    /// Makes faces of the edges that have been collected.
    void close(int neighbour);
    void take_cut();
    void add_cut_face(int label) {
        cut_faces_.push_back({label, cut_corners_.size(), cut_corners_.size()});
    }
    void add_cut_corner(const Corner &corner) {
        cut_corners_.push_back(corner);
        cut_faces_.back().end = cut_corners_.size();
    }

    Point<D> vertex_{};
    Box<D> window_;
    Arena<Point<D>> neighbours_;
    Arena<Corner> corners_;
    Arena<Face> faces_;
    Arena<Corner> cut_corners_; // the next ones
    Arena<Face> cut_faces_;
    Arena<Entry> entries_;
};

template <> void CellShape<2>::fill(const Box<2> &window);
template <> void CellShape<3>::fill(const Box<3> &window);
extern template class CellShape<2>;
extern template class CellShape<3>;

} // namespace abacus
