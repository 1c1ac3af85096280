// p4est's names in each dimension, for the program that compares octrees with its own, and for the
// one that times it. The library is Debian's, and GPL: only these two programs link it.
#pragma once

#include <mpi.h>

#include <p4est_bits.h>
#include <p4est_extended.h>
#include <p4est_ghost.h>
#include <p4est_lnodes.h>
#include <p8est_bits.h>
#include <p8est_extended.h>
#include <p8est_ghost.h>
#include <p8est_lnodes.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace abacus::test {

template <int D> struct Foreign;

template <> struct Foreign<2> {
    using Forest = p4est_t;
    using Quadrant = p4est_quadrant_t;
    static constexpr int levels = P4EST_MAXLEVEL, finest = P4EST_QMAXLEVEL;

    static std::array<std::uint32_t, 2> cell(const Quadrant *q) {
        return {static_cast<std::uint32_t>(q->x), static_cast<std::uint32_t>(q->y)};
    }
    static auto unit() { return p4est_connectivity_new_unitsquare(); }
    static void destroy(p4est_connectivity_t *c) { p4est_connectivity_destroy(c); }
    static Forest *forest(p4est_connectivity_t *c, void *user) {
        return p4est_new_ext(sc_MPI_COMM_WORLD, c, 0, 0, 1, 0, nullptr, user);
    }
    static void refine(Forest *f, p4est_refine_t split) { p4est_refine(f, 1, split, nullptr); }
    static void balance(Forest *f, int across) {
        p4est_balance(f, across == 1 ? P4EST_CONNECT_FACE : P4EST_CONNECT_FULL, nullptr);
    }
    static Quadrant *quadrant(Forest *f, std::size_t i) {
        return p4est_quadrant_array_index(&p4est_tree_array_index(f->trees, 0)->quadrants, i);
    }
    static auto nodes(Forest *f) {
        p4est_ghost_t *ghost = p4est_ghost_new(f, P4EST_CONNECT_FULL);
        p4est_lnodes_t *nodes = p4est_lnodes_new(f, ghost, 1);
        p4est_ghost_destroy(ghost);
        return nodes;
    }
    static void destroy(p4est_lnodes_t *n) { p4est_lnodes_destroy(n); }
    static void destroy(Forest *f) { p4est_destroy(f); }
};

template <> struct Foreign<3> {
    using Forest = p8est_t;
    using Quadrant = p8est_quadrant_t;
    static constexpr int levels = P8EST_MAXLEVEL, finest = P8EST_QMAXLEVEL;

    static std::array<std::uint32_t, 3> cell(const Quadrant *q) {
        return {static_cast<std::uint32_t>(q->x), static_cast<std::uint32_t>(q->y),
                static_cast<std::uint32_t>(q->z)};
    }
    static auto unit() { return p8est_connectivity_new_unitcube(); }
    static void destroy(p8est_connectivity_t *c) { p8est_connectivity_destroy(c); }
    static Forest *forest(p8est_connectivity_t *c, void *user) {
        return p8est_new_ext(sc_MPI_COMM_WORLD, c, 0, 0, 1, 0, nullptr, user);
    }
    static void refine(Forest *f, p8est_refine_t split) { p8est_refine(f, 1, split, nullptr); }
    static void balance(Forest *f, int across) {
        p8est_balance(f,
                      across == 1   ? P8EST_CONNECT_FACE
                      : across == 2 ? P8EST_CONNECT_EDGE
                                    : P8EST_CONNECT_FULL,
                      nullptr);
    }
    static Quadrant *quadrant(Forest *f, std::size_t i) {
        return p8est_quadrant_array_index(&p8est_tree_array_index(f->trees, 0)->quadrants, i);
    }
    static auto nodes(Forest *f) {
        p8est_ghost_t *ghost = p8est_ghost_new(f, P8EST_CONNECT_FULL);
        p8est_lnodes_t *nodes = p8est_lnodes_new(f, ghost, 1);
        p8est_ghost_destroy(ghost);
        return nodes;
    }
    static void destroy(p8est_lnodes_t *n) { p8est_lnodes_destroy(n); }
    static void destroy(Forest *f) { p8est_destroy(f); }
};

/// Calls run() between the beginning and the end of MPI and p4est; returns its result.
template <class Run> int with_p4est(int argc, char **argv, Run run) {
    sc_MPI_Init(&argc, &argv);
    sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    const int status = run();
    sc_finalize();
    sc_MPI_Finalize();
    return status;
}

} // namespace abacus::test
