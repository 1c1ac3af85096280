// Values of a step, by the ids of vertices, in place of attributes: every question gives what it
// gives for attributes with the same values.
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"
#include "support/triangulations.hpp"

#include <abacus/values.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace abacus::test {
namespace {

/// Of each place, by all methods; NaN outside.
template <int D>
std::vector<double> values_at(MeshOf<D> &mesh, std::uint32_t attribute, std::size_t cache_bytes) {
    std::vector<double> values;
    {
        OpenMeshOf<D> open(mesh, cache_bytes);
        Random random(4);
        for (int i = 0; i < 300; ++i) {
            Point<D> p;
            for (double &x : p) x = 1.2 * unit(random) - 0.1;
            for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL, ABACUS_NEAREST}) {
                abacus_interpolation how{};
                how.method = method;
                how.attributes = 1;
                how.attribute[0] = attribute;
                double value = NAN;
                EXPECT_NE(open.interpolate(how, p, &value), ABACUS_ERROR) << open.error.message;
                values.push_back(value);
            }
        }
    }
    EXPECT_EQ(mesh.host.bytes, 0u);
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    return values;
}

template <int D> void expect_same_as_attributes(int attributes) {
    SCOPED_TRACE(attributes);
    Random random(1);
    std::vector<InputOf<D>> points(sanitized ? 200 : 1500);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].id = static_cast<std::int64_t>(i * 7919 % points.size()) * 1000003;
        for (double &x : points[i].point) x = unit(random);
        for (int n = 0; n < attributes; ++n)
            points[i].attributes.push_back(i % 50 == 0 ? NAN : unit(random) - n);
    }
    MeshOf<D> mesh(attributes);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.message;
    const std::size_t little = 60 << 10, ample = 64 << 20;
    const auto expected = values_at<D>(mesh, 0, ample);

    // the first attribute is now the last of five values; points without it have no row
    constexpr std::uint32_t count = 5;
    for (const InputOf<D> &point : points) {
        if (std::isnan(point.attributes[0])) continue;
        std::array<double, 1 + count> row{};
        std::memcpy(row.data(), &point.id, sizeof point.id);
        row[count] = point.attributes[0];
        mesh.host.step_pages[{static_cast<std::uint64_t>(point.id), 0}].assign(
            reinterpret_cast<const unsigned char *>(row.data()), sizeof row);
    }
    abacus_columns &columns = mesh.header.facts.columns;
    columns.in_pages = columns.apart != 0 ? 0 : columns.attributes;
    columns.by_id = 1;
    columns.apart = 0;
    columns.attributes = count;
    for (const std::size_t bytes : {ample, little, std::size_t{1}}) {
        const auto found = values_at<D>(mesh, count - 1, bytes);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_TRUE(found[i] == expected[i] ||
                        (std::isnan(found[i]) && std::isnan(expected[i])))
                << i << ": " << found[i] << ", not " << expected[i];
    }
}

TEST(ValuesById, InThePlaneAsAttributes) {
    for (const int attributes : {1, 3, 40}) expect_same_as_attributes<2>(attributes);
}
TEST(ValuesById, InSpaceAsAttributes) {
    for (const int attributes : {1, 40}) expect_same_as_attributes<3>(attributes);
}

} // namespace
} // namespace abacus::test
