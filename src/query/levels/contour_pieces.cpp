#include "query/levels/contour_pieces.hpp"

#include "blocks/bit_column.hpp"
#include "sort/chain_rank.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace abacus {

namespace {

constexpr std::uint64_t word_of(std::int64_t level) {
    return static_cast<std::uint64_t>(level) ^ std::uint64_t{1} << 63;
}
constexpr std::int64_t level_of(std::uint64_t word) {
    return static_cast<std::int64_t>(word ^ std::uint64_t{1} << 63);
}

/// A path; equal consecutive points count as one.
class Path {
public:
    explicit Path(Arena<Point<2>> &points) : points_(points) { points.clear(); }
    void add(const Point<2> &p) {
        if (points_.empty() || points_.back() != p) points_.push_back(p);
    }

private:
    Arena<Point<2>> &points_;
};

/// Rotates a closed path so that it begins where it is lexicographically least; the first point is
/// not repeated.
void rotate_to_least(Arena<Point<2>> &points) {
    const std::size_t n = points.size();
    std::size_t a = 0, b = 1,
                equal = 0; // two places to begin at, and the number of equal points from there
    while (a < n && b < n && equal < n) {
        const Point<2> &p = points[(a + equal) % n], &q = points[(b + equal) % n];
        if (p == q) {
            ++equal;
            continue;
        }
        (q < p ? a : b) += equal + 1;
        if (a == b) ++b;
        equal = 0;
    }
    std::rotate(points.begin(), points.begin() + std::min(a, b), points.end());
}

} // namespace

ContourPieces::ContourPieces(const Host &host, std::size_t memory)
    : host_(host), memory_(memory / 6), pieces_(host), slots_(host), successors_(host),
      follows_(host), chain_spool_(host, chain_words), point_spool_(host, 2),
      ends_(host, end_words, end_key, memory_), lines_(host, line_words, line_words - 1, memory_),
      points_(host, 4, 2, memory_) {}

auto ContourPieces::words(const ContourEnd &end) -> NodeWords {
    const auto &[kind, a, b] = end.node;
    NodeWords words{ordered(end.place[0] + 0.0), ordered(end.place[1] + 0.0),
                    static_cast<std::uint64_t>(kind)};
    if (a == nullptr) return words;
    for (int i = 0; i < 2; ++i) {
        words[3 + i] = ordered((*a)[i]);
        words[5 + i] = ordered((*b)[i]);
    }
    words[7] = static_cast<std::uint64_t>(a->id);
    words[8] = static_cast<std::uint64_t>(b->id);
    return words;
}

bool ContourPieces::less(const ContourEnd &a, const ContourEnd &b) {
    if (a.place != b.place) return a.place < b.place;
    return words(a) < words(b);
}

void ContourPieces::expect(double chains, double ends) const {
    host_.spool_expect(chain_spool_.spool_bytes(chains) + point_spool_.spool_bytes(chains) +
                       ends_.spool_bytes(ends));
}

// ---- Of a page --------------------------------------------------------------------------

/// The slot of the piece that begins at a node, or the slot where it would be put.
std::uint32_t &ContourPieces::slot_of(std::int64_t level, const ContourNode &node) {
    const auto mix = [](std::uint64_t word) { return (word ^ word >> 29) * 0xbf58476d1ce4e5b9; };
    std::uint64_t hash =
        mix(static_cast<std::uint64_t>(level) * 64 + static_cast<std::uint64_t>(node.kind));
    hash = mix(hash + reinterpret_cast<std::uintptr_t>(node.a));
    hash = mix(hash + reinterpret_cast<std::uintptr_t>(node.b));
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = (hash ^ hash >> 32) & mask;; i = (i + 1) & mask) {
        if (slots_[i] == none) return slots_[i];
        const ContourPiece &piece = pieces_[slots_[i]];
        if (piece.level == level && piece.tail.node == node) return slots_[i];
    }
}

void ContourPieces::flush() {
    host_.poll();
    if (pieces_.empty()) return;
    connect();
    const auto n = static_cast<std::uint32_t>(pieces_.size());
    for (std::uint32_t i = 0; i < n; ++i)
        if (!follows_[i]) store_chain(i);
    for (std::uint32_t i = 0; i < n; ++i)
        if (successors_[i] != i) store_chain(i); // closed within the page
    pieces_.clear();
}

void ContourPieces::connect() {
    const auto n = static_cast<std::uint32_t>(pieces_.size());
    slots_.resize(std::bit_ceil(2 * pieces_.size()));
    std::fill(slots_.begin(), slots_.end(), none);
    successors_.resize(n);
    std::fill(successors_.begin(), successors_.end(), none);
    follows_.resize(n);
    std::fill(follows_.begin(), follows_.end(), false);
    for (std::uint32_t i = 0; i < n; ++i) {
        if (pieces_[i].tail.node.kind == ContourKind::end) continue;
        std::uint32_t &slot = slot_of(pieces_[i].level, pieces_[i].tail.node);
        if (slot != none) throw_corrupted("Triangles of a page overlap.");
        slot = i;
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        if (pieces_[i].head.node.kind == ContourKind::end) continue;
        const std::uint32_t next = slot_of(pieces_[i].level, pieces_[i].head.node);
        if (next == none) continue;
        if (follows_[next]) throw_corrupted("Triangles of a page overlap.");
        successors_[i] = next;
        follows_[next] = true;
    }
}

void ContourPieces::add_end(const ContourPiece &piece, const ContourNode &node, bool begins) {
    if (node.kind == ContourKind::end) return;
    const NodeWords of_node = words({{}, node});
    std::uint64_t *const to = ends_.add();
    to[0] = word_of(piece.level);
    std::copy(of_node.begin() + 2, of_node.end(), to + 1);
    to[begins_at] = begins;
    to[begins_at + 1] = chains_;
}

/// Stores a piece and the pieces that follow it; each then counts as its own successor.
void ContourPieces::store_chain(std::uint32_t first) {
    std::uint64_t count = 0;
    Point<2> last;
    const ContourEnd *least = &pieces_[first].tail;
    const auto put = [&](const ContourEnd &end) {
        if (less(end, *least)) least = &end;
        if (count > 0 && end.place == last) return;
        last = end.place;
        ++count;
        std::uint64_t *const to = point_spool_.add();
        for (int i = 0; i < 2; ++i) to[i] = std::bit_cast<std::uint64_t>(last[i] + 0.0); // no -0
    };
    put(pieces_[first].tail);
    std::uint32_t at = first, before = first;
    while (at != none && successors_[at] != at) {
        put(pieces_[at].head);
        before = at;
        at = std::exchange(successors_[at], at);
    }
    add_end(pieces_[first], pieces_[first].tail.node, true);
    add_end(pieces_[before], pieces_[before].head.node, false);
    std::uint64_t *const to = chain_spool_.add();
    to[0] = word_of(pieces_[first].level);
    to[1] = count;
    const NodeWords of_least = words(*least);
    std::copy(of_least.begin(), of_least.end(), to + 2);
    ++chains_;
}

// ---- Of all pages -----------------------------------------------------------------------

void ContourPieces::finish() {
    flush();
    pieces_.reset();
    slots_.reset();
    RecordSort successors(host_, 2, 1, memory_);
    find_successors(successors);
    // Chains: name of the line, level, least node, number, points, place.
    constexpr std::size_t number_at = 2 + node_words;
    RecordSort chains(host_, number_at + 3, number_at + 2, memory_);
    {
        ChainRank ranks(host_, memory_);
        const std::uint64_t *successor = successors.next();
        chain_spool_.rewind();
        for (std::uint64_t i = 0; i < chains_; ++i) {
            const std::uint64_t *const chain = chain_spool_.next();
            const bool has_one = successor != nullptr && successor[0] == i;
            ranks.add(chain[1], has_one ? successor[1] : ChainRank::none);
            if (has_one) successor = successors.next();
        }
        successors.close();
        ranks.finish();
        chain_spool_.rewind();
        for (std::uint64_t i = 0; i < chains_; ++i) {
            const std::uint64_t *const chain = chain_spool_.next();
            const ChainRank::Rank rank = ranks.next();
            std::uint64_t *const to = chains.add();
            to[0] = rank.chain << 1 | rank.is_closed;
            to[1] = chain[0];
            std::copy_n(chain + 2, node_words, to + 2);
            to[number_at] = i;
            to[number_at + 1] = chain[1];
            to[number_at + 2] = rank.position;
        }
        ranks.close();
    }
    chain_spool_.close();
    chains.finish();
    number(chains);
    place_points(chains);
    chains.close();
    lines_.rewind();
    point_ = points_.next();
}

/// Finds for each chain the one that continues at its end.
void ContourPieces::find_successors(RecordSort &successors) {
    ends_.finish();
    std::array<std::uint64_t, end_words> before{};
    bool has_before = false;
    while (const std::uint64_t *end = ends_.next()) {
        const bool meets = has_before && std::equal(end, end + end_key - 1, before.begin());
        if (meets) {
            if (before[begins_at] != 0 || end[begins_at] != 1)
                throw_corrupted("Triangles overlap.");
            std::uint64_t *const to = successors.add();
            to[0] = before[begins_at + 1];
            to[1] = end[begins_at + 1];
        }
        std::copy_n(end, end_words, before.begin());
        has_before = true;
    }
    ends_.close();
    successors.finish();
}

/// Brings the lines into order.
void ContourPieces::number(RecordSort &chains) {
    std::uint64_t name = ~std::uint64_t{0};
    while (const std::uint64_t *chain = chains.next()) {
        if (chain[0] == name) continue;
        name = chain[0];
        std::uint64_t *const to = lines_.add(); // its least node comes first
        std::copy_n(chain + 1, 1 + node_words, to);
        to[1 + node_words] = name;
        to[2 + node_words] = 0;
    }
    lines_.finish();
    chains.rewind();
}

/// Brings the points into order.
void ContourPieces::place_points(RecordSort &chains) {
    RecordSort numbers(host_, 2, 1, memory_); // line names and numbers
    for (std::uint64_t n = 0; const std::uint64_t *line = lines_.next(); ++n) {
        std::uint64_t *const to = numbers.add();
        to[0] = line[1 + node_words];
        to[1] = n;
    }
    numbers.finish();
    RecordSort places(host_, 4, 1, memory_); // for each chain: number, points, line, place
    const std::uint64_t *number = numbers.next();
    while (const std::uint64_t *chain = chains.next()) {
        while (number[0] != chain[0]) number = numbers.next();
        std::uint64_t *const to = places.add();
        to[0] = chain[2 + node_words];
        to[1] = chain[3 + node_words];
        to[2] = number[1];
        to[3] = chain[4 + node_words];
    }
    numbers.close();
    places.finish();
    point_spool_.rewind();
    while (const std::uint64_t *place = places.next())
        for (std::uint64_t i = 0; i < place[1]; ++i) {
            const std::uint64_t *const point = point_spool_.next();
            std::uint64_t *const to = points_.add();
            to[0] = place[2];
            to[1] = place[3] + i;
            to[2] = point[0];
            to[3] = point[1];
        }
    point_spool_.close();
    places.close();
    points_.finish();
}

bool ContourPieces::next(std::int64_t &level, bool &is_closed, Arena<Point<2>> &points) {
    const std::uint64_t *const line = lines_.next();
    if (line == nullptr) return false;
    level = level_of(line[0]);
    is_closed = line[1 + node_words] & 1;
    Path path(points);
    for (; point_ != nullptr && point_[0] == at_; point_ = points_.next())
        path.add({std::bit_cast<double>(point_[2]), std::bit_cast<double>(point_[3])});
    ++at_;
    if (!is_closed) return true;
    while (points.size() > 1 && points[0] == points.back()) points.pop_back();
    rotate_to_least(points);
    points.push_back(points[0]);
    return true;
}

} // namespace abacus
