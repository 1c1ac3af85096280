#include "load/load.hpp"

#include "cache/domain_of.hpp"
#include "load/element_writer.hpp"
#include "load/flanks.hpp"
#include "load/overlap.hpp"
#include "points/canonical.hpp"
#include "points/vertex_page.hpp"

#include <algorithm>

namespace abacus {

namespace {

constexpr std::size_t sorts_at_once = 4;

std::string number(Word id) { return std::to_string(static_cast<std::int64_t>(id)); }

} // namespace

template <int D>
Load<D>::Load(const Host &host, const abacus_header &header, std::size_t memory, bool reorient)
    : host_(host), attributes_(header.attributes), layout_(header.attributes),
      reorient_(reorient), share_(memory / sorts_at_once), pacer_(host),
      used_(host, layout_.vertex),
      ordered_(host, layout_.vertex),
      simplices_(host, layout_.simplex) {
    if (header.staged > 0 || header.vertices > 0)
        throw Error(ABACUS_ERROR_STATE, "the mesh has points already", {},
                    "Load into an empty mesh.");
    if (header.has_domain != 0) domain_ = domain_of<D>(header);
    begin(vertices_, layout_.vertex, 1);
    begin(corners_, 2, 2);
    pacer_.begin(ABACUS_PHASE_READING, 0);
}

// ---- Input ---------------------------------------------------------------------------

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

// ---- Vertices and corners --------------------------------------------------------------

template <int D> void Load<D>::find_corners() {
    begin(placed_, 1 + layout_.vertex, 1);
    const Word *corner = corners_->next();
    std::optional<Word> previous;
    while (const Word *vertex = vertices_->next()) {
        if (previous == vertex[0])
            refuse("two vertices have the id " + number(vertex[0]), {},
                   "Ids name the vertices of simplices: each must be given once.");
        previous = vertex[0];
        if (corner != nullptr && corner[0] < vertex[0]) refuse_unknown(corner[1] >> 2, corner[0]);
        if (corner == nullptr || corner[0] != vertex[0]) continue; // in no simplex
        use_vertex(vertex);
        for (; corner != nullptr && corner[0] == vertex[0]; corner = corners_->next()) {
            Word *placed = placed_->add();
            placed[0] = corner[1];
            std::copy_n(vertex, layout_.vertex, placed + 1);
        }
    }
    if (corner != nullptr) refuse_unknown(corner[1] >> 2, corner[0]);
    end(corners_);
    end(vertices_);
    placed_->finish();
}

template <int D> void Load<D>::use_vertex(const Word *vertex) {
    const Point<D> &p = point_in<D>(vertex);
    const bool first = box_.lower[0] > box_.upper[0];
    if (first || lexicographically_less<D>(p, least_)) least_ = p;
    if (first || lexicographically_less<D>(greatest_, p)) greatest_ = p;
    box_.extend(p);
    ++vertex_count_;
    outside_ += domain_ && !Box<D>(domain_->lower(), domain_->upper()).contains(p);
    std::copy_n(vertex, layout_.vertex, used_.add());
}

/// Looks for the other corners of the simplex, to name it.
template <int D> void Load<D>::refuse_unknown(Word simplex, Word id) {
    std::array<Word, D + 1> ids{};
    corners_->rewind();
    while (const Word *corner = corners_->next())
        if (corner[1] >> 2 == simplex) ids[corner[1] & 3] = corner[0];
    refuse("simplex " + name_of(ids) + " names vertex " + number(id) +
               ", which does not exist",
           {}, "The vertices query must return all vertices of the simplices.");
}

/// A given domain that the vertices do not keep to is widened at once: a mesh that is not Delaunay
/// is never keyed anew.
template <int D> void Load<D>::choose_domain() {
    keeps_domain_ = domain_ && !has_outgrown_domain(outside_, vertex_count_);
    if (keeps_domain_) return;
    if (domain_) {
        box_.extend(domain_->lower());
        box_.extend(domain_->upper());
    }
    domain_ = domain_around<D>(box_.lower, box_.upper);
}

template <int D> void Load<D>::order_vertices() {
    // Code, coordinates, then the rest of the record.
    RecordSort places(host_, 1 + layout_.vertex, 1 + D, share_);
    used_.rewind();
    while (const Word *vertex = used_.next()) {
        Word *place = places.add();
        place[0] = domain_->code(point_in<D>(vertex));
        std::copy_n(vertex + 1, D, place + 1);
        place[1 + D] = vertex[0];
        std::copy_n(vertex + 1 + D, attributes_, place + 2 + D);
    }
    used_.close();
    places.finish();
    Word previous = 0;
    std::optional<Point<D>> previous_point;
    while (const Word *place = places.next()) {
        const Point<D> &p = point_in<D>(place);
        const Word id = place[1 + D];
        if (previous_point == p) {
            const auto [lesser, greater] = std::minmax(
                {static_cast<std::int64_t>(previous), static_cast<std::int64_t>(id)});
            refuse("vertices " + std::to_string(lesser) + " and " + std::to_string(greater) +
                       " have the same coordinates",
                   {}, "Give the simplices one vertex for each place.");
        }
        previous = id;
        previous_point = p;
        Word *vertex = ordered_.add();
        vertex[0] = id;
        std::copy_n(place + 1, D, vertex + 1);
        std::copy_n(place + 2 + D, attributes_, vertex + 1 + D);
    }
    ordered_.rewind();
    places.close();
}

// ---- Simplices ---------------------------------------------------------------------------

template <int D>
Key Load<D>::key_of(const std::array<const Word *, D + 1> &vertices, int n) const {
    std::array<const Point<D> *, D + 1> points{};
    std::array<std::uint64_t, D + 1> codes{};
    std::uint64_t greatest = 0;
    for (int i = 0; i < n; ++i) {
        points[i] = &point_in<D>(vertices[i]);
        codes[i] = domain_->code(*points[i]);
        greatest = std::max(greatest, codes[i]);
    }
    return {greatest, Domain<D>::part(points, codes, n)};
}

template <int D> void Load<D>::assemble() {
    begin(flanks_, LoadLayout<D>::flank(D), D + 1);
    Arena<Word> corners(host_);
    corners.resize((D + 1) * layout_.vertex);
    Word simplex = 0;
    while (const Word *corner = placed_->next()) {
        const Word k = corner[0] & 3;
        std::copy_n(corner + 1, layout_.vertex, corners.data() + k * layout_.vertex);
        if (k != D) continue;
        std::array<const Word *, D + 1> vertices;
        for (int i = 0; i <= D; ++i) vertices[i] = corners.data() + i * layout_.vertex;
        Corners<D> points;
        std::array<Word, D + 1> ids;
        for (int i = 0; i <= D; ++i) {
            points[i] = &point_in<D>(vertices[i]);
            ids[i] = vertices[i][0];
        }
        const int sign = orientation<D>(points);
        if (sign == 0)
            refuse("simplex " + name_of(ids) + " is flat",
                   D == 2 ? "Its vertices lie on one line." : "Its vertices lie in one plane.",
                   "Leave flat simplices out, and join the simplices beside them.");
        if (sign < 0 && !reorient_)
            refuse("simplex " + name_of(ids) + " has negative orientation",
                   {}, "Exchange two of its vertices, or let reorient => true do it.");
        if (sign < 0) std::swap(vertices[0], vertices[1]);
        const Key key = key_of(vertices, D + 1);
        Word *record = simplices_.add();
        record[0] = key.code;
        record[1] = key.part;
        for (int i = 0; i <= D; ++i)
            std::copy_n(vertices[i], layout_.vertex, record + 2 + i * layout_.vertex);
        for (int i = 0; i <= D; ++i)
            Flank<D, D>(simplex, i, key, [&](int v) { return vertices[v]; }).write(flanks_->add());
        ++simplex;
    }
    end(placed_);
    simplices_.rewind();
    flanks_->finish();
}

template <int D> void Load<D>::link() {
    begin(links_, LoadLayout<D>::link, 1);
    each_facet<D, D>(*flanks_, [&](const auto &flanks, std::uint64_t n) {
        const auto name = [&](int i) { return sorted_name(flanks[i].ids, flanks[i].opposite); };
        const auto facet = [&] { return sorted_name(flanks[0].ids); };
        for (std::uint64_t i = 1; i < std::min<std::uint64_t>(n, 3); ++i)
            for (std::uint64_t k = 0; k < i; ++k)
                if (flanks[i].opposite == flanks[k].opposite)
                    refuse("simplex " + name(static_cast<int>(i)) + " is given twice", {},
                           "Take each simplex once: SELECT DISTINCT.");
        if (n > 2)
            refuse("facet " + facet() + " belongs to " + std::to_string(n) + " simplices",
                   "Three of them are " + name(0) + ", " + name(1) + " and " + name(2) + ".",
                   "A facet has two sides, and on each one simplex at most.");
        if (n < 2) return;
        if (flanks[0].odd() == flanks[1].odd())
            refuse(names_of(name(0), name(1)) + " overlap",
                   "They lie on the same side of their common facet " + facet() + ".",
                   "A facet has two sides, and on each one simplex at most.");
        add_link(*links_, flanks[0], flanks[1]);
        add_link(*links_, flanks[1], flanks[0]);
    });
    end(flanks_);
    links_->finish();
}

template <int D> void Load<D>::find_boundary() {
    begin(elements_, layout_.element, 2);
    begin(boundary_, layout_.boundary, 2);
    LinkReader<D> links(*links_);
    Word simplex = 0;
    while (const Word *record = simplices_.next()) {
        Word *element = elements_->add();
        element[0] = record[0];
        element[1] = record[1];
        Corners<D> corners;
        for (int i = 0; i <= D; ++i)
            corners[i] = &point_in<D>(layout_.simplex_vertex(record, i));
        for (int i = 0; i <= D; ++i) {
            Key beyond;
            if (const auto *link = links.of(simplex, i)) {
                beyond = link->key;
                // Each facet from one of its sides.
                if (delaunay_ && layout_.simplex_vertex(record, i)[0] < link->opposite &&
                    in_sphere(corners, link->point) > 0)
                    delaunay_ = false;
            } else {
                add_ghost(record, i, beyond);
            }
            element[2 + 2 * i] = beyond.code;
            element[3 + 2 * i] = beyond.part;
        }
        element[2 + 2 * (D + 1)] = 0;
        std::copy_n(record + 2, (D + 1) * layout_.vertex, element + 3 + 2 * (D + 1));
        ++simplex;
    }
    end(links_);
    boundary_->finish();
}

/// The ghost beyond a facet, which looks at it from outside.
template <int D> void Load<D>::add_ghost(const Word *simplex, int facet, Key &key) {
    std::array<const Word *, D + 1> vertices{};
    for (int i = 0, n = 0; i <= D; ++i)
        if (i != facet) vertices[n++] = layout_.simplex_vertex(simplex, i);
    if ((D - facet) % 2 == 0) std::swap(vertices[0], vertices[1]);
    key = key_of(vertices, D);
    Word *ghost = boundary_->add();
    *ghost++ = key.code;
    *ghost++ = key.part;
    for (int i = 0; i < D; ++i) ghost = std::copy_n(vertices[i], layout_.vertex, ghost);
    *ghost++ = simplex[0];
    *ghost++ = simplex[1];
    std::copy_n(layout_.simplex_vertex(simplex, facet), 1 + D, ghost);
}

// ---- The boundary ------------------------------------------------------------------------

template <int D> void Load<D>::link_ghosts() {
    begin(flanks_, LoadLayout<D>::flank(D - 1), D);
    boundary_->rewind();
    Word ghost = 0;
    for (; const Word *record = boundary_->next(); ++ghost)
        for (int i = 0; i < D; ++i)
            Flank<D, D - 1>(ghost, i, {record[0], record[1]}, [&](int v) {
                return layout_.boundary_vertex(record, v);
            }).write(flanks_->add());
    flanks_->finish();
    begin(links_, LoadLayout<D>::link, 1);
    each_facet<D, D - 1>(*flanks_, [&](const auto &flanks, std::uint64_t n) {
        if (n != 2) delaunay_ = false; // pinched
        if (!delaunay_) return;
        add_link(*links_, flanks[0], flanks[1]);
        add_link(*links_, flanks[1], flanks[0]);
    });
    end(flanks_);
    links_->finish();
}

template <int D> void Load<D>::check_hull() {
    boundary_->rewind();
    LinkReader<D> links(*links_);
    Word ghost = 0;
    for (; const Word *record = boundary_->next(); ++ghost) {
        if (!delaunay_) return;
        Corners<D> corners;
        for (int i = 0; i < D; ++i) corners[i] = &point_in<D>(layout_.boundary_vertex(record, i));
        for (int i = 0; i < D; ++i) {
            const auto *link = links.of(ghost, i);
            corners[D] = &link->point;
            const int side = orientation<D>(corners);
            if (side > 0 || (side == 0 && in_hull_facet(corners, link->point) > 0))
                delaunay_ = false;
        }
        for (const Point<D> *extreme : {&least_, &greatest_}) {
            corners[D] = extreme;
            if (orientation<D>(corners) > 0) delaunay_ = false; // another piece's
        }
    }
}

template <int D> void Load<D>::add_ghosts() {
    boundary_->rewind();
    if (delaunay_) links_->rewind();
    std::optional<LinkReader<D>> links;
    if (delaunay_) links.emplace(*links_);
    Word ghost = 0;
    for (; const Word *record = boundary_->next(); ++ghost) {
        Word *element = elements_->add();
        std::copy_n(record, 2, element);
        for (int i = 0; i < D; ++i) {
            const Key beyond = delaunay_ ? links->of(ghost, i)->key : Key{};
            element[2 + 2 * i] = beyond.code;
            element[3 + 2 * i] = beyond.part;
        }
        std::copy_n(layout_.behind(record), 2, element + 2 + 2 * D);
        element[2 + 2 * (D + 1)] = 1;
        std::copy_n(record + 2, D * layout_.vertex, element + 3 + 2 * (D + 1));
        std::fill_n(element + 3 + 2 * (D + 1) + D * layout_.vertex, layout_.vertex, 0);
    }
}

// ---- All of it ---------------------------------------------------------------------------

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
    if (delaunay_) ordered_.close();
    else write_vertices();

    if (keeps_domain_) header.outside = outside_;
    else set_domain(header, box_);
    header.vertices = vertex_count_;
    header.simplices = simplex_count_;
    header.not_delaunay = !delaunay_;
    if (!delaunay_) header.staged = header.inserted = vertex_count_;
    header.counters = pages.counters(); // nothing has been done with it before
}

template class Load<2>;
template class Load<3>;

} // namespace abacus
