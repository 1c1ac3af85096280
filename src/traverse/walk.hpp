// Point location by a remembering stochastic walk (Devillers, Pion, Teillaud, "Walking in
// a Triangulation", 2002; dissertation §4.11.3): from simplex to simplex across a facet
// that separates it from the target, never back through the one it came in by, the first
// facet tried drawn at random. In a Delaunay triangulation no such walk visits a simplex
// twice. So a walk with more steps than the mesh has simplices shows that the mesh is damaged. In a
// constrained one it may go round in circles for a while; each time it passes a simplex with two
// facets to choose from, it leaves the circle with a chance of one half. There only a great many
// more steps show damage. Other meshes may have a boundary that is not the hull, where a walk ends;
// within() tells.
#pragma once

#include "traverse/separator.hpp"

namespace abacus {

/// The most steps that a walk may take in a sound mesh with so many simplices, ghosts included.
constexpr std::uint64_t longest_walk(std::uint64_t simplices, bool is_constrained) {
    constexpr std::uint64_t rounds = 64, few = 4096;
    return is_constrained ? rounds * simplices + few : simplices;
}

template <int D, Topology<D> Mesh> class Walk {
public:
    /// `far`: walks begin far from where they lead, among simplices that have not been used for
    /// long.
    explicit Walk(Mesh &mesh, bool far = false) : mesh_(mesh), far_(far) {}

    /// Whether p is so close to a simplex, measured by the simplex's own size, that a walk
    /// from there is short, thin simplices included. It is only a guess, so overflows do no
    /// harm.
    bool is_close(Handle h, const Point<D> &p) const {
        const Simplex<D> &s = mesh_.simplex(h);
        const Point<D> &a = mesh_.point(s.vertex[0]), &b = mesh_.point(s.vertex[1]);
        double size = 0, distance = 0;
        for (int i = 0; i < D; ++i) {
            size += (b[i] - a[i]) * (b[i] - a[i]);
            distance += (p[i] - a[i]) * (p[i] - a[i]);
        }
        return distance <= 64 * size;
    }

    /// The simplex that contains p in its closure; a ghost whose hull facet has p
    /// strictly beyond it if p lies outside the hull. The mesh fills its convex hull.
    /// `longest`: longest_walk() of it.
    Handle to(const Point<D> &p, Handle from, std::uint64_t longest) {
        const Handle h = within(p, from, longest);
        if (h == no_handle) throw_corrupted("A walk in the mesh does not end.");
        return h;
    }
    /// The same; no_handle after `longest` steps.
    Handle within(const Point<D> &p, Handle from, std::uint64_t longest) {
        if constexpr (requires { mesh_.counters.walks; }) ++mesh_.counters.walks;
        Handle h = from;
        Separator<D, Mesh> separator(mesh_, p);
        int entered = separator.none;
        // From a ghost inside through its hull facet, beyond which p may well lie.
        if (mesh_.simplex(h).is_ghost()) h = link_simplex(mesh_.cross(h, D));
        for (std::uint64_t steps = 0;; ++steps) {
            if (steps % 4096 == 4095) mesh_.poll();
            if (steps > longest) return no_handle;
            const Simplex<D> &s = mesh_.simplex(h);
            if (s.is_ghost()) return h;
            if constexpr (requires { mesh_.ask_for_neighbours(s); })
                if (far_) mesh_.ask_for_neighbours(s);
            const int separating = separator.find(s, entered, random());
            if (separating == separator.none) {
                ends_on_facet_ = separator.is_on_facet();
                return h;
            }
            const Link link = mesh_.cross(h, separating);
            h = link_simplex(link);
            entered = link_facet(link);
        }
    }

    /// Whether the point that the last walk led to is on a facet of the simplex, which is finite:
    /// not strictly inside.
    bool ends_on_facet() const { return ends_on_facet_; }

private:
    // xorshift; the walk's path depends on it, its end does not.
    std::uint32_t random() {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 17;
        state_ ^= state_ << 5;
        return state_;
    }

    Mesh &mesh_;
    const bool far_;
    std::uint32_t state_ = 2463534242u;
    bool ends_on_facet_ = false;
};

} // namespace abacus
