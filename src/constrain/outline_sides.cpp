#include "constrain/outline_sides.hpp"

#include "geometry/ordered.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>

namespace abacus {

namespace {
constexpr std::size_t end_words = 2, edge_words = 1 + 2 * end_words;
} // namespace

OutlineSides::OutlineSides(const Host &host, std::size_t memory)
    : edges_(host, edge_words, edge_words, memory / 2), host_(host), share_(memory / 4),
      crossed_(host), free_(host), order_(host), fresh_(host) {}

void OutlineSides::add(RegionNumber region, const Point<2> &a, const Point<2> &b) {
    std::uint64_t *const record = edges_.add();
    record[0] = region;
    put_ordered(record + 1, std::min(a, b));
    put_ordered(record + 1 + end_words, std::max(a, b));
}

RegionNumber OutlineSides::next(const Visit &visit, std::optional<Point<2>> &open) {
    if (!is_begun_) {
        edges_.finish();
        next_ = edges_.next();
        is_begun_ = true;
    }
    open.reset();
    if (next_ == nullptr) return no_region;
    const RegionNumber region = collect();
    sweep(visit, open);
    return region;
}

RegionNumber OutlineSides::collect() {
    const std::uint64_t region = next_[0];
    odd_.emplace(host_, 2 * end_words);
    ends_.emplace(host_, end_words, end_words, share_);
    std::array<std::uint64_t, 2 * end_words> edge;
    while (next_ != nullptr && next_[0] == region) {
        std::copy_n(next_ + 1, edge.size(), edge.begin());
        bool is_odd = false;
        while (next_ != nullptr && next_[0] == region &&
               std::equal(edge.begin(), edge.end(), next_ + 1)) {
            is_odd = !is_odd;
            next_ = edges_.next();
        }
        if (!is_odd) continue;
        std::copy(edge.begin(), edge.end(), odd_->add());
        std::copy_n(edge.begin() + end_words, end_words, ends_->add());
    }
    odd_->rewind();
    ends_->finish();
    return static_cast<RegionNumber>(region);
}

void OutlineSides::sweep(const Visit &visit, std::optional<Point<2>> &open) {
    crossed_.clear();
    free_.clear();
    order_.clear();
    const std::uint64_t *begin = odd_->next(), *end = ends_->next();
    while (begin != nullptr || end != nullptr) {
        const bool is_begin =
            begin != nullptr &&
            (end == nullptr ||
             !std::lexicographical_compare(end, end + end_words, begin, begin + end_words));
        const Point<2> p = point_from_ordered<2>(is_begin ? begin : end);
        std::size_t ended = 0;
        for (; end != nullptr && point_from_ordered<2>(end) == p; end = ends_->next()) ++ended;
        fresh_.clear();
        for (; begin != nullptr && point_from_ordered<2>(begin) == p; begin = odd_->next())
            fresh_.push_back({p, point_from_ordered<2>(begin + end_words)});
        const std::size_t at = below(p);
        if (drop(at, p) != ended) throw_corrupted("Edges of outlines cross.");
        if ((ended + fresh_.size()) % 2 != 0) {
            open = p;
            break;
        }
        insert(at, visit);
    }
    ends_->close();
    odd_->close();
}

std::size_t OutlineSides::below(const Point<2> &p) const {
    const auto is_below = [&](Number n, const Point<2> &q) {
        return orientation(crossed_[n].left, crossed_[n].right, q) > 0;
    };
    return static_cast<std::size_t>(std::lower_bound(order_.begin(), order_.end(), p, is_below) -
                                    order_.begin());
}

std::size_t OutlineSides::drop(std::size_t below, const Point<2> &p) {
    std::size_t end = below;
    for (; end < order_.size() && crossed_[order_[end]].right == p; ++end)
        free_.push_back(order_[end]);
    std::copy(order_.begin() + end, order_.end(), order_.begin() + below);
    order_.resize(order_.size() - (end - below));
    return end - below;
}

void OutlineSides::insert(std::size_t below, const Visit &visit) {
    std::sort(fresh_.begin(), fresh_.end(), [](const Edge &a, const Edge &b) {
        return orientation(a.left, a.right, b.right) > 0;
    });
    const std::size_t before = order_.size();
    order_.resize(before + fresh_.size());
    std::copy_backward(order_.begin() + below, order_.begin() + before, order_.end());
    for (std::size_t i = 0; i < fresh_.size(); ++i) {
        Number n = static_cast<Number>(crossed_.size());
        if (free_.empty()) {
            crossed_.push_back(fresh_[i]);
        } else {
            n = free_.back();
            free_.pop_back();
            crossed_[n] = fresh_[i];
        }
        order_[below + i] = n;
        if ((below + i) % 2 == 0)
            visit(fresh_[i].left, fresh_[i].right);
        else
            visit(fresh_[i].right, fresh_[i].left);
    }
}

void OutlineSides::close() {
    edges_.close();
    if (odd_) odd_->close();
    if (ends_) ends_->close();
}

} // namespace abacus
