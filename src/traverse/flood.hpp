// A breadth-first search from a simplex, across the facets that the caller allows: the star of
// a vertex, all simplices around a place, those within a window. Each simplex is met once.
//
// Memory grows with the handles of the mesh, a byte each, and with the answer.
#pragma once

#include "traverse/marks.hpp"
#include "traverse/topology.hpp"

#include <algorithm>

namespace abacus {

template <int D> class Flood {
public:
    explicit Flood(const Memory &memory) : marks_(memory), met_(memory), ahead_(memory) {}

    /// Calls visit(h) for each simplex when it is met, the first one too, until that returns
    /// false; returns whether it never did. crosses(h, facet) tells whether the flood goes on
    /// there.
    template <Topology<D> Mesh, class Crosses, class Visit>
    bool from(Mesh &mesh, Handle first, Crosses crosses, Visit visit) {
        met_.clear();
        bool goes_on = meet(first, visit);
        for (std::size_t n = 0; goes_on && n < met_.size(); ++n) {
            if (n % 4096 == 4095) mesh.poll();
            for (int i = 0; goes_on && i <= D; ++i) {
                const Handle h = met_[n];
                if (!crosses(h, i)) continue;
                const Handle beyond = link_simplex(mesh.cross(h, i));
                if (marks_.get(beyond) == Marks::none) goes_on = meet(beyond, visit);
            }
        }
        forget_marks();
        return goes_on;
    }
    /// The star of a vertex: from a simplex that has it across all facets that do.
    template <Topology<D> Mesh, class Visit>
    bool around(Mesh &mesh, Handle first, VertexIndex v, Visit visit) {
        const auto has_vertex = [&](Handle h, int facet) {
            return mesh.simplex(h).vertex[facet] != v;
        };
        return from(mesh, first, has_vertex, visit);
    }

    /// In the order of the ranks of the facets that lead to them: rank(h, facet) is a number. Calls
    /// visit(h) for each simplex when it is met, as long as is_within(rank) holds for the next one.
    template <Topology<D> Mesh, class Rank, class IsWithin, class Visit>
    void by_rank(Mesh &mesh, Handle first, Rank rank, IsWithin is_within, Visit visit) {
        met_.clear();
        ahead_.clear();
        const auto meet_at = [&](Handle h, int from) {
            meet(h, visit);
            for (int i = 0; i <= D; ++i)
                if (i != from) {
                    ahead_.push_back({rank(h, i), make_link(h, i)});
                    std::push_heap(ahead_.begin(), ahead_.end());
                }
        };
        for (meet_at(first, D + 1); !ahead_.empty() && is_within(ahead_[0].rank);) {
            const Link facet = ahead_[0].facet;
            std::pop_heap(ahead_.begin(), ahead_.end());
            ahead_.pop_back();
            const Link beyond = mesh.cross(link_simplex(facet), link_facet(facet));
            if (marks_.get(link_simplex(beyond)) != Marks::none) continue;
            if (met_.size() % 4096 == 4095) mesh.poll();
            meet_at(link_simplex(beyond), link_facet(beyond));
        }
        forget_marks();
    }

    /// After a flood that has thrown: the next one begins anew.
    void give_up() {
        forget_marks();
        met_.clear();
    }

    /// What the last flood met, in its order.
    const Arena<Handle> &met() const { return met_; }

private:
    void forget_marks() {
        for (const Handle h : met_) marks_.set(h, Marks::none);
    }
    template <class Visit> auto meet(Handle h, Visit &visit) {
        marks_.set(h, Marks::inside);
        met_.push_back(h);
        return visit(h);
    }

    struct Ahead {
        double rank;
        Link facet; // of a simplex that has been met
        bool operator<(const Ahead &other) const { return other.rank < rank; }
    };

    Marks marks_;
    Arena<Handle> met_;
    Arena<Ahead> ahead_; // a heap
};

} // namespace abacus
