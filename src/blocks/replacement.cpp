#include "blocks/replacement.hpp"

#include <algorithm>

namespace abacus {

namespace {
constexpr std::size_t largest_batch = 64; // blocks
// The window of blocks behind: at least this many, and this share of all, in percent.
constexpr std::size_t least_window = 64, window_share = 15;
constexpr std::uint64_t in_use = 1024; // operations since the last use
} // namespace

void Replacement::set_limit() {
    limit_ = budget_;
    if (!last_pass_) return;
    const auto [after_others, alone] = last_pass_room_;
    limit_ = std::min(limit_, bytes_before_pass_ > 0 ? bytes_before_pass_ + after_others : alone);
}

void Replacement::choose(const Arena<Block, BlockIndex> &blocks, std::size_t cached,
                         std::uint64_t clock, Arena<BlockIndex> &victims) {
    const auto is_behind = [&](const Block &b) { return b.upper.code <= front_; };
    std::size_t behind = 0;
    for (const Block &b : blocks) behind += b.state == Block::cached && is_behind(b);
    // A small cache is not larger than the window.
    const bool along_the_curve = front_ != 0 && cached >= 2 * least_window;
    const bool window_is_full = behind > std::max(least_window, cached * window_share / 100);
    candidates_.clear();
    for (std::uint32_t n = 0; n < blocks.size(); ++n) {
        const BlockIndex b{n};
        const Block &block = blocks[b];
        if (block.state != Block::cached) continue;
        Candidate &c = *candidates_.extend(1);
        c = {last, block.used_at, b};
        if (!along_the_curve) continue;
        if (is_behind(block)) {
            c.rank = window_is_full ? first : second;
        } else if (block.lower.code > front_ && clock - block.used_at > in_use) {
            c.rank = window_is_full ? second : first;
            c.order = ~block.lower.code;
        }
    }
    const std::size_t batch = std::min(
        std::clamp<std::size_t>(candidates_.size() / 10, 1, largest_batch), candidates_.size() - 2);
    std::nth_element(candidates_.begin(), candidates_.begin() + batch, candidates_.end(),
                     [](const Candidate &a, const Candidate &b) {
                         return a.rank < b.rank || (a.rank == b.rank && a.order < b.order);
                     });
    victims.clear();
    for (std::size_t i = 0; i < batch; ++i) victims.push_back(candidates_[i].block);
}

} // namespace abacus
