// Pieces of contours joined into lines.
//
// The pieces of a page are joined in memory, at equal nodes. So a page gives a few chains. Their
// points go to a spool, one chain after the other, and the nodes of their ends to a sort; so ends
// that meet come together wherever their chains are from. What follows what is then known, and the
// places of chains in lines are ranked (chain_rank.hpp). Each line gets its number in the order
// of lines, and each point its line and its place there. One more sort brings the points into their
// order, and each line is read as a whole.
//
// The order of lines: by level, then by their least node, which is a place and, where several nodes
// have that, the edge it is on, by the places of its ends and by their ids. So it depends on the
// mesh alone. Memory holds one line, and shares of what the caller grants.
#pragma once

#include "host/arena.hpp"
#include "query/contour_cut.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

namespace abacus {

class ContourPieces {
public:
    ContourPieces(const Host &host, std::size_t memory);

    /// At least so many chains will be joined from now on, each of them within a page, and so many
    /// ends of them are in the window: throws if spools have no room for that.
    void expect(double chains, double ends) const;
    /// Nodes may name points that are there until the next flush().
    void add(const ContourPiece &piece) {
        pieces_.push_back(piece);
        if (pieces_.size() == most_pieces) flush();
    }
    /// Joins what has been added.
    void flush();

    /// No more come. Calls line(level, is_closed, points) for each line, in order. The last point
    /// of a closed one is the first. Equal points in a row are one.
    template <class Line> void each(Line line) {
        finish();
        Arena<Point<2>> points(host_);
        std::int64_t level;
        bool is_closed;
        while (next(level, is_closed, points)) line(level, is_closed, points);
        lines_.close();
        points_.close();
    }

private:
    static constexpr std::size_t most_pieces = std::size_t{1} << 14;
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// A node with its place, in words that are compared one by one.
    using NodeWords = std::array<std::uint64_t, 9>;

    // Records. Of an end: level, node, whether a chain begins there, its number. Of a chain: level,
    // points, least node. Of a line: level, least node, number of the chain that names it, closed.
    static constexpr std::size_t node_words = std::tuple_size_v<NodeWords>;
    static constexpr std::size_t begins_at = node_words - 1; // in an end, which has no place
    static constexpr std::size_t end_words = begins_at + 2, end_key = begins_at + 1;
    static constexpr std::size_t chain_words = 2 + node_words, line_words = 3 + node_words;

    static NodeWords words(const ContourEnd &end);
    static bool less(const ContourEnd &a, const ContourEnd &b);
    std::uint32_t &slot_of(std::int64_t level, const ContourNode &node);
    void connect();
    void store_chain(std::uint32_t first);
    void add_end(const ContourPiece &piece, const ContourNode &node, bool begins);

    void finish();
    void find_successors(RecordSort &successors);
    void number(RecordSort &chains);
    void place_points(RecordSort &chains);
    bool next(std::int64_t &level, bool &is_closed, Arena<Point<2>> &points);

    const Host &host_;
    const std::size_t memory_;
    Arena<ContourPiece> pieces_;
    Arena<std::uint32_t> slots_;      // pieces by where they begin; none
    Arena<std::uint32_t> successors_; // of pieces
    Arena<bool> follows_;             // another piece

    std::uint64_t chains_ = 0;
    RecordSpool chain_spool_, point_spool_;
    RecordSort ends_;

    RecordSort lines_;  // in order
    RecordSort points_; // number of the line, place in it, coordinates
    std::uint64_t at_ = 0;
    const std::uint64_t *point_ = nullptr;
};

} // namespace abacus
