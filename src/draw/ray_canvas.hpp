// The canvas of pictures of what is inside: what the rays through the centres of its pixels meet
// in tetrahedra, which come in any order.
//
// No ray is followed from one tetrahedron to the next. Each tetrahedron, when its page is read,
// gives every pixel whose ray passes through it what it has there: how long the ray is inside, and
// the values where it enters and leaves, between which they are linear. Mean, greatest, least and
// sum do not depend on the order (cell projection; Shirley and Tuchman, 1990). So pages are read
// once, as they come, memory is that of the picture, and a mesh may have holes.
//
// A ray must not slip through between two tetrahedra, nor meet two at a facet that it passes
// through. The places of vertices are whole numbers (camera.hpp), and rays are taken to be a little
// to the right and below of the centre, by less than anything there is: so no ray meets an edge. On
// which side of an edge it is all tetrahedra see in the same way. The facets of one, seen from
// anywhere, lie in two sheets over each other. So a ray meets two of them or none, and it leaves
// one tetrahedron where it enters the next.
#pragma once

#include "draw/camera.hpp"
#include "draw/picture.hpp"
#include "host/arena.hpp"

#include <optional>

namespace abacus {

class RayCanvas {
public:
    /// Rays see what is in the box, if there is one.
    RayCanvas(const Host &host, const Camera &camera, abacus_ray_mode mode,
              const std::optional<Box<3>> &box);

    /// A tetrahedron of positive orientation.
    void add(const Sight &a, const Sight &b, const Sight &c, const Sight &d);

    /// What a pixel shows; NaN if its ray has met no value.
    double value(std::int32_t x, std::int32_t y) const;
    /// Whether no ray has met anything.
    bool is_blank() const;
    /// In the colours that the drawing names, with its range and legend.
    Png png(const abacus_drawing &drawing) const;

private:
    using Corners = std::array<const Sight *, 4>;

    struct Pixel {
        double length = 0; // in depth, of what has a value; of the greatest and least 1
        double value = 0;  // so far; NaN: something has been met, but no value
    };
    struct Depths {
        double from, to;
    };
    /// Where a ray passes through a facet.
    struct Hit {
        double depth, value;
    };

    /// Only what is ahead.
    void add_clipped(const Corners &corners);
    void add_prism(const std::array<Sight, 6> &corners);
    void project(const Corners &corners);
    template <class Number>
    void fill(const Corners &corners, std::int32_t left, std::int32_t right, std::int32_t top,
              std::int32_t bottom);
    void deposit(std::int32_t x, std::int32_t y, Hit enters, Hit leaves);
    std::pair<double, double> range(const abacus_drawing &drawing) const;
    std::size_t index(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) +
               static_cast<std::size_t>(x);
    }

    const Host &host_;
    const Camera &camera_;
    const abacus_ray_mode mode_;
    Arena<Pixel> pixels_;
    Arena<Depths> depths_; // inside the box; empty if there is none
    Arena<Hit> enters_;    // of the row at hand: where rays enter the tetrahedron
};

} // namespace abacus
