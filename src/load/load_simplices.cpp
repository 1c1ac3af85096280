// Simplices: their orientations, keys and neighbours, and the facets that have none.
#include "load/flanks.hpp"
#include "load/load.hpp"

#include <algorithm>

namespace abacus {

template <int D> Key Load<D>::key_of(const std::array<const Word *, D + 1> &vertices, int n) const {
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
    flanks_->expect(static_cast<double>(simplex_count_) * (D + 1));
    begin_labels();
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
            faults_.add("simplex " + name_of(ids) + " is flat",
                        D == 2 ? "Its vertices lie on one line." : "Its vertices lie in one plane.",
                        "Leave flat simplices out, and join the simplices beside them.");
        if (sign < 0 && !reorient_)
            faults_.add("simplex " + name_of(ids) + " has negative orientation", {},
                        "Exchange two of its vertices, or use reorient => true.");
        if (sign < 0) std::swap(vertices[0], vertices[1]);
        const Key key = key_of(vertices, D + 1);
        Word *record = simplices_.add();
        record[0] = key.code;
        record[1] = key.part;
        for (int i = 0; i <= D; ++i)
            std::copy_n(vertices[i], layout_.vertex, record + 2 + i * layout_.vertex);
        for (int i = 0; i <= D; ++i)
            Flank<D, D>(simplex, i, key, [&](int v) { return vertices[v]; }).write(flanks_->add());
        if (labelled_) place_labels(points);
        ++simplex;
    }
    faults_.raise();
    end(placed_);
    label_rows_.close();
    simplices_.rewind();
    flanks_->finish();
}

template <int D> void Load<D>::link() {
    begin(links_, LoadLayout<D>::link, 1);
    begin_markers();
    begin_lines();
    each_facet<D, D>(*flanks_, [&](const auto &flanks, std::uint64_t n) {
        const std::array<Word, 2> sides{flanks[0].place >> 1, flanks[1].place >> 1};
        const std::span<const Word> of_facet = std::span(sides).first(n < 2 ? 1 : 2);
        if (marks_) mark_sides(flanks[0].ids, of_facet);
        if (lines_) fix_sides(flanks[0].ids, of_facet);
        const auto name = [&](int i) { return sorted_name(flanks[i].ids, flanks[i].opposite); };
        const auto facet = [&] { return sorted_name(flanks[0].ids); };
        if (n < 2) return;
        const int seen = static_cast<int>(std::min<std::uint64_t>(n, 3));
        for (int i = 1; i < seen; ++i)
            for (int k = 0; k < i; ++k) {
                if (flanks[i].opposite != flanks[k].opposite) continue;
                if (flanks[i].opposite < flanks[i].ids[0]) // reported at one of its facets only
                    faults_.add("simplex " + name(i) + " is given twice", {},
                                "Give each simplex only once, for instance with SELECT DISTINCT.");
                return;
            }
        if (n > 2)
            faults_.add("facet " + facet() + " belongs to " + std::to_string(n) + " simplices",
                        "Three of them are " + name(0) + ", " + name(1) + " and " + name(2) + ".",
                        "Give at most one simplex on each of the two sides of a facet.");
        else if (flanks[0].odd() == flanks[1].odd())
            faults_.add(names_of(name(0), name(1)) + " overlap",
                        "They lie on the same side of their common facet " + facet() + ".",
                        "Give at most one simplex on each of the two sides of a facet.");
        add_link(*links_, flanks[0], flanks[1]);
        add_link(*links_, flanks[1], flanks[0]);
    });
    if (marks_) end_marks();
    if (lines_) end_lines();
    faults_.raise();
    end(flanks_);
    links_->finish();
}

template <int D> void Load<D>::find_boundary() {
    begin(elements_, layout_.element, split_count_ > 0 ? 2 + 2 * (D + 1) : 2);
    elements_->expect(static_cast<double>(simplex_count_));
    begin(boundary_, layout_.boundary, 2);
    LinkReader<D> links(*links_);
    Word simplex = 0;
    while (const Word *record = simplices_.next()) {
        Word *element = elements_->add();
        element[0] = record[0];
        element[1] = record[1];
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) corners[i] = &point_in<D>(layout_.simplex_vertex(record, i));
        for (int i = 0; i <= D; ++i) {
            Key beyond;
            const bool is_fixed = take_lines(simplex, i, record);
            if (const auto *link = links.of(simplex, i)) {
                beyond = link->key;
                // Test each facet from one of its sides only.
                bool &is_empty = is_fixed ? lines_are_empty_ : is_empty_;
                if (is_empty && layout_.simplex_vertex(record, i)[0] < link->opposite &&
                    in_sphere(corners, link->point) > 0) {
                    is_empty = exact::unperturbed_in_sphere<D>(corners, link->point) <= 0;
                    if (!is_fixed) is_own_ = false;
                    if (!is_fixed && is_empty && has_lines_) keep_tie(record, i);
                }
            } else {
                add_ghost(record, i, beyond);
            }
            element[2 + 2 * i] = beyond.code;
            element[3 + 2 * i] = beyond.part;
        }
        if (marker_rows_) place_markers(simplex, record);
        element[2 + 2 * (D + 1)] = 0;
        std::copy_n(record + 2, (D + 1) * layout_.vertex, element + 3 + 2 * (D + 1));
        ++simplex;
    }
    end(links_);
    if (marked_) end(marked_);
    if (fixed_) end(fixed_);
    fixed_edges_.rewind();
    ties_.rewind();
    boundary_->finish();
}

/// Adds the ghost beyond a facet, which sees the facet from outside.
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

} // namespace abacus
