// The boundary: ghosts beyond its facets, and whether it is a convex hull.
#include "load/flanks.hpp"
#include "load/load.hpp"

#include <algorithm>

namespace abacus {

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
        if (n != 2) is_convex_ = false; // pinched
        if (!is_convex_) return;
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
        if (!is_convex_) return;
        Corners<D> corners;
        for (int i = 0; i < D; ++i) corners[i] = &point_in<D>(layout_.boundary_vertex(record, i));
        for (int i = 0; i < D; ++i) {
            const auto *link = links.of(ghost, i);
            corners[D] = &link->point;
            const int side = orientation<D>(corners);
            if (side > 0) is_convex_ = false;
            if (side == 0 && in_hull_facet(corners, link->point) > 0) is_own_ = false;
        }
        for (const Point<D> *extreme : {&least_, &greatest_}) {
            corners[D] = extreme;
            if (orientation<D>(corners) > 0) is_convex_ = false; // the vertex of another piece
        }
    }
}

template <int D> void Load<D>::add_ghosts() {
    boundary_->rewind();
    const bool is_linked = can_be_changed();
    std::optional<LinkReader<D>> links;
    if (is_linked) {
        links_->rewind();
        links.emplace(*links_);
    }
    Word ghost = 0;
    for (; const Word *record = boundary_->next(); ++ghost) {
        Word *element = elements_->add();
        std::copy_n(record, 2, element);
        for (int i = 0; i < D; ++i) {
            const Key beyond = is_linked ? links->of(ghost, i)->key : Key{};
            element[2 + 2 * i] = beyond.code;
            element[3 + 2 * i] = beyond.part;
        }
        std::copy_n(layout_.behind(record), 2, element + 2 + 2 * D);
        element[2 + 2 * (D + 1)] = 1;
        std::copy_n(record + 2, D * layout_.vertex, element + 3 + 2 * (D + 1));
        std::fill_n(element + 3 + 2 * (D + 1) + D * layout_.vertex, layout_.vertex, 0);
    }
}

} // namespace abacus
