#include "query/levels/contour_rims.hpp"

#include "blocks/bit_column.hpp"

#include <bit>

namespace abacus {

namespace {

void put(std::uint64_t *to, const ContourPoint &p) {
    for (int i = 0; i < 2; ++i) to[i] = ordered(p[i]);
    to[2] = static_cast<std::uint64_t>(p.id);
}
ContourPoint point(const std::uint64_t *from) {
    return {{from_ordered(from[0]), from_ordered(from[1])}, static_cast<std::int64_t>(from[2])};
}

/// The position of b as seen from `center`, turning clockwise from a: 0 before half a turn, 1 at
/// half a turn, 2 after it, 3 after a full turn.
int part_of_turn(const Point<2> &center, const Point<2> &a, const Point<2> &b) {
    const int part = 1 + orientation(center, a, b);
    return part == 1 && (a < center) == (b < center) ? 3 : part;
}

} // namespace

ContourRims::ContourRims(const Host &host, const ContourWindow &window, const ContourLevels &levels,
                         std::size_t memory)
    : window_(window), levels_(levels), edges_(host, edge_words, 2 * end_words, memory / 2),
      spokes_(host, edge_words, 2 * end_words + 1, memory / 2), arrive_(host), leave_(host) {}

void ContourRims::add(const ContourPoint &from, double value_from, const ContourPoint &to,
                      double value_to) {
    const bool rises = from < to;
    std::uint64_t *words = edges_.add();
    put(words, rises ? from : to);
    put(words + end_words, rises ? to : from);
    words += 2 * end_words;
    words[0] = rises;
    words[1] = std::bit_cast<std::uint64_t>(rises ? value_from : value_to);
    words[2] = std::bit_cast<std::uint64_t>(rises ? value_to : value_from);
}

/// Finds the edges without a triangle on their other side; each gives a spoke at both ends.
void ContourRims::find_spokes() {
    edges_.finish();
    std::array<std::uint64_t, edge_words> edge{};
    const std::uint64_t *const rest = edge.data() + 2 * end_words;
    int same = 0;
    const auto take = [&] {
        if (same > 2) throw_corrupted("An edge has more than two triangles.");
        if (same != 1) return;
        for (int end = 0; end < 2; ++end) {
            std::uint64_t *const to = spokes_.add();
            std::copy_n(edge.data() + end_words * end, end_words, to);
            to[end_words] = (rest[0] != 0) == (end == 0);
            std::copy_n(edge.data() + end_words * (1 - end), end_words, to + end_words + 1);
            to[2 * end_words + 1] = rest[1 + end];
            to[2 * end_words + 2] = rest[2 - end];
        }
    };
    while (const std::uint64_t *next = edges_.next()) {
        if (same == 0 || !std::equal(next, next + 2 * end_words, edge.begin())) {
            take();
            same = 0;
        }
        std::copy_n(next, edge.size(), edge.begin());
        ++same;
    }
    take();
    edges_.close();
    spokes_.finish();
}

void ContourRims::finish(ContourPieces &pieces) {
    find_spokes();
    ContourPoint vertex;
    const auto end_vertex = [&] {
        go_on(vertex, pieces);
        pieces.flush(); // the pieces' nodes refer to these points
        arrive_.clear();
        leave_.clear();
    };
    while (const std::uint64_t *spoke = spokes_.next()) {
        const ContourPoint at = point(spoke);
        if (at != vertex || at.id != vertex.id) end_vertex();
        vertex = at;
        const std::uint64_t *const rest = spoke + end_words;
        (rest[0] != 0 ? leave_ : arrive_)
            .push_back({point(rest + 1), std::bit_cast<double>(rest[1 + end_words]),
                        std::bit_cast<double>(rest[2 + end_words])});
    }
    end_vertex();
    spokes_.close();
}

void ContourRims::go_on(const ContourPoint &vertex, ContourPieces &pieces) const {
    if (arrive_.size() != leave_.size()) throw_corrupted("The mesh ends within an edge.");
    for (const Spoke &from : arrive_)
        add_pieces(vertex, from, next_clockwise(vertex, from), pieces);
}

auto ContourRims::next_clockwise(const Point<2> &vertex, const Spoke &from) const -> const Spoke & {
    const Spoke *first = &leave_[0];
    for (const Spoke &spoke : leave_) {
        const int part = part_of_turn(vertex, from.other, spoke.other),
                  part_of_first = part_of_turn(vertex, from.other, first->other);
        if (part < part_of_first ||
            (part == part_of_first && orientation(vertex, first->other, spoke.other) > 0))
            first = &spoke;
    }
    return *first;
}

/// Adds the pieces of the edge that arrives from `from`; the rim continues along the edge to `to`.
void ContourRims::add_pieces(const ContourPoint &vertex, const Spoke &from, const Spoke &to,
                             ContourPieces &pieces) const {
    const ContourEdge edge(from.other, from.other_value, vertex, from.value);
    ContourCorner begin{from.other,
                        from.other_value,
                        levels_.rank(from.other_value),
                        {ContourKind::rim, &from.other, &vertex},
                        0};
    ContourCorner end{
        vertex, from.value, levels_.rank(from.value), {ContourKind::rim, &vertex, &to.other}, 0};
    if (!clip(edge, window_, levels_, begin, end)) return;
    cut_into_bands(
        begin, end,
        [&](std::int64_t level, bool is_upper) {
            return ContourEnd{edge.crossing(levels_.level(level)),
                              {is_upper ? ContourKind::upper : ContourKind::lower, edge.a, edge.b}};
        },
        [&](const ContourPiece &piece) { pieces.add(piece); });
}

} // namespace abacus
