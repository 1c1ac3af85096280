// Inputs on which other implementations failed, as reported in their trackers, or made by the
// recipe given there.
#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace abacus::test {
namespace {

using Points = std::vector<Point<2>>;

void expect_exact(const Points &points) {
    Mesh mesh(0, 100 << 10);
    ASSERT_EQ(mesh.stage(number(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.detail;
    EXPECT_EQ(mesh.positions(), cgal_simplices<2>(points));
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

/// Coordinates given as the bytes of well-known binary, most significant first here.
Points from_bits(const std::vector<std::array<std::uint64_t, 2>> &bits) {
    Points points;
    for (const auto &[x, y] : bits)
        points.push_back({std::bit_cast<double>(x), std::bit_cast<double>(y)});
    return points;
}

TEST(PublishedCases, CrossingEdgesInJts20) {
    expect_exact(from_bits({{0xc04277d9e3338b0f, 0xc023048d5853c438},
                            {0xc0425db4d1d67111, 0xc0228ce79316dc6a},
                            {0xc04277d9e3338b1c, 0xc023048d5853c462},
                            {0xc04277da1fc7a5af, 0xc023048e1dc6934b},
                            {0xc04279b5b4dccdb0, 0xc022b1d787684726},
                            {0xc04276dc218467e0, 0xc022fbe1216073f7},
                            {0xc0428d0165d52fe3, 0xc0227c162212eac7}}));
}

TEST(PublishedCases, OverlappingTrianglesInJts298) {
    // The first 28 of its 79 points: some are one unit in the last place apart, one is
    // there twice.
    const Points points = from_bits(
        {{0x405086a22cd54a24, 0x405125abd3a4f458}, {0x406255c867993562, 0x405e6b90cf326ac5},
         {0x40601bce0028da11, 0x405d50c14a8c905a}, {0x405086a22cd54a26, 0x405125abd3a4f459},
         {0x406531ab20cee179, 0x40624447e5bc1be2}, {0x405fa847f66a4940, 0x4066a390a081a031},
         {0x40529bce0028da10, 0x4053a860a546482c}, {0x405e472141034060, 0x40632bdc04cadb60},
         {0x4058b8debefcbf9c, 0x40675423fb35249f}, {0x404a5490ccfdd279, 0x404f96da5fedf036},
         {0x40555490ccfdd279, 0x405596da5fedf035}, {0x406033b3dc3f533e, 0x4065bcdb992e1040},
         {0x4056e16f27a019ee, 0x40644b15257d2d60}, {0x406127b5df76f1d8, 0x405c0f6bbeede3af},
         {0x405757b80995b6c0, 0x4063dc6f5f7e5fcf}, {0x4065e00000000000, 0x4062c00000000000},
         {0x405f0918c003e155, 0x4067048c6001f0ad}, {0x40580d5399d2cae4, 0x405785541a95983f},
         {0x4058b8debefcbfa3, 0x40632bdc04cadb5e}, {0x405d7ed9337cbbb8, 0x405b62478fe4e851},
         {0x405d0c7233684eaf, 0x405b11173d41c43a}, {0x404b298538664b8c, 0x404f2735fbf24a6d},
         {0x403ee30b3353e1a6, 0x4047dcf3754f5012}, {0x405ac61666a7c34e, 0x405973cdd53d4048},
         {0x40437235a3b86bd8, 0x404a4c23c27af290}, {0x406255c867993562, 0x405e6b90cf326ac3},
         {0x4057f6e73ffc1eaa, 0x40637b739ffe0f53}, {0x404b298538664b8b, 0x404f2735fbf24a6c}});
    expect_exact(points);
}

TEST(PublishedCases, MissingTrianglesInJts477) {
    expect_exact({{0, 0}, {1, 0}, {-1, 0.05}, {0, 0}});
    expect_exact({{0, 0}, {0, 486}, {1, 486}, {1, 22}, {2, 22}, {2, 0}});
}

TEST(PublishedCases, FrameTooSmallInGeos719) {
    expect_exact({{0, 194}, {66, 151}, {203, 80}, {273, 43}, {340, 0}});
}

TEST(PublishedCases, NearlyCocircularSitesInJts1171) {
    expect_exact({{6.6584, 53.583000000000006},
                  {6.6576, 53.583600000000004},
                  {6.657, 53.5848},
                  {6.6572000000000005, 53.5842}});
    expect_exact({{18.68285714285716, 100.105},
                  {13.41, 104.82100000000001},
                  {13.41, 107.179},
                  {18.682857142857145, 111.89500000000001}});
}

TEST(PublishedCases, OverlappingTrianglesInIronwallabyDelaunay8) {
    expect_exact({{50.726723, 7.057675},
                  {50.726886, 7.056291},
                  {50.727253, 7.05776},
                  {50.727518, 7.056366},
                  {50.727885, 7.057632}});
}

TEST(PublishedCases, CollinearButForRoundingInDelaunator43) {
    expect_exact({{-537.7739674441619, -122.26130468750004},
                  {-495.533967444162, -183.39195703125006},
                  {-453.29396744416204, -244.5226093750001},
                  {-411.0539674441621, -305.6532617187501},
                  {-164, -122}});
}

TEST(PublishedCases, NearlyFlatTriangleInDelaunator61) {
    const Points points{{31.81616572197592, -26.799702899249567},
                        {33.28212621660443, -27.703479899656887},
                        {32.23977118957961, -27.060859240276358}};
    expect_exact(points);
}

TEST(PublishedCases, TiltedGridsInDelaunator61) {
    for (const double degrees : {302.328, 207.0, 45.0, 30.0, 1e-9}) {
        const double s = std::sin(degrees * M_PI / 180), c = std::cos(degrees * M_PI / 180);
        Points points;
        for (int x = 0; x < 40; ++x)
            for (int y = 0; y < 40; ++y) points.push_back({x * c - y * s, x * s + y * c});
        expect_exact(points);
    }
}

TEST(PublishedCases, ScaledGridInDelaunatorCpp19) {
    // The report has 3017 by 2018 points, scaled to about 1.
    Points points;
    for (int x = 0; x < 151; ++x)
        for (int y = 0; y < 101; ++y) points.push_back({x / 3017.0, y / 3017.0});
    expect_exact(points);
}

} // namespace
} // namespace abacus::test
