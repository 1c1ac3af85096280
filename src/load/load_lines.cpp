// Lines: edges that are fixed, of a mesh in the plane. They come with the ids of their vertices,
// and go to the triangles beside them when these are found to be neighbours. Those triangles know
// the places of the ends, and do not test the edge.
//
// An edge that passes the test without the perturbation alone lies between vertices on one circle.
// It is kept, for the caller to flip: a mesh that can be changed has the other diagonal.
#include "load/load.hpp"

#include <algorithm>

namespace abacus {

namespace {
const char *const name_edges = "Name edges of the simplices, by the ids of their two vertices.";

std::string line_name(Word line) {
    return "line " + std::to_string(static_cast<std::int64_t>(line));
}
} // namespace

template <int D> void Load<D>::add_lines(const Word *rows, std::size_t count) {
    has_lines_ = true;
    if (!lines_) lines_.emplace(host_, D + 3, D + 2, small_share_);
    for (std::size_t i = 0; i < count; ++i, rows += 1 + D) {
        std::array<Word, D> ids;
        std::copy_n(rows + 1, D, ids.begin());
        std::sort(ids.begin(), ids.end());
        if (std::adjacent_find(ids.begin(), ids.end()) != ids.end())
            faults_.add(line_name(rows[0]) + " has an edge from vertex " +
                            std::to_string(static_cast<std::int64_t>(ids[0])) + " to itself",
                        {}, name_edges);
        Word *line = std::copy(ids.begin(), ids.end(), lines_->add());
        *line++ = rows[0];
        *line++ = lines_->size();
        *line = rows[1];
    }
}

template <int D> void Load<D>::begin_lines() {
    if (!lines_) return;
    lines_->finish();
    line_ = lines_->next();
    fixed_.emplace(host_, 4, 3, small_share_); // side, line, row, its first id; 0: the other side
}

/// Keeps lines that come before a facet: they have an edge that is none.
template <int D> void Load<D>::miss_lines_before(const std::array<Word, D> *ids) {
    for (; line_ != nullptr && (ids == nullptr || std::lexicographical_compare(
                                                      line_, line_ + D, ids->begin(), ids->end()));
         line_ = lines_->next()) {
        if (missed_.size() == Faults::most) {
            faults_.add_unnamed(1);
            continue;
        }
        Missed missed{line_[D], {}};
        std::copy_n(line_, D, missed.ids.begin());
        missed_.push_back(missed);
    }
}

/// Tells the sides of a facet which lines lie over it.
template <int D>
void Load<D>::fix_sides(const std::array<Word, D> &ids, std::span<const Word> sides) {
    miss_lines_before(&ids);
    for (; line_ != nullptr && std::equal(ids.begin(), ids.end(), line_); line_ = lines_->next())
        for (const Word side : sides) {
            Word *record = fixed_->add();
            record[0] = side;
            record[1] = line_[D];
            record[2] = side == sides.front() ? line_[D + 1] : 0; // rows count from 1
            record[3] = line_[D + 2];
        }
}

template <int D> void Load<D>::end_lines() {
    miss_lines_before(nullptr);
    name_missed();
    end(lines_);
    fixed_->finish();
    fixed_row_ = fixed_->next();
}

/// Without simplices no line has an edge.
template <int D> void Load<D>::refuse_lines() {
    if (!lines_) return;
    begin_lines();
    end_lines();
    end(fixed_);
    faults_.raise();
}

/// Says of lines whose edge is none whether its vertices are there.
template <int D> void Load<D>::name_missed() {
    if (missed_.empty()) return;
    std::vector<Word> known;
    while (const Word *vertex = ordered_.next())
        for (const Missed &missed : missed_)
            if (std::find(missed.ids.begin(), missed.ids.end(), vertex[0]) != missed.ids.end()) {
                known.push_back(vertex[0]);
                break;
            }
    ordered_.rewind();
    for (const Missed &missed : missed_) {
        const auto unknown = std::find_if(missed.ids.begin(), missed.ids.end(), [&](Word id) {
            return std::find(known.begin(), known.end(), id) == known.end();
        });
        if (unknown != missed.ids.end())
            faults_.add(line_name(missed.line) + " names vertex " +
                            std::to_string(static_cast<std::int64_t>(*unknown)) +
                            ", which no simplex has",
                        "Its edge is " + sorted_name(missed.ids) + ".", name_edges);
        else
            faults_.add(line_name(missed.line) + " names edge " + sorted_name(missed.ids) +
                            ", which no simplex has",
                        {}, name_edges);
    }
    missed_.reset();
}

/// Whether lines lie over a facet; facets are asked for in order. The first side keeps the edge.
template <int D> bool Load<D>::take_lines(Word simplex, int facet, const Word *record) {
    bool is_fixed = false;
    for (; fixed_row_ != nullptr && fixed_row_[0] == (simplex << 2 | static_cast<Word>(facet));
         fixed_row_ = fixed_->next()) {
        is_fixed = true;
        if (fixed_row_[2] != 0) keep_edge(record, facet);
    }
    return is_fixed;
}

template <int D> void Load<D>::keep_edge(const Word *record, int facet) {
    if constexpr (D == 2) {
        const Word *a = layout_.simplex_vertex(record, (facet + 1) % 3),
                   *b = layout_.simplex_vertex(record, (facet + 2) % 3);
        if (a[0] != fixed_row_[3]) std::swap(a, b);
        Word *edge = std::copy_n(fixed_row_ + 1, 2, fixed_edges_.add());
        *edge++ = a[0];
        *edge++ = b[0];
        edge = std::copy_n(a + 1, D, edge);
        std::copy_n(b + 1, D, edge);
    }
}

template <int D> void Load<D>::keep_tie(const Word *record, int facet) {
    if constexpr (D == 2) {
        Word *tie = ties_.add();
        for (int i = 1; i <= D; ++i)
            tie = std::copy_n(layout_.simplex_vertex(record, (facet + i) % 3) + 1, D, tie);
        ++tie_count_;
    }
}

} // namespace abacus
