// Around every call of the core: rounding to nearest inside, the caller's mode afterwards.
#include "capi/guard.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cfenv>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace abacus {
namespace {

const int modes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

/// These quotients differ between all modes.
std::array<double, 4> quotients() {
    volatile double one = 1, two = 2;
    return {one / 3, two / 3, -one / 3, -two / 3};
}

class RoundingMode : public testing::TestWithParam<int> {
protected:
    ~RoundingMode() override { std::fesetround(FE_TONEAREST); }

    /// Sets a mode, calls a body that leaves another one, and compares.
    template <class Set> void expect_kept(Set set) {
        const auto nearest = quotients();
        set(GetParam());
        const auto found = quotients();
        for (const int left : modes) {
            std::array<double, 4> inside{};
            guard(nullptr, [&] {
                inside = quotients();
                set(left);
                return ABACUS_OK;
            });
            EXPECT_EQ(inside, nearest);
            EXPECT_EQ(quotients(), found);
            EXPECT_EQ(rounds_to_nearest(), GetParam() == FE_TONEAREST);
        }
    }
};

TEST_P(RoundingMode, IsKept) {
    expect_kept([](int mode) { std::fesetround(mode); });
}

#ifdef __SSE2__
TEST_P(RoundingMode, OfSseAloneIsKept) {
    expect_kept([](int mode) {
        _MM_SET_ROUNDING_MODE(mode == FE_UPWARD       ? _MM_ROUND_UP
                              : mode == FE_DOWNWARD   ? _MM_ROUND_DOWN
                              : mode == FE_TOWARDZERO ? _MM_ROUND_TOWARD_ZERO
                                                      : _MM_ROUND_NEAREST);
    });
}
#endif

INSTANTIATE_TEST_SUITE_P(Modes, RoundingMode, testing::ValuesIn(modes));

} // namespace
} // namespace abacus
