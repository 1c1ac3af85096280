#include "blocks/key_cut.hpp"

#include <array>
#include <bit>

namespace abacus {

namespace {
constexpr int histogram_bits = 8;
constexpr double near_enough = 1.0 / 64; // of the records
constexpr auto by_key = [](const auto &a, const auto &b) { return a.key < b.key; };
} // namespace

bool KeyCut::has_one_key(std::uint64_t code) const {
    const Place *one = nullptr;
    return std::all_of(places_.begin(), places_.end(), [&](const Place &p) {
        if (p.key.code != code) return true;
        if (one == nullptr) one = &p;
        return p.key == one->key;
    });
}

std::size_t KeyCut::cut_below(std::size_t wanted) {
    std::uint64_t border = least_;
    std::size_t below = 0;
    // Codes may be of any magnitude. If a bin has too many, the next histogram covers that bin.
    for (int shift = static_cast<int>(std::bit_width(greatest_ - least_));;) {
        if (shift == 0) return 0;
        shift = std::max(0, shift - histogram_bits);
        std::array<std::uint16_t, 1 << histogram_bits> histogram{};
        for (const Place &p : places_) {
            const std::uint64_t bin = (p.key.code - border) >> shift;
            if (bin < histogram.size()) ++histogram[bin];
        }
        std::uint64_t bin = 0;
        while (below + histogram[bin] <= wanted) below += histogram[bin++];
        border += bin << shift;
        // Within one key there is no nearer cut.
        if (below > 0 &&
            (wanted - below <= near_enough * places_.size() || (shift == 0 && has_one_key(border))))
            break;
    }
    const auto upper = std::partition(places_.begin(), places_.end(),
                                      [&](const Place &p) { return p.key.code < border; });
    std::iter_swap(upper, std::min_element(upper, places_.end(), by_key));
    return below;
}

std::size_t KeyCut::cut_near(std::size_t wanted) {
    const std::size_t n = places_.size();
    wanted = std::clamp<std::size_t>(wanted, 1, n - 1);
    if (const std::size_t below = cut_below(wanted)) return below;
    std::nth_element(places_.begin(), places_.begin() + wanted, places_.end(), by_key);
    // Equal keys stay together: all keys equal to the wanted one go to the upper part, or to the
    // lower part if that would be empty otherwise.
    const Key border = places_[wanted].key;
    const auto below =
        static_cast<std::size_t>(std::partition(places_.begin(), places_.begin() + wanted,
                                                [&](const Place &p) { return p.key < border; }) -
                                 places_.begin());
    if (below > 0) return below;
    const auto equal =
        static_cast<std::size_t>(std::partition(places_.begin() + wanted, places_.end(),
                                                [&](const Place &p) { return p.key == border; }) -
                                 places_.begin());
    if (equal < n)
        std::nth_element(places_.begin() + equal, places_.begin() + equal, places_.end(), by_key);
    return equal;
}

} // namespace abacus
