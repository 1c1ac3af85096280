#include "shards/survey.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

namespace {
constexpr std::size_t leeway = 32; // a border may move by this part of a share
} // namespace

template <int D> void Survey<D>::add(const std::uint64_t *records, std::size_t count) {
    std::array<std::uint64_t, record_words(D, 0)> place;
    for (std::size_t i = 0; i < count; ++i, records += stride_) {
        std::copy_n(records, place.size(), place.begin());
        make_canonical<D>(place.data());
        const Point<D> p = record_point<D>(place.data());
        spread_.add(p);
        draw(p);
    }
    points_ += count;
}

template <int D>
void Survey<D>::merge(std::uint64_t points, const Box<D> &box, const Point<D> *sample,
                      std::size_t count) {
    points_ += points;
    spread_.extend(box);
    for (std::size_t i = 0; i < count; ++i) {
        spread_.add(sample[i]);
        draw(sample[i]);
    }
}

template <int D> void Survey<D>::draw(const Point<D> &p) {
    const std::uint64_t hash = point_hash(p);
    if (hash >= least_excluded_) return;
    if (drawn_.size() == 2 * most) cut();
    if (hash < least_excluded_) drawn_.push_back({hash, p});
}

/// Keeps each point once, and no more than belong to the sample.
template <int D> void Survey<D>::cut() {
    std::sort(drawn_.begin(), drawn_.end(), [](const Drawn &a, const Drawn &b) {
        return a.hash < b.hash || (a.hash == b.hash && lexicographically_less<D>(a.point, b.point));
    });
    const auto is_same = [](const Drawn &a, const Drawn &b) { return a.point == b.point; };
    const auto distinct = static_cast<std::size_t>(
        std::unique(drawn_.begin(), drawn_.end(), is_same) - drawn_.begin());
    drawn_.resize(std::min(distinct, most));
    if (distinct >= most) least_excluded_ = drawn_.back().hash;
}

template <int D> const Arena<Point<D>> &Survey<D>::sample() {
    cut();
    sample_.clear();
    for (const Drawn &drawn : drawn_) sample_.push_back(drawn.point);
    return sample_;
}

/// Of the codes from `least` + 1 to `greatest`, the one at which the coarsest cell begins.
constexpr std::uint64_t coarsest(std::uint64_t least, std::uint64_t greatest) {
    if (least >= greatest) return greatest;
    const int differ = std::bit_width(least ^ greatest) - 1;
    return greatest >> differ << differ;
}

template <int D>
void Survey<D>::borders(const Domain<D> &domain, std::uint32_t shards, std::uint64_t *borders) {
    codes_.clear();
    for (const Point<D> &p : sample()) codes_.push_back(domain.code(p));
    std::sort(codes_.begin(), codes_.end());
    const std::size_t n = codes_.size(), move = n / shards / leeway;
    std::uint64_t before = 0;
    for (std::uint32_t i = 1; i < shards; ++i) {
        std::uint64_t border = 0;
        if (n > 0) {
            const std::size_t at = n * i / shards;
            const std::size_t least = at - std::min(at, move), most = std::min(at + move, n - 1);
            border = coarsest(codes_[least], codes_[most]);
        }
        before = borders[i - 1] = std::max(before, border);
    }
}

template class Survey<2>;
template class Survey<3>;

} // namespace abacus
