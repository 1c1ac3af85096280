// The rounds of a biased randomized insertion order (BRIO; Amenta, Choi and
// Rote 2003; dissertation §4.12.1). Every point belongs to the last round; it
// is promoted to the round before with a small probability, and so on. The
// rounds are inserted from the first and smallest to the last, each along the
// curve.
//
// The draw is a hash of the coordinates. So equal points share a round, and the
// round of a point depends on nothing but the point and the number of points.
#pragma once

#include "geometry/point.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace abacus {

/// Probability that a point is promoted to the round before.
template <int D> inline constexpr double promotion = D == 2 ? 0.03 : 0.1;
/// Expected size below which a round is not worth having.
inline constexpr double smallest_round = 300;
/// Bits of a round's number.
inline constexpr int round_bits = 3;

template <int D> class Rounds {
public:
    static constexpr unsigned most = 1u << round_bits;

    /// `reversed`: the last and largest round comes first, for taking points away.
    explicit Rounds(std::uint64_t points, bool reversed = false) : reversed_(reversed) {
        double share = promotion<D>;
        while (size_ < most && static_cast<double>(points) * share >= smallest_round) {
            threshold_[size_++] = static_cast<std::uint64_t>(std::ldexp(share, 64));
            share *= promotion<D>;
        }
    }

    /// Number of rounds.
    unsigned size() const { return size_; }

    /// Whether a point is in any but the last round, if there are several.
    static bool is_promoted(const Point<D> &p) {
        return static_cast<double>(hash(p)) < std::ldexp(promotion<D>, 64);
    }

    /// Round of a point with canonical coordinates (no -0.0), 0 to size() - 1.
    unsigned round(const Point<D> &p) const {
        const std::uint64_t draw = hash(p);
        unsigned promoted = 0;
        while (draw < threshold_[promoted + 1]) ++promoted;
        return reversed_ ? promoted : size_ - 1 - promoted;
    }

private:
    static std::uint64_t mix(std::uint64_t h) {
        h = (h ^ h >> 32) * 0x9fb21c651e98df25;
        return h ^ h >> 28;
    }
    static std::uint64_t hash(const Point<D> &p) {
        std::uint64_t h = 0x243f6a8885a308d3; // the fixed seed: digits of pi
        for (int i = 0; i < D; ++i) h = mix(h ^ std::bit_cast<std::uint64_t>(p[i]));
        return mix(h * 0xd6e8feb86659fd93);
    }

    unsigned size_ = 1;
    bool reversed_;
    /// threshold_[k]: a draw below it is promoted at least k times; zeros end the list.
    std::uint64_t threshold_[most + 1] = {};
};

} // namespace abacus
