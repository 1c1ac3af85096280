#include "load/load.hpp"

#include "keys/domain_of.hpp"
#include "load/element_writer.hpp"
#include "load/overlap.hpp"
#include "points/canonical.hpp"
#include "points/vertex_page.hpp"

#include <algorithm>

namespace abacus {

namespace {
constexpr std::size_t sorts_at_once = 4;
} // namespace

template <int D>
Load<D>::Load(const Host &host, const abacus_header &header, std::size_t memory, bool reorient)
    : host_(host), attributes_(header.attributes), layout_(header.attributes), reorient_(reorient),
      share_(memory / sorts_at_once), pacer_(host), used_(host, layout_.vertex),
      ordered_(host, layout_.vertex), simplices_(host, layout_.simplex) {
    if (header.staged > 0 || header.vertices > 0)
        throw Error(ABACUS_ERROR_STATE, "the mesh has points already", {},
                    "Load into an empty mesh.");
    if (header.has_domain != 0) domain_ = domain_of<D>(header);
    begin(vertices_, layout_.vertex, 1);
    begin(corners_, 2, 2);
    pacer_.begin(ABACUS_PHASE_READING, 0);
}

template <int D> void Load<D>::add_vertices(const Word *points, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, points += layout_.vertex) {
        Word *record = vertices_->add();
        std::copy_n(points, layout_.vertex, record);
        make_canonical<D>(record);
    }
    pacer_.reached(vertices_->size());
}

template <int D> void Load<D>::add_simplices(const Word *ids, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, ids += D + 1, ++simplex_count_)
        for (int k = 0; k <= D; ++k) {
            if (std::find(ids, ids + k, ids[k]) != ids + k)
                refuse("simplex " + name_of({ids, D + 1}) + " has the same vertex twice", {},
                       "Leave out simplices that have collapsed.");
            Word *corner = corners_->add();
            corner[0] = ids[k];
            corner[1] = simplex_count_ << 2 | static_cast<Word>(k);
        }
    pacer_.reached(vertices_->size() + simplex_count_);
}

/// Lists the vertices beside a mesh that is not Delaunay: the simplices around one need not be
/// neighbours of one another there, so that a reader of pages could not tell which it has seen.
template <int D> void Load<D>::write_vertices() {
    VertexPageWriter pages(host_, D, attributes_, 0);
    while (const Word *vertex = ordered_.next()) pages.add(vertex);
    pages.finish();
    ordered_.close();
}

template <int D> void Load<D>::finish(abacus_header &header) {
    pacer_.begin(ABACUS_PHASE_SORTING, 0);
    vertices_->finish();
    corners_->finish();
    find_corners();
    if (simplex_count_ == 0) return;
    choose_domain();
    order_vertices();
    assemble();
    link();
    find_boundary();

    pacer_.begin(ABACUS_PHASE_CHECKING, 0);
    Overlap<D>(host_, layout_, share_).check(*boundary_, simplices_);
    simplices_.close();
    if (delaunay_) {
        link_ghosts();
        if (delaunay_) check_hull();
    }
    add_ghosts();
    if (links_) end(links_);
    header.ghosts = boundary_->size();
    end(boundary_);
    elements_->finish();

    pacer_.begin(ABACUS_PHASE_FLUSHING, elements_->size());
    ElementWriter<D> pages(host_, layout_, *domain_, attributes_, delaunay_);
    pages.write(*elements_, pacer_);
    end(elements_);
    if (delaunay_)
        ordered_.close();
    else
        write_vertices();

    if (keeps_domain_)
        header.outside = outside_;
    else
        set_domain(header, box_);
    header.vertices = vertex_count_;
    header.simplices = simplex_count_;
    header.not_delaunay = !delaunay_;
    if (!delaunay_) header.staged = header.inserted = vertex_count_;
    header.counters = pages.counters(); // nothing has been done with it before
}

template class Load<2>;
template class Load<3>;

} // namespace abacus
