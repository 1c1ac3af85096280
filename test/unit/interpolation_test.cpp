// Values between the vertices: identities that every method keeps, brute force, and CGAL's natural
// neighbour coordinates.
#include "geometry/distance.hpp"
#include "support/containment.hpp"
#include "support/large_mesh.hpp"
#include "support/lattice.hpp"
#include "support/triangulations.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/natural_neighbor_coordinates_2.h>
#include <CGAL/natural_neighbor_coordinates_3.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace abacus::test {
namespace {

template <class Dimension> class Interpolation : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Interpolation, Dimensions);

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t little = 60 << 10;

abacus_interpolation how(abacus_method method, abacus_outside outside = ABACUS_OUTSIDE_NOTHING,
                         double max_edge = 0) {
    abacus_interpolation how{};
    how.method = method;
    how.outside = outside;
    how.extent.max_edge = max_edge;
    how.attributes = 1;
    return how;
}

template <int D> double linear(const Point<D> &p) {
    double sum = 1;
    for (int i = 0; i < D; ++i) sum += (i + 2) * p[i];
    return sum;
}

/// A mesh with the linear function, and one without every third value.
template <int D> struct Field : MeshOf<D> {
    explicit Field(const std::vector<Point<D>> &points) : MeshOf<D>(2), points(points) {
        std::vector<InputOf<D>> input;
        for (std::size_t i = 0; i < points.size(); ++i)
            input.push_back({static_cast<std::int64_t>(i),
                             points[i],
                             {linear<D>(points[i]), i % 3 == 0 ? nan : 7}});
        EXPECT_EQ(this->insert(input), ABACUS_OK) << this->error.detail;
    }
    const std::vector<Point<D>> points;
};

using Weights = std::map<std::int64_t, double>;

template <int D>
std::optional<Weights> weights_at(OpenMeshOf<D> &open, const abacus_interpolation &how,
                                  const Point<D> &p) {
    const abacus_weight *weights = nullptr;
    std::size_t count = 0;
    const abacus_status status = open.weigh(how, p, weights, count);
    EXPECT_TRUE(status == ABACUS_OK || status == ABACUS_END) << open.error.message;
    if (status != ABACUS_OK) return std::nullopt;
    Weights result;
    for (std::size_t i = 0; i < count; ++i) result[weights[i].vertex] += weights[i].weight;
    EXPECT_EQ(result.size(), count);
    return result;
}

/// Weights are positive, sum to 1, and their vertices' mean is the place.
template <int D>
void expect_partition(const Weights &weights, const std::vector<Point<D>> &points,
                      const Point<D> &p, double extent = 1) {
    double sum = 0;
    Point<D> mean{};
    for (const auto &[id, weight] : weights) {
        EXPECT_GT(weight, 0);
        sum += weight;
        for (int i = 0; i < D; ++i) mean[i] += weight * points[static_cast<std::size_t>(id)][i];
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    for (int i = 0; i < D; ++i) EXPECT_NEAR(mean[i], p[i], 1e-11 * extent);
}

template <int D>
std::optional<double> value_at(OpenMeshOf<D> &open, const abacus_interpolation &how,
                               const Point<D> &p) {
    double value = 0;
    const abacus_status status = open.interpolate(how, p, &value);
    EXPECT_TRUE(status == ABACUS_OK || status == ABACUS_END) << open.error.message;
    return status == ABACUS_OK ? std::optional(value) : std::nullopt;
}

template <int D> bool is_in(const std::vector<abacus_simplex> &all, const Point<D> &p) {
    return std::any_of(all.begin(), all.end(), [&](const auto &s) { return contains<D>(s, p); });
}

TYPED_TEST(Interpolation, ReproducesLinearFunctions) {
    constexpr int D = TypeParam::value;
    for (const auto &points :
         {random_points<D>(D == 2 ? 3000 : 800, 1), grid<D>(D == 2 ? 20 : 7)}) {
        Field<D> field(points);
        OpenMeshOf<D> ample_cache(field, ample), small(field, little);
        const double extent = points.back()[0] > 1 ? points.back()[0] : 1;
        Random random(2);
        int inside = 0;
        for (int i = 0; i < 1000; ++i) {
            Point<D> p = unit_point<D>(random);
            for (double &x : p) x *= extent * 1.05;
            if (i % 4 == 1) p = points[random() % points.size()];
            if (i % 4 == 2)
                for (int axis = 0; axis < D; ++axis) p[axis] = std::round(2 * p[axis]) / 2;
            for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL}) {
                const auto weights = weights_at<D>(ample_cache, how(method), p);
                ASSERT_EQ(weights.has_value(),
                          weights_at<D>(small, how(ABACUS_LINEAR), p).has_value());
                if (!weights) continue;
                ++inside;
                expect_partition<D>(*weights, points, p, extent);
                EXPECT_NEAR(*value_at<D>(small, how(method), p), linear<D>(p), 1e-10 * extent);
            }
        }
        EXPECT_GT(inside, 1000);
        EXPECT_EQ(field.host.violations, std::vector<std::string>{});
    }
}

TYPED_TEST(Interpolation, IsExactAtVertices) {
    constexpr int D = TypeParam::value;
    const auto points = random_points<D>(300, 3);
    Field<D> field(points);
    OpenMeshOf<D> open(field, ample);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL, ABACUS_NEAREST}) {
            EXPECT_EQ(weights_at<D>(open, how(method), points[i]),
                      (Weights{{static_cast<std::int64_t>(i), 1.0}}));
            EXPECT_EQ(value_at<D>(open, how(method), points[i]), linear<D>(points[i]));
        }
}

TYPED_TEST(Interpolation, LacksAValueWhereAVertexThatCountsLacksIt) {
    constexpr int D = TypeParam::value;
    const auto points = random_points<D>(500, 4);
    Field<D> field(points);
    OpenMeshOf<D> open(field, ample);
    Random random(5);
    for (int i = 0; i < 500; ++i) {
        Point<D> p = i % 2 == 0 ? unit_point<D>(random) : points[random() % points.size()];
        for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL, ABACUS_NEAREST}) {
            abacus_interpolation second = how(method);
            second.attribute[0] = 1;
            const auto weights = weights_at<D>(open, second, p);
            const auto value = value_at<D>(open, second, p);
            ASSERT_EQ(weights.has_value(), value.has_value());
            if (!value) continue;
            const bool lacks = std::any_of(weights->begin(), weights->end(),
                                           [](const auto &w) { return w.first % 3 == 0; });
            EXPECT_EQ(std::isnan(*value), lacks);
            if (!lacks) {
                EXPECT_EQ(*value, 7); // a constant, without rounding
            }
        }
    }
}

TYPED_TEST(Interpolation, OutsideIsNothingOrTheNearest) {
    constexpr int D = TypeParam::value;
    const auto points = random_points<D>(200, 6);
    Field<D> field(points);
    const auto all = field.simplices(false);
    OpenMeshOf<D> open(field, ample);
    Random random(7);
    for (int i = 0; i < 300; ++i) {
        Point<D> p = unit_point<D>(random);
        for (double &x : p) x = 3 * x - 1;
        const auto nearest =
            std::min_element(points.begin(), points.end(), [&](const auto &a, const auto &b) {
                return comes_nearer<D>(p, a, b);
            });
        const bool is_inside = is_in<D>(all, p);
        for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL, ABACUS_NEAREST}) {
            const auto value = value_at<D>(open, how(method), p);
            EXPECT_EQ(value.has_value(), is_inside);
            const auto filled = value_at<D>(open, how(method, ABACUS_OUTSIDE_NEAREST), p);
            EXPECT_EQ(filled, is_inside ? *value : linear<D>(*nearest));
            if (method == ABACUS_NEAREST) {
                EXPECT_EQ(filled, linear<D>(*nearest));
            }
        }
    }
}

TYPED_TEST(Interpolation, LeavesOutSimplicesThatAreTooLong) {
    constexpr int D = TypeParam::value;
    const double bound = D == 2 ? 0.12 : 0.35;
    auto points = random_points<D>(400, 8);
    Field<D> field(points);
    const auto is_short = [&](const abacus_simplex &s) {
        for (int i = 0; i <= D; ++i)
            for (int j = 0; j < i; ++j) {
                double square = 0;
                for (int axis = 0; axis < D; ++axis)
                    square += std::pow(s.corner[i][axis] - s.corner[j][axis], 2);
                if (std::sqrt(square) > bound) return false;
            }
        return true;
    };
    auto all = field.simplices(false);
    std::erase_if(all, [&](const auto &s) { return !is_short(s); });
    OpenMeshOf<D> open(field, ample), small(field, little);
    Random random(9);
    int left_out = 0, inside = 0;
    for (int i = 0; i < 600; ++i) {
        // At a vertex, where simplices of both kinds meet, a single short one is enough.
        const Point<D> p = i % 2 == 0 ? unit_point<D>(random) : points[random() % points.size()];
        const bool is_inside = is_in<D>(all, p);
        for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL, ABACUS_NEAREST})
            for (auto *mesh : {&open, &small})
                EXPECT_EQ(
                    value_at<D>(*mesh, how(method, ABACUS_OUTSIDE_NOTHING, bound), p).has_value(),
                    is_inside);
        left_out += !is_inside && value_at<D>(open, how(ABACUS_LINEAR), p);
        inside += is_inside;
    }
    EXPECT_GT(left_out, 20);
    EXPECT_GT(inside, 20);
}

TYPED_TEST(Interpolation, OfManyPlacesIsThatOfEach) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 20000 : 4000, 1);
    std::vector<InputOf<D>> places;
    for (int i = 0; i < 1000; ++i) places.push_back({i, mesh.place(i)});
    std::vector<std::uint64_t> records;
    for (const auto &place : places) {
        records.push_back(std::bit_cast<std::uint64_t>(place.id));
        for (const double x : place.point) records.push_back(std::bit_cast<std::uint64_t>(x));
    }
    OpenMeshOf<D> open(mesh, ample);
    for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL, ABACUS_NEAREST}) {
        const abacus_interpolation wanted = how(method);
        std::map<std::int64_t, Weights> together;
        const auto keep = [](void *context, std::int64_t id, const abacus_weight *weights,
                             std::size_t count) {
            auto &all = *static_cast<std::map<std::int64_t, Weights> *>(context);
            for (std::size_t i = 0; i < count; ++i) all[id][weights[i].vertex] = weights[i].weight;
            return ABACUS_HOST_OK;
        };
        std::map<std::int64_t, double> values;
        const auto keep_value = [](void *context, std::int64_t id, const double *value) {
            if (value != nullptr)
                (*static_cast<std::map<std::int64_t, double> *>(context))[id] = *value;
            return ABACUS_HOST_OK;
        };
        for (const bool weigh : {true, false}) {
            abacus_places *handle = nullptr;
            ASSERT_EQ(abacus_places_open(mesh.host.table(), &mesh.header.facts, 16 << 20,
                                         mesh.tenth(), &handle, &mesh.error),
                      ABACUS_OK);
            ASSERT_EQ(abacus_places_add(handle, records.data(), places.size(), &mesh.error),
                      ABACUS_OK);
            ASSERT_EQ(weigh ? abacus_places_weigh(handle, &wanted, keep, &together, &mesh.error)
                            : abacus_places_interpolate(handle, &wanted, keep_value, &values,
                                                        &mesh.error),
                      ABACUS_OK)
                << mesh.error.message;
            abacus_places_close(handle);
        }
        for (const auto &place : places) {
            const auto weights = weights_at<D>(open, wanted, place.point);
            ASSERT_EQ(together.count(place.id) == 1, weights.has_value());
            EXPECT_EQ(values.count(place.id) == 1, weights.has_value());
            if (!weights) continue;
            EXPECT_EQ(values[place.id], 0.5);
            ASSERT_EQ(together[place.id].size(), weights->size());
            for (const auto &[id, weight] : *weights)
                EXPECT_NEAR(together[place.id][id], weight, 1e-12);
        }
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Weights cgal_weights(const CGAL::Delaunay_triangulation_2<Kernel> &t,
                     const std::map<Point<2>, std::int64_t> &ids, const Point<2> &p) {
    std::vector<std::pair<Kernel::Point_2, double>> found;
    const auto result =
        CGAL::natural_neighbor_coordinates_2(t, {p[0], p[1]}, std::back_inserter(found));
    Weights weights;
    if (result.third)
        for (const auto &[at, weight] : found)
            weights[ids.at({at.x(), at.y()})] = weight / result.second;
    return weights;
}

Weights cgal_weights(const CGAL::Delaunay_triangulation_3<Kernel> &t,
                     const std::map<Point<3>, std::int64_t> &ids, const Point<3> &p) {
    std::vector<std::pair<CGAL::Delaunay_triangulation_3<Kernel>::Vertex_handle, double>> found;
    double norm = 0;
    const auto result = CGAL::sibson_natural_neighbor_coordinates_3(
        t, {p[0], p[1], p[2]}, std::back_inserter(found), norm);
    Weights weights;
    if (result.third)
        for (const auto &[v, weight] : found)
            weights[ids.at({v->point().x(), v->point().y(), v->point().z()})] = weight / norm;
    return weights;
}

TYPED_TEST(Interpolation, HasTheNaturalNeighboursOfCgal) {
    constexpr int D = TypeParam::value;
    const auto points = random_points<D>(D == 2 ? 2000 : 600, 10);
    Field<D> field(points);
    OpenMeshOf<D> open(field, ample);
    std::map<Point<D>, std::int64_t> ids;
    std::conditional_t<D == 2, CGAL::Delaunay_triangulation_2<Kernel>,
                       CGAL::Delaunay_triangulation_3<Kernel>>
        t;
    for (const Point<D> &p : points) {
        ids.emplace(p, ids.size());
        if constexpr (D == 2)
            t.insert({p[0], p[1]});
        else
            t.insert({p[0], p[1], p[2]});
    }
    Random random(11);
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
        Point<D> p = unit_point<D>(random);
        for (double &x : p) x = 0.1 + 0.8 * x;
        const Weights expected = cgal_weights(t, ids, p);
        const auto weights = weights_at<D>(open, how(ABACUS_NATURAL), p);
        ASSERT_TRUE(weights);
        if (expected.empty()) continue;
        ++compared;
        for (const auto &[id, weight] : expected)
            EXPECT_NEAR(weights->count(id) ? weights->at(id) : 0, weight, 1e-9);
        for (const auto &[id, weight] : *weights)
            EXPECT_NEAR(expected.count(id) ? expected.at(id) : 0, weight, 1e-9);
    }
    EXPECT_GT(compared, 250);
}

TYPED_TEST(Interpolation, NaturalIsSymmetricInAGrid) {
    constexpr int D = TypeParam::value;
    Field<D> field(grid<D>(6));
    OpenMeshOf<D> open(field, ample);
    Point<D> p;
    p.fill(2.5);
    const auto weights = weights_at<D>(open, how(ABACUS_NATURAL), p);
    ASSERT_TRUE(weights);
    EXPECT_EQ(weights->size(), std::size_t{1} << D); // whatever diagonals there are
    for (const auto &[id, weight] : *weights) EXPECT_NEAR(weight, 1.0 / (1 << D), 1e-14);
}

TYPED_TEST(Interpolation, NaturalIsTheSameToTheBitHoweverTheMeshCameAbout) {
    constexpr int D = TypeParam::value;
    const auto together = grid<D>(6);
    auto points = random_points<D>(400, 13);
    points.insert(points.end(), together.begin(), together.end());
    Field<D> field(points);
    MeshOf<D> other(2); // in three steps, the last points first
    for (std::size_t step = 3; step-- > 0;) {
        std::vector<InputOf<D>> input;
        for (std::size_t i = points.size(); i-- > 0;)
            if (i % 3 == step)
                input.push_back(
                    {static_cast<std::int64_t>(i), points[i], {linear<D>(points[i]), 7}});
        ASSERT_EQ(other.insert(input), ABACUS_OK) << other.error.detail;
    }
    OpenMeshOf<D> open(field, ample), reopened(other, little);
    Random random(14);
    for (int i = 0; i < 300; ++i) {
        Point<D> p = unit_point<D>(random);
        // In a grid many places lie on facets, and around them spheres pass through many points.
        for (double &x : p) x = i % 2 == 0 ? 0.1 + 0.8 * x : std::floor(2 + 6 * x) / 2;
        ASSERT_EQ(weights_at<D>(open, how(ABACUS_NATURAL), p),
                  weights_at<D>(reopened, how(ABACUS_NATURAL), p));
        Point<D> elsewhere = unit_point<D>(random); // so that the walk starts there
        for (double &x : elsewhere) x *= 5;
        weights_at<D>(reopened, how(ABACUS_NATURAL), elsewhere);
    }
}

TYPED_TEST(Interpolation, NaturalOnTheHullIsLinear) {
    constexpr int D = TypeParam::value;
    Field<D> field(grid<D>(6));
    OpenMeshOf<D> open(field, ample);
    Random random(12);
    for (int i = 0; i < 100; ++i) {
        Point<D> p = unit_point<D>(random);
        for (double &x : p) x *= 5;
        p[i % D] = i % 2 * 5;
        EXPECT_EQ(weights_at<D>(open, how(ABACUS_NATURAL), p),
                  weights_at<D>(open, how(ABACUS_LINEAR), p));
    }
}

TYPED_TEST(Interpolation, FarFromTheOriginAndOfAnySize) {
    constexpr int D = TypeParam::value;
    for (const double scale : {1e-300, 1e-8, 1e8, 1e300}) {
        auto points = random_points<D>(200, 13);
        for (auto &p : points)
            for (double &x : p) x *= scale;
        Field<D> field(points);
        OpenMeshOf<D> open(field, ample);
        Random random(14);
        for (int i = 0; i < 100; ++i) {
            Point<D> p = unit_point<D>(random);
            for (double &x : p) x *= scale;
            for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL})
                if (const auto weights = weights_at<D>(open, how(method), p))
                    expect_partition<D>(*weights, points, p, scale);
        }
    }
}

TYPED_TEST(Interpolation, NaturalNeedsADelaunayMesh) {
    constexpr int D = TypeParam::value;
    auto t = keeping<D>(delaunay<D>(random_points<D>(300, 15)), [](const auto &c) {
        return std::abs(c[0] - 0.5) + std::abs(c[1] - 0.5) > 0.2; // a hole
    });
    for (auto &v : t.vertices) v.attributes = {linear<D>(v.point)};
    MeshOf<D> mesh(1, ample);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.detail;
    OpenMeshOf<D> open(mesh, ample);
    Random random(16);
    for (int i = 0; i < 200; ++i) {
        const Point<D> p = unit_point<D>(random);
        const auto value = value_at<D>(open, how(ABACUS_LINEAR), p);
        if (value) {
            EXPECT_NEAR(*value, linear<D>(p), 1e-12);
        }
        const auto nearest = std::min_element(
            t.vertices.begin(), t.vertices.end(),
            [&](const auto &a, const auto &b) { return comes_nearer<D>(p, a.point, b.point); });
        EXPECT_EQ(value_at<D>(open, how(ABACUS_LINEAR, ABACUS_OUTSIDE_NEAREST), p),
                  value ? *value : linear<D>(nearest->point));
    }
    double value = 0;
    EXPECT_EQ(open.interpolate(how(ABACUS_NATURAL), t.vertices[0].point, &value), ABACUS_ERROR);
    EXPECT_EQ(open.error.kind, ABACUS_ERROR_STATE);
}

TYPED_TEST(Interpolation, OfAnEmptyMeshIsNothing) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1, ample);
    OpenMeshOf<D> open(mesh, ample);
    for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL, ABACUS_NEAREST})
        for (const abacus_outside outside : {ABACUS_OUTSIDE_NOTHING, ABACUS_OUTSIDE_NEAREST})
            EXPECT_FALSE(value_at<D>(open, how(method, outside), Point<D>{}));
}

TYPED_TEST(Interpolation, GradientsAreThoseOfLinearFunctions) {
    constexpr int D = TypeParam::value;
    const auto points = random_points<D>(500, 17);
    Field<D> field(points);
    OpenMeshOf<D> open(field, ample);
    Random random(18);
    for (int i = 0; i < 300; ++i) {
        const Point<D> p = unit_point<D>(random);
        Point<D> gradient;
        const abacus_status status = open.gradient(how(ABACUS_LINEAR), p, gradient.data());
        EXPECT_EQ(status == ABACUS_OK, value_at<D>(open, how(ABACUS_LINEAR), p).has_value());
        if (status != ABACUS_OK) continue;
        for (int axis = 0; axis < D; ++axis) EXPECT_NEAR(gradient[axis], axis + 2, 1e-8);
    }
}

TEST(Gradient, OfAFlatTriangleIsExact) {
    // Height 1e-17 over an edge of length 1: differences of doubles lose it completely.
    Mesh mesh(1);
    const double small = 1e-17;
    ASSERT_EQ(mesh.insert({{1, {0, 0}, {0}}, {2, {1, 0}, {0}}, {3, {0.5, small}, {1}}}), ABACUS_OK);
    OpenMesh open(mesh, ample);
    Point<2> gradient;
    ASSERT_EQ(open.gradient(how(ABACUS_LINEAR), {0.5, small / 2}, gradient.data()), ABACUS_OK);
    EXPECT_EQ(gradient, (Point<2>{0, 1 / small}));
}

} // namespace
} // namespace abacus::test
