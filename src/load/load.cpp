#include "load/load.hpp"

#include "attributes/attribute_pages.hpp"
#include "blocks/counters.hpp"
#include "keys/domain_of.hpp"
#include "load/element_writer.hpp"
#include "load/overlap.hpp"
#include "mesh/page_attributes.hpp"
#include "points/canonical.hpp"
#include "points/vertex_page.hpp"

#include <algorithm>

namespace abacus {

namespace {
constexpr std::size_t sorts_at_once = 4;
constexpr std::size_t sorts_with_labels = sorts_at_once + 1;
constexpr std::size_t small_part = 4; // of the share of a large sort
constexpr std::size_t edge_words = 8, tie_words = 4;
} // namespace

template <int D>
Load<D>::Load(const Host &host, const abacus_facts &facts, std::size_t memory, bool reorient,
              bool split_nodes)
    : host_(host), attributes_(facts.columns.attributes), in_pages_(page_attributes(facts.columns)),
      layout_(static_cast<unsigned>(in_pages_)), labels_(facts.columns.labels),
      vertex_words_(record_words(D, attributes_)), reorient_(reorient), split_nodes_(split_nodes),
      unknown_(host), share_(memory / (labels_ > 0 ? sorts_with_labels : sorts_at_once)),
      small_share_(share_ / small_part), pacer_(host), spread_(host), missed_(host),
      fixed_edges_(host, edge_words), ties_(host, tie_words), used_(host, vertex_words_),
      ordered_(host, vertex_words_), simplices_(host, layout_.simplex),
      label_rows_(host, std::max(1u, labels_)) {
    if (facts.census.staged > 0 || facts.census.vertices > 0)
        throw Error(ABACUS_ERROR_STATE, "the mesh already has points", {},
                    "Load into an empty mesh.");
    if (split_nodes && facts.columns.apart != 0)
        throw Error(ABACUS_ERROR_ARGUMENT,
                    "attributes in separate pages are found by place, which split nodes share");
    if (facts.form.has_domain != 0) domain_ = domain_of<D>(facts.form);
    begin(vertices_, vertex_words_, 1);
    begin(corners_, 2, 2);
    pacer_.begin(ABACUS_PHASE_READING, 0);
}

template <int D> void Load<D>::add_vertices(const Word *points, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, points += vertex_words_) {
        Word *record = vertices_->add();
        std::copy_n(points, vertex_words_, record);
        make_canonical<D>(record);
    }
    pacer_.reached(vertices_->size());
}

template <int D> void Load<D>::add_simplices(const Word *simplices, std::size_t count) {
    const Word *ids = simplices;
    for (std::size_t i = 0; i < count; ++i, ids += D + 1 + labels_, ++simplex_count_) {
        for (int k = 0; k <= D; ++k) {
            if (std::find(ids, ids + k, ids[k]) != ids + k)
                faults_.add("simplex " + name_of({ids, D + 1}) + " has the same vertex twice", {},
                            "Leave out simplices that have collapsed.");
            Word *corner = corners_->add();
            corner[0] = ids[k];
            corner[1] = simplex_count_ << 2 | static_cast<Word>(k);
        }
        if (labels_ > 0) std::copy_n(ids + D + 1, labels_, label_rows_.add());
    }
    pacer_.reached(vertices_->size() + simplex_count_);
}

/// Writes the attributes, if they are apart, and lists the vertices of a mesh that is not Delaunay.
/// The simplices around a vertex need not be connected there, so a reader of pages could not say
/// which vertices it has already seen. Returns what to add to the counters.
template <int D> abacus_counters Load<D>::write_vertices(bool is_listed) {
    const bool are_apart = static_cast<unsigned>(in_pages_) != attributes_;
    VertexPageWriter list(host_, D, static_cast<unsigned>(in_pages_), 0);
    AttributePages<D> attributes(host_, *domain_, are_apart ? attributes_ : 0);
    while (const Word *vertex = is_listed || are_apart ? ordered_.next() : nullptr) {
        const Point<D> &p = point_in<D>(vertex);
        if (is_listed) list.add(vertex);
        if (are_apart) attributes.put(p, domain_->code(p), record_attributes<D>(vertex));
    }
    if (is_listed) list.finish();
    attributes.flush();
    return attributes.take_counters();
}

template <int D> abacus_delaunay Load<D>::outcome() const {
    if (!is_empty_) return ABACUS_NOT_DELAUNAY;
    if (!is_convex_) return ABACUS_NOT_CONVEX;
    return is_own_ ? ABACUS_DELAUNAY : ABACUS_WEAKLY_DELAUNAY;
}

/// The same if edges on lines are like others, as in a mesh that cannot be changed.
template <int D> abacus_delaunay Load<D>::outcome_without_lines() const {
    return lines_are_empty_ ? outcome() : ABACUS_NOT_DELAUNAY;
}

/// Whether the mesh is Abacus' own, or will be when edges on lines are fixed and ties flipped.
template <int D> bool Load<D>::can_be_changed() const {
    const abacus_delaunay delaunay = outcome();
    return delaunay == ABACUS_DELAUNAY || (has_lines_ && delaunay == ABACUS_WEAKLY_DELAUNAY);
}

template <int D> abacus_delaunay Load<D>::check() {
    pacer_.begin(ABACUS_PHASE_SORTING, 0);
    vertices_->finish();
    corners_->finish();
    find_corners();
    if (simplex_count_ == 0) {
        refuse_lines();
        return ABACUS_DELAUNAY;
    }
    choose_domain();
    order_vertices();
    assemble();
    link();
    find_boundary();

    pacer_.begin(ABACUS_PHASE_CHECKING, 0);
    if (split_count_ > 0) leave_out_split_facets();
    Overlap<D>(host_, layout_, share_).check(outer_ ? *outer_ : *boundary_, simplices_, faults_);
    if (outer_) end(outer_);
    simplices_.close();
    if (is_empty_) {
        link_ghosts();
        if (is_convex_) check_hull();
    }
    return outcome();
}

template <int D> void Load<D>::write(bool keeps_vertices, abacus_header &header) {
    if (simplex_count_ == 0) return;
    const bool is_own = can_be_changed();
    add_ghosts();
    if (links_) end(links_);
    header.facts.census.ghosts = boundary_->size();
    end(boundary_);
    elements_->finish();

    pacer_.begin(ABACUS_PHASE_FLUSHING, elements_->size());
    ElementWriter<D> pages(host_, layout_, *domain_, in_pages_, is_own, split_count_ > 0);
    pages.write(*elements_, pacer_);
    end(elements_);
    header.counters = pages.counters(); // nothing was done with it before
    header.counters += write_vertices(!is_own);
    if (keeps_vertices)
        ordered_.rewind();
    else
        ordered_.close();
    if (labelled_) write_labels(header);
    if (marker_rows_) write_markers(header);

    if (keeps_domain_)
        header.facts.census.outside = outside_;
    else
        set_domain(header.facts, box_);
    header.facts.census.vertices = vertex_count_;
    header.facts.census.simplices = simplex_count_;
    header.facts.standing = is_own ? ABACUS_DELAUNAY : outcome_without_lines();
    header.facts.census.split = split_count_;
    if (is_own) return;
    ties_.close();
    header.facts.census.staged = header.facts.census.inserted = vertex_count_;
}

template class Load<2>;
template class Load<3>;

} // namespace abacus
