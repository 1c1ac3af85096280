#include "sort/chain_rank.hpp"

#include <algorithm>
#include <array>

namespace abacus {

namespace {

/// What an element takes when it is ranked in memory: its record, and its rank.
constexpr std::size_t bytes_in_memory = 7 * sizeof(std::uint64_t);

/// A coin toss for each element, a new one in each round.
bool has_heads(std::uint64_t number, unsigned round) {
    std::uint64_t word = number + 0x9e3779b97f4a7c15 * (round + 1);
    word = (word ^ word >> 30) * 0xbf58476d1ce4e5b9;
    word = (word ^ word >> 27) * 0x94d049bb133111eb;
    return (word ^ word >> 31) & 1;
}

template <std::size_t n> void copy(std::uint64_t *to, const std::array<std::uint64_t, n> &words) {
    std::copy(words.begin(), words.end(), to);
}

} // namespace

ChainRank::ChainRank(const Host &host, std::size_t memory)
    : host_(host), memory_(memory / 4), elements_(std::in_place, host, element),
      parts_(host, part, 2, memory_) {}

void ChainRank::add(std::uint64_t weight, std::uint64_t successor) {
    count_link(size_, successor);
    copy<element>(elements_->add(), {size_++, successor, weight});
}

void ChainRank::finish() {
    unsigned round = 0;
    while (size_ * bytes_in_memory > memory_ && links_ > 0) contract(round++);
    parts_.finish();
    at_ = parts_.next();
    links_ > 0 ? rank_in_memory() : rank_alone();
    while (round-- > 0) undo(~std::uint64_t{round});
    parts_.close();
    ranks_->rewind();
}

void ChainRank::contract(unsigned round) {
    // Links from heads to tails, sorted by tail: the tail, the head, the head's weight.
    RecordSort links(host_, 3, 1, memory_);
    elements_->rewind();
    while (const std::uint64_t *e = elements_->next())
        if (e[1] != none && has_heads(e[0], round) && !has_heads(e[1], round))
            copy<3>(links.add(), {e[1], e[0], e[2]});
    links.finish();

    // Changes, sorted by head: the head, its new successor, the weight to add.
    RecordSort changes(host_, 3, 1, memory_);
    RecordSpool kept(host_, element);
    const std::uint64_t *link = links.next();
    elements_->rewind();
    while (const std::uint64_t *e = elements_->next()) {
        if (link == nullptr || link[0] != e[0]) {
            std::copy_n(e, element, kept.add());
            continue;
        }
        copy<part>(parts_.add(), {~std::uint64_t{round}, link[1], e[0], link[2]});
        copy<3>(changes.add(), {link[1], e[1], e[2]});
        --size_;
        link = links.next();
    }
    elements_->close();
    links.close();
    changes.finish();

    elements_.emplace(host_, element);
    links_ = 0;
    const std::uint64_t *change = changes.next();
    kept.rewind();
    while (const std::uint64_t *e = kept.next()) {
        std::uint64_t *const to = elements_->add();
        std::copy_n(e, element, to);
        if (change != nullptr && change[0] == e[0]) {
            to[1] = change[1];
            to[2] += change[2];
            change = changes.next();
        }
        count_link(to[0], to[1]);
    }
    kept.close();
    changes.close();
}

/// Each element that is left is a chain of its own.
void ChainRank::rank_alone() {
    ranks_.emplace(host_, rank);
    elements_->rewind();
    while (const std::uint64_t *e = elements_->next())
        copy<rank>(ranks_->add(), {e[0], e[0], 0, e[1] == e[0]});
    elements_->close();
}

void ChainRank::rank_in_memory() {
    Arena<std::uint64_t> numbers(host_), successors(host_), weights(host_);
    Arena<Rank> ranks(host_);
    elements_->rewind();
    while (const std::uint64_t *e = elements_->next()) {
        numbers.push_back(e[0]);
        successors.push_back(e[1]);
        weights.push_back(e[2]);
        ranks.push_back({none, 0, false});
    }
    elements_->close();
    const auto place = [&](std::uint64_t number) -> std::size_t {
        return static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), number) -
                                        numbers.begin());
    };
    Arena<bool> follows(host_);
    follows.resize(numbers.size());
    std::fill(follows.begin(), follows.end(), false);
    for (std::uint64_t &successor : successors) {
        if (successor == none) continue;
        successor = place(successor);
        follows[successor] = true;
    }
    const auto walk = [&](std::size_t first, bool is_closed) {
        std::uint64_t position = 0;
        for (std::size_t i = first; i != none && ranks[i].chain == none; i = successors[i]) {
            ranks[i] = {numbers[first], position, is_closed};
            position += weights[i];
        }
    };
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (!follows[i]) walk(i, false);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (ranks[i].chain == none) walk(i, true);

    ranks_.emplace(host_, rank);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        copy<rank>(ranks_->add(),
                   {numbers[i], ranks[i].chain, ranks[i].position, ranks[i].is_closed});
}

void ChainRank::undo(std::uint64_t round) {
    RecordSort found(host_, rank, 1, memory_);
    ranks_->rewind();
    while (const std::uint64_t *r = ranks_->next())
        for (; at_ != nullptr && at_[0] == round && at_[1] == r[0]; at_ = parts_.next())
            copy<rank>(found.add(), {at_[2], r[1], r[2] + at_[3], r[3]});
    found.finish();

    RecordSpool all(host_, rank);
    const std::uint64_t *more = found.next();
    ranks_->rewind();
    for (const std::uint64_t *r = ranks_->next(); r != nullptr || more != nullptr;) {
        const bool takes_more = r == nullptr || (more != nullptr && more[0] < r[0]);
        std::copy_n(takes_more ? more : r, rank, all.add());
        (takes_more ? more : r) = takes_more ? found.next() : ranks_->next();
    }
    found.close();
    ranks_->close();
    ranks_.emplace(std::move(all));
}

ChainRank::Rank ChainRank::next() {
    const std::uint64_t *const r = ranks_->next();
    if (r == nullptr || r[0] != next_++)
        throw Error(ABACUS_ERROR_INTERNAL, "an element of a chain has no rank");
    return {r[1], r[2], r[3] != 0};
}

void ChainRank::close() { ranks_->close(); }

} // namespace abacus
