// Positions of elements in chains, of which only the links are known: list ranking, within a bound
// of memory.
//
// What fits is ranked in memory, by walking. What does not is contracted first. In each round every
// element gets a coin. Where a link leads from an element with heads to one with tails, the second
// becomes part of the first, and its offset there is noted. No element takes part in two such
// links, and a quarter of all links are of this kind, whatever their order is. After some rounds
// the rest fits, or no link is left. Then the rounds are undone, the last one first: what became
// part of another gets its position from there. Each round sorts what it changes, so all cost is
// that of sorting the links a few times.
//
// A chain may be closed. Then it begins anywhere; contracted to a single element, that follows
// itself.
#pragma once

#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

#include <optional>

namespace abacus {

class ChainRank {
public:
    static constexpr std::uint64_t none = ~std::uint64_t{0};

    struct Rank {
        std::uint64_t chain;    // the number of one of its elements
        std::uint64_t position; // the sum of the weights before the element
        bool is_closed;
    };

    ChainRank(const Host &host, std::size_t memory);

    /// The next element, numbered from 0 on.
    void add(std::uint64_t weight, std::uint64_t successor);
    /// No more come. Every element is the successor of one at most.
    void finish();
    /// Of the next element, in the order of their numbers.
    Rank next();
    /// Gives memory and spools back.
    void close();

private:
    // A record of an element: number, successor, weight. Of a rank: number, chain, position,
    // closed. For a chain that became part of another in a round: the round, counted down, the
    // other one, number, offset.
    static constexpr std::size_t element = 3, rank = 4, part = 4;

    void count_link(std::uint64_t number, std::uint64_t successor) {
        links_ += successor != none && successor != number;
    }
    void contract(unsigned round);
    void rank_in_memory();
    void rank_alone();
    void undo(std::uint64_t round);

    const Host &host_;
    const std::size_t memory_;
    std::optional<RecordSpool> elements_, ranks_;
    std::uint64_t size_ = 0;  // of elements_
    std::uint64_t links_ = 0; // between different ones of them
    std::uint64_t next_ = 0;
    RecordSort parts_;
    const std::uint64_t *at_ = nullptr; // of parts_
};

} // namespace abacus
