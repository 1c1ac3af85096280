// Goose: incremental insertion over rows under an R-tree (dissertation, chapter 2), the
// mapping that Abacus was made to replace. There are no links between simplices: each
// point's cavity is found by a search for the boxes that contain it (Figure 2.7).
//
//   1. search the R-tree   simplices whose boxes contain the point
//   2. in-sphere tests     the exact predicate dismisses the false hits
//   3. delete              the true hits, each found again by its box
//   4. insert              a simplex for each facet of the cavity's rim
//
// The hull is exact: ghosts are rows like all others (circumbox.hpp), so that a point
// beyond it is an ordinary case. Predicates, perturbation and the order of the points are
// those of Abacus; the triangulation is the same, simplex by simplex.
#pragma once

#include "delaunay/first_simplex.hpp"
#include "goose/circumbox.hpp"
#include "goose/rim.hpp"
#include "points/record.hpp"
#include "points/record_sink.hpp"
#include "sort/spool.hpp"

#include <abacus/goose.h>

namespace abacus {

template <int D> class Goose final : public RecordSink {
public:
    Goose(const Host &host, const abacus_rtree &rtree, const abacus_facts &facts,
          abacus_goose_figures &figures);

    void add(const std::uint64_t *record) override;
    void finish() override { held_.close(host_); }

    abacus_phase phase() const override { return ABACUS_PHASE_INSERTING; }
    PagesMoved pages_moved() const override { return {}; }

private:
    static constexpr std::size_t stride = record_words(D, 0);
    using Record = std::array<std::uint64_t, stride>;

    /// A finite vertex.
    struct Vertex {
        std::int64_t id;
        Point<D> point;
    };
    /// A row's corners; the last of a ghost is not set.
    struct Row {
        std::array<Vertex, D + 1> vertex;
        bool ghost;
    };

    void hold(const std::uint64_t *record);
    void start();
    void insert(const Vertex &v);
    /// The simplices in conflict with p, in hits_; false if p is a vertex.
    bool find_cavity(const Point<D> &p);
    void remove_cavity();
    void fill_cavity(const Vertex &v);
    void insert_row(const Row &row);

    static Vertex vertex_of(const std::uint64_t *record) {
        return {record_id(record), record_point<D>(record)};
    }
    bool found(abacus_host_status status) const;

    const Host &host_;
    const abacus_rtree &rtree_;
    const Circumboxes<D> boxes_;
    abacus_goose_figures &figures_;
    RimOfRows<D> rim_;
    Arena<const abacus_boxed_simplex *> hits_;
    Arena<const abacus_simplex *> cavity_; // of the hits
    Arena<Row> filling_;

    // Points before the first simplex wait in a spool.
    FirstSimplex<D> first_;
    std::array<Vertex, D + 1> first_vertices_;
    int first_count_ = 0;
    Spool held_;
};

extern template class Goose<2>;
extern template class Goose<3>;

} // namespace abacus
