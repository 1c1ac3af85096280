// The same templates in 3D: the mesh equals CGAL's Delaunay tetrahedra, one by one, on
// cospherical, coplanar, clustered and general input, whatever the size of the cache.
#include "delaunay/insertion.hpp"
#include "support/staged_points.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <functional>

namespace abacus {
namespace {

using Points = std::vector<Point<3>>;
using Tetrahedron = std::array<Point<3>, 4>; // corners in lexicographic order
using Random = std::mt19937_64;

double unit(Random &random) { return std::uniform_real_distribution<double>(0, 1)(random); }

std::vector<Tetrahedron> cgal_tetrahedra(const Points &points) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_3> input;
    for (const auto &p : points) input.emplace_back(p[0], p[1], p[2]);
    const CGAL::Delaunay_triangulation_3<Kernel> mesh(input.begin(), input.end());
    std::vector<Tetrahedron> result;
    if (mesh.dimension() < 3) return result;
    for (auto cell = mesh.finite_cells_begin(); cell != mesh.finite_cells_end(); ++cell) {
        Tetrahedron t;
        for (int i = 0; i < 4; ++i) {
            const auto &p = cell->vertex(i)->point();
            t[i] = {p.x(), p.y(), p.z()};
        }
        std::sort(t.begin(), t.end());
        result.push_back(t);
    }
    std::sort(result.begin(), result.end());
    return result;
}

std::vector<Tetrahedron> stored_tetrahedra(MemoryHost &host, const abacus_header &header) {
    std::vector<Tetrahedron> result;
    abacus_error error{};
    abacus_scan *scan = nullptr;
    EXPECT_EQ(abacus_scan_open(host.table(), &header, 0, &scan, &error), ABACUS_OK);
    abacus_simplex simplex;
    while (abacus_scan_next(scan, &simplex, &error) == ABACUS_OK) {
        Tetrahedron t;
        for (int i = 0; i < 4; ++i)
            t[i] = {simplex.corner[i][0], simplex.corner[i][1], simplex.corner[i][2]};
        std::sort(t.begin(), t.end());
        result.push_back(t);
    }
    abacus_scan_close(scan);
    std::sort(result.begin(), result.end());
    return result;
}

struct DataSet {
    const char *name;
    std::function<Points(Random &)> points;
};

Points make(int n, const std::function<Point<3>(int)> &point) {
    Points points;
    for (int i = 0; i < n; ++i) points.push_back(point(i));
    return points;
}

const DataSet data_sets[] = {
    {"uniform",
     [](Random &r) {
         return make(6000, [&](int) { return Point<3>{unit(r), unit(r), unit(r)}; });
     }},
    {"grid",
     [](Random &) {
         return make(12 * 12 * 12, [](int i) {
             return Point<3>{i % 12 + 0.0, i / 12 % 12 + 0.0, i / 144 + 0.0};
         });
     }},
    {"integer_points_of_a_sphere",
     [](Random &) {
         constexpr int radius = 45;
         Points points;
         for (int x = -radius; x <= radius; ++x)
             for (int y = -radius; y <= radius; ++y)
                 for (int z = -radius; z <= radius; ++z)
                     if (x * x + y * y + z * z == radius * radius)
                         points.push_back({x + 0.0, y + 0.0, z + 0.0});
         return points;
     }},
    {"skew_lines",
     [](Random &r) {
         return make(200, [&](int i) {
             const double t = unit(r);
             return i % 2 == 0 ? Point<3>{t, 0, 0} : Point<3>{0.3, t, 1};
         });
     }},
    {"clusters_below_the_code",
     [](Random &r) {
         return make(2000, [&](int i) {
             return Point<3>{i % 5 * 0.2 + unit(r) * 1e-12, i % 3 * 0.3 + unit(r) * 1e-12,
                             i % 7 * 0.1 + unit(r) * 1e-12};
         });
     }},
    {"coplanar",
     [](Random &r) { return make(200, [&](int) {
                         return Point<3>{unit(r), unit(r), 0};
                     }); }},
};

class Tetrahedralization : public testing::TestWithParam<DataSet> {};

TEST_P(Tetrahedralization, EqualsCgalForEveryCacheSize) {
    Random random(7);
    Points points = GetParam().points(random);
    const std::vector<Tetrahedron> expected = cgal_tetrahedra(points);
    for (const std::size_t cache : {std::size_t(500) << 10, std::size_t(1) << 30}) {
        std::shuffle(points.begin(), points.end(), random);
        MemoryHost host;
        abacus_header header = empty_header<3>();
        abacus_error error{};
        ASSERT_EQ(stage<3>(host, header, with_ids<3>(points), ample, error), ABACUS_OK);
        abacus_build *build = nullptr;
        ASSERT_EQ(abacus_build_open(host.table(), &header, cache, &build, &error), ABACUS_OK);
        EXPECT_EQ(abacus_build_run(build, 0, &header, &error), ABACUS_OK) << error.detail;
        abacus_build_close(build);
        EXPECT_EQ(stored_tetrahedra(host, header), expected) << "cache of " << cache << " bytes";
        EXPECT_EQ(host.violations, std::vector<std::string>{});
    }
}

INSTANTIATE_TEST_SUITE_P(Inputs, Tetrahedralization, testing::ValuesIn(data_sets),
                         [](const auto &info) { return info.param.name; });

TEST(ProbingInSpace, GivesTheSameMeshAsStoredLinks) {
    Random random(8);
    const Points points = make(3000, [&](int) {
        return Point<3>{unit(random), unit(random), unit(random)};
    });
    MemoryHost memory;
    const Host host = memory.host();
    Cache<3> cache(host, Domain<3>({0, 0, 0}, {1, 1, 1}), 0,
                   {.budget = std::size_t(400) << 10, .stored_links = false});
    Insertion<3> insertion(host, cache, 0, 0);
    std::array<VertexIndex, 4> first;
    for (int i = 0; i < 4; ++i) first[i] = cache.create_vertex(points[i], i, nullptr);
    insertion.start(first);
    for (std::size_t i = 4; i < points.size(); ++i)
        EXPECT_TRUE(insertion.insert(points[i], static_cast<std::int64_t>(i), nullptr));
    cache.flush();
    EXPECT_GT(cache.counters.quick_probes, 0u);
    EXPECT_GT(cache.counters.ray_probes, 0u);
    EXPECT_GT(cache.counters.concentric_probes, 0u);
    EXPECT_EQ(cache.counters.link_probes, 0u);

    abacus_header header = empty_header<3>();
    header.has_domain = 1;
    std::fill_n(header.upper, 3, 1.0);
    header.points = header.inserted = header.vertices = points.size();
    header.simplices = static_cast<std::uint64_t>(insertion.simplices());
    header.ghosts = static_cast<std::uint64_t>(insertion.ghosts());
    EXPECT_EQ(stored_tetrahedra(memory, header), cgal_tetrahedra(points));
    EXPECT_EQ(memory.violations, std::vector<std::string>{});
}

} // namespace
} // namespace abacus
