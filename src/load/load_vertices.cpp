// Vertices and corners: which vertices the simplices have, where they lie, and their order
// along the curve.
#include "keys/domain_of.hpp"
#include "load/load.hpp"

#include <algorithm>

namespace abacus {

namespace {
std::string number(Word id) { return std::to_string(static_cast<std::int64_t>(id)); }
} // namespace

template <int D> void Load<D>::find_corners() {
    begin(placed_, 1 + layout_.vertex, 1);
    const Word *corner = corners_->next();
    std::optional<Word> previous;
    while (const Word *vertex = vertices_->next()) {
        if (previous == vertex[0])
            faults_.add("two vertices have the id " + number(vertex[0]), {},
                        "Give each id only once: ids name the vertices of simplices.");
        previous = vertex[0];
        for (; corner != nullptr && corner[0] < vertex[0]; corner = corners_->next())
            add_unknown(corner);
        if (corner == nullptr || corner[0] != vertex[0]) continue; // belongs to no simplex
        use_vertex(vertex);
        for (; corner != nullptr && corner[0] == vertex[0]; corner = corners_->next()) {
            Word *placed = placed_->add();
            placed[0] = corner[1];
            std::copy_n(vertex, layout_.vertex, placed + 1);
        }
    }
    for (; corner != nullptr; corner = corners_->next()) add_unknown(corner);
    name_unknown();
    faults_.raise();
    end(corners_);
    end(vertices_);
    placed_->finish();
}

template <int D> void Load<D>::use_vertex(const Word *vertex) {
    const Point<D> &p = point_in<D>(vertex);
    const bool first = vertex_count_ == 0;
    if (first || lexicographically_less<D>(p, least_)) least_ = p;
    if (first || lexicographically_less<D>(greatest_, p)) greatest_ = p;
    spread_.add(p);
    ++vertex_count_;
    outside_ += domain_ && !Box<D>(domain_->lower(), domain_->upper()).contains(p);
    std::copy_n(vertex, vertex_words_, used_.add());
}

template <int D> void Load<D>::add_unknown(const Word *corner) {
    if (unknown_.size() < Faults::most)
        unknown_.push_back({corner[1] >> 2, corner[0], {}});
    else
        faults_.add_unnamed(1);
}

/// Names the simplices that have unknown vertices: looks for their other corners.
template <int D> void Load<D>::name_unknown() {
    if (unknown_.empty()) return;
    const auto before = [](const Unknown &a, const Unknown &b) { return a.simplex < b.simplex; };
    std::stable_sort(unknown_.begin(), unknown_.end(), before);
    corners_->rewind();
    while (const Word *corner = corners_->next()) {
        const auto [begin, end] = std::equal_range(unknown_.begin(), unknown_.end(),
                                                   Unknown{corner[1] >> 2, 0, {}}, before);
        for (auto *at = begin; at != end; ++at) at->ids[corner[1] & 3] = corner[0];
    }
    for (const Unknown &unknown : unknown_)
        faults_.add("simplex " + name_of(unknown.ids) + " names vertex " + number(unknown.id) +
                        ", which does not exist",
                    {}, "Return all vertices of the simplices in the vertices query.");
    unknown_.reset();
}

/// If a given domain does not fit the vertices, another one replaces it at once, since a mesh that
/// is not Delaunay never gets new keys.
template <int D> void Load<D>::choose_domain() {
    Box<D> all = spread_.box();
    if (domain_) all.extend(Box<D>(domain_->lower(), domain_->upper()));
    box_ = spread_.choose(all);
    if (domain_ && !has_outgrown_domain(outside_, vertex_count_)) {
        const Box<D> given(domain_->lower(), domain_->upper());
        keeps_domain_ = box_ == all || spread_.choose(given) == given;
    }
    if (!keeps_domain_) domain_ = domain_around<D>(box_.lower, box_.upper);
}

/// Rejects two vertices at one place; split nodes are ordered by their ids instead.
template <int D> void Load<D>::order_vertices() {
    // Code, coordinates, id with its sign flipped, then the rest of the record.
    constexpr Word sign = Word{1} << 63;
    RecordSort places(host_, 1 + vertex_words_, 2 + D, share_);
    used_.rewind();
    while (const Word *vertex = used_.next()) {
        Word *place = places.add();
        place[0] = domain_->code(point_in<D>(vertex));
        std::copy_n(vertex + 1, D, place + 1);
        place[1 + D] = vertex[0] ^ sign;
        std::copy_n(vertex + 1 + D, attributes_, place + 2 + D);
    }
    used_.close();
    places.finish();
    Word previous = 0;
    bool is_split = false; // whether the previous vertex is known to share its place
    std::optional<Point<D>> previous_point;
    while (const Word *place = places.next()) {
        const Point<D> &p = point_in<D>(place);
        const Word id = place[1 + D] ^ sign;
        const bool shares = previous_point == p;
        if (shares && !split_nodes_)
            faults_.add("vertices " + number(previous) + " and " + number(id) +
                            " have the same coordinates",
                        {},
                        "Give the simplices one vertex for each place, or keep them apart with "
                        "split_nodes => true.");
        if (shares) split_count_ += is_split ? 1 : 2;
        is_split = shares;
        previous = id;
        previous_point = p;
        Word *vertex = ordered_.add();
        vertex[0] = id;
        std::copy_n(place + 1, D, vertex + 1);
        std::copy_n(place + 2 + D, attributes_, vertex + 1 + D);
    }
    faults_.raise();
    if (split_count_ > 0) is_convex_ = false;
    ordered_.rewind();
    places.close();
}

} // namespace abacus
