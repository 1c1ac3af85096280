// Loading a triangulation made elsewhere: vertices and simplices, from two queries, into
// pages; Delaunay or not, checked, within a bound of memory.
//
// There is no cache and no search: sorting brings together what belongs together
// (record_sort.hpp).
//
//   vertices by id       two of one id are found; merged with
//   corners by id        unknown ids are found; vertices without simplices are left out
//   vertices by place    two at one place are found, or split nodes; their order along the curve
//   corners by simplex   coordinates: orientation, flat simplices, keys
//   flanks by facet      neighbours; facets used more than twice, or twice from one side
//   links by simplex     the Delaunay criterion; what has no neighbour is the boundary
//   boundary by place    the two sides of a fault: of these the overlaps need nothing
//   boundary by key      overlaps (overlap.hpp)
//   flanks by ridge      neighbours of ghosts; whether the boundary is a convex hull
//   elements by key      pages (element_writer.hpp)
//   labelled by key      pages of the labels of simplices
//   markers by facet     with its flanks; then by simplex and by key: pages of the markers
//   lines by facet       with its flanks; then by simplex: edges that are fixed
//
// The mesh is the Delaunay triangulation of its vertices if and only if across every facet
// the empty-sphere criterion holds under the perturbation, each ridge of the boundary joins
// two facets and is convex, and it is in one piece (Delaunay 1934). If the criterion holds
// without the perturbation alone it is weakly Delaunay: all spheres are empty, but of vertices
// on one sphere others are joined. Facets on lines are not tested (Lee and Lin 1986). What is
// convex at all ridges of a connected boundary is convex (Tietze, Nakajima). Of two convex pieces,
// one would have the least or the greatest vertex of all beyond one of its facets: if both were in
// both pieces, so would be all that lies between them, which overlap.hpp excludes but for an edge,
// and at such an edge four facets meet.
//
// Split nodes. Vertices may share their places, told apart by their ids: so the two sides of a
// fault are kept apart. Their facets are matched by ids, so both sides are of the boundary, and
// each has its ghost. Two facets of the boundary at the same place, with simplices on different
// sides, touch and do not overlap; what is left must be a complex as if each place had one vertex.
// Such a mesh is never convex. The two ghosts of a fault have the same key, which no page divides;
// elements of one key go by the keys of their neighbours, so that pages do not depend on the order
// of rows.
//
// In a mesh that is not Delaunay, a ghost knows the simplex behind it, and is its own
// neighbour across its ridges. At a pinched ridge four or more ghosts would meet. Nothing
// follows these links in a mesh that does not change.
#pragma once

#include "geometry/box_tree.hpp"
#include "keys/locational_code.hpp"
#include "load/faults.hpp"
#include "load/records.hpp"
#include "points/spread.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

#include <abacus/mesh_header.h>
#include <optional>

namespace abacus {

/// Words of a key in records that are sorted by it.
inline constexpr std::size_t key_words = 2;

template <int D> class Load {
public:
    /// `reorient`: simplices of negative orientation are turned, not refused. `split_nodes`:
    /// vertices at one place are kept apart, not refused; no attributes are apart then.
    Load(const Host &host, const abacus_facts &facts, std::size_t memory, bool reorient,
         bool split_nodes);

    /// Adds vertices, as in abacus_stage_add; all before the simplices.
    void add_vertices(const std::uint64_t *points, std::size_t count);
    /// Adds simplices: D + 1 vertex ids each, followed by its labels.
    void add_simplices(const std::uint64_t *simplices, std::size_t count);
    /// Then markers of facets: D vertex ids each, and the marker.
    void add_facets(const std::uint64_t *facets, std::size_t count);
    /// Then lines of a mesh in the plane: each edge as the line and two vertex ids. If this is
    /// called at all, a mesh whose other edges are weakly Delaunay is written like one that can be
    /// changed: the caller must then fix the edges on lines, and flip the ties.
    void add_lines(const std::uint64_t *rows, std::size_t count);
    /// No more come: checks.
    abacus_delaunay check();
    /// Calls visit(edge) with the next edge on a line, at most `most` times: the line, the number
    /// of its row, two ids and two points.
    template <class Visit> void next_edges(std::size_t most, Visit visit) {
        for (; most > 0; --most) {
            const Word *edge = fixed_edges_.next();
            if (edge == nullptr) return fixed_edges_.close();
            visit(edge);
        }
    }
    /// Calls visit(tie) with the ends of each edge that the perturbation alone decides against, and
    /// is on no line; returns how many there were.
    template <class Visit> std::uint64_t take_ties(Visit visit) {
        while (const Word *tie = ties_.next()) visit(tie);
        ties_.close();
        return tie_count_;
    }
    /// Writes the pages and brings the header of the empty mesh up to date. Vertices can be given
    /// after that if they are kept.
    void write(bool keeps_vertices, abacus_header &header);
    /// After that, or instead: calls add(vertex) with the record of each vertex of a simplex.
    template <class Add> void give_vertices(Add add) {
        for (auto *sort : {&links_, &boundary_, &elements_, &labelled_, &marker_rows_})
            if (*sort) end(*sort); // taking the vertices needs memory
        ties_.close();
        while (const Word *vertex = ordered_.next()) add(vertex);
        ordered_.close();
    }

private:
    // load_vertices.cpp
    void find_corners();
    void use_vertex(const Word *vertex);
    /// A corner without a vertex, and the ids of its simplex, by which it is named.
    struct Unknown {
        Word simplex, id;
        std::array<Word, D + 1> ids;
    };
    void add_unknown(const Word *corner);
    void name_unknown();
    void choose_domain();
    void order_vertices();

    // load_simplices.cpp
    void assemble();
    void link();
    void find_boundary();
    void add_ghost(const Word *simplex, int facet, Key &key);
    Key key_of(const std::array<const Word *, D + 1> &vertices, int n) const;

    // load_split.cpp
    void leave_out_split_facets();

    // load_labels.cpp
    void begin_labels();
    void place_labels(const Corners<D> &points);
    void write_labels(abacus_header &header);

    // load_markers.cpp
    void begin_markers();
    void refuse_marks_before(const std::array<Word, D> *ids);
    void mark_sides(const std::array<Word, D> &ids, std::span<const Word> sides);
    void end_marks();
    void place_markers(Word simplex, const Word *record);
    void write_markers(abacus_header &header);

    // load_lines.cpp
    /// A line with an edge that is none.
    struct Missed {
        Word line;
        std::array<Word, D> ids;
    };
    void begin_lines();
    void miss_lines_before(const std::array<Word, D> *ids);
    void fix_sides(const std::array<Word, D> &ids, std::span<const Word> sides);
    void end_lines();
    void refuse_lines();
    void name_missed();
    bool take_lines(Word simplex, int facet, const Word *record);
    void keep_edge(const Word *record, int facet);
    void keep_tie(const Word *record, int facet);

    // load_boundary.cpp
    void link_ghosts();
    void check_hull();
    void add_ghosts();

    // load.cpp
    abacus_delaunay outcome() const;
    abacus_delaunay outcome_without_lines() const;
    bool can_be_changed() const;
    abacus_counters write_vertices(bool is_listed);
    void begin(std::optional<RecordSort> &sort, std::size_t stride, std::size_t key) {
        sort.emplace(host_, stride, key, share_);
    }
    static void end(std::optional<RecordSort> &sort) {
        sort->close();
        sort.reset();
    }

    const Host &host_;
    const unsigned attributes_;
    const int in_pages_; // attributes of simplex pages: all or none
    const LoadLayout<D> layout_;
    const unsigned labels_;
    const std::size_t vertex_words_; // of what is given: corners have no attributes that are apart
    const bool reorient_, split_nodes_;
    Faults faults_; // of one step: there is no next one if it has some
    Arena<Unknown> unknown_;
    const std::size_t share_;       // of memory, for one of the sorts that are open at once
    const std::size_t small_share_; // for those of markers and lines
    Pacer pacer_;
    std::optional<Domain<D>> domain_;
    Spread<D> spread_; // of the vertices
    Box<D> box_;       // that the domain is chosen by
    /// As far as it has been looked into: the circumspheres are empty, the boundary is the convex
    /// hull, and cospherical vertices are joined as the perturbation joins them.
    bool is_empty_ = true, is_convex_ = true, is_own_ = true;
    Word vertex_count_ = 0, simplex_count_ = 0;
    Word split_count_ = 0;          // vertices that share their places
    Word outside_ = 0;              // vertices, of a given domain
    bool keeps_domain_ = false;     // the given one
    Point<D> least_{}, greatest_{}; // of the vertices, lexicographically

    std::optional<RecordSort> vertices_, corners_, placed_, flanks_, links_, boundary_, elements_,
        labelled_;
    std::optional<RecordSort> outer_; // the boundary without faults, if vertices share their places
    // Markers by the ids of the facet; by sides of simplices; and by the keys of these.
    std::optional<RecordSort> marks_, marked_, marker_rows_;
    const Word *mark_ = nullptr; // the next one to be read
    // Lines by the ids of the facet; by sides of simplices.
    std::optional<RecordSort> lines_, fixed_;
    const Word *line_ = nullptr, *fixed_row_ = nullptr; // the next ones to be read
    bool has_lines_ = false, lines_are_empty_ = true;   // and the circumspheres beside them are
    Arena<Missed> missed_;
    RecordSpool fixed_edges_; // as next_edges() returns them
    RecordSpool ties_;        // ends
    Word tie_count_ = 0;
    RecordSpool used_;       // vertices of simplices
    RecordSpool ordered_;    // the same along the curve
    RecordSpool simplices_;  // in the order of the query
    RecordSpool label_rows_; // as well
};

extern template class Load<2>;
extern template class Load<3>;

} // namespace abacus
