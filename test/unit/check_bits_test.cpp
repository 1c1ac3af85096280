// Every bit of the stored pages matters: abacus_check finds it when flipped.
#include "support/patient.hpp"

#include <gtest/gtest.h>

#include <random>

namespace abacus::test {
namespace {

/// Flips bits all over a store of pages: each must be found.
template <class Pages> void flip_bits(Patient &patient, Pages &pages, int flips, unsigned seed) {
    std::mt19937_64 random(seed);
    for (int i = 0; i < flips; ++i) {
        auto at = std::next(pages.begin(), static_cast<std::ptrdiff_t>(random() % pages.size()));
        // Half of them in the header, where there is something new in every byte.
        const std::size_t limit =
            random() % 2 ? at->second.size : std::min<std::size_t>(at->second.size, 80);
        const std::size_t byte = random() % limit;
        const int bit = static_cast<int>(random() % 8);
        const auto found = patient.faults([&] { at->second.bytes()[byte] ^= 1 << bit; });
        ASSERT_FALSE(found.empty()) << "bit " << bit << " of byte " << byte << " of page "
                                    << std::distance(pages.begin(), at);
        ASSERT_NE(found[0].substr(0, 7), "status:") << found[0];
    }
}

TEST(CheckBits, FindsEveryFlippedBitOfASinglePage) {
    Patient patient(25, 1);
    ASSERT_EQ(patient.mesh.host.pages.size(), 1u);
    const std::size_t size = patient.page().size;
    for (std::size_t bit = 0; bit < 8 * size; ++bit) {
        const auto found = patient.faults([&] { patient.page().bytes()[bit / 8] ^= 1 << bit % 8; });
        ASSERT_FALSE(found.empty()) << "bit " << bit % 8 << " of byte " << bit / 8;
        ASSERT_NE(found[0].substr(0, 7), "status:") << found[0];
    }
}

TEST(CheckBits, FindsFlippedBitsAnywhere) {
    Patient plain(800, 0), small_cache(800, 1, 40 << 10), wide(60, 100);
    for (Patient *patient : {&plain, &small_cache, &wide}) {
        flip_bits(*patient, patient->mesh.host.pages, 150, 3);
    }
}

TEST(CheckBits, FindsFlippedBitsInPagesThatShareACode) {
    // Clusters below the resolution of the codes: links have parts.
    std::vector<Input> points = random_points(1500, 0);
    for (Input &input : points) {
        const double corner = static_cast<double>(input.id % 3) / 4;
        for (double &x : input.point) x = corner + 0.1 + x * 1e-11;
    }
    Patient patient(points);
    ASSERT_TRUE(std::any_of(patient.mesh.host.pages.begin(), patient.mesh.host.pages.end(),
                            [](const auto &page) { return page.first.part != 0; }));
    flip_bits(patient, patient.mesh.host.pages, 200, 6);
}

} // namespace
} // namespace abacus::test
