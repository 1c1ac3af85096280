// Labels of simplices: every reader finds the labels with which a mesh was loaded, and the check
// finds wrong ones.
#include "support/labelled_mesh.hpp"

#include <gtest/gtest.h>

namespace abacus::test {
namespace {

template <class Dimension> class SimplexLabels : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SimplexLabels, Dimensions);

TYPED_TEST(SimplexLabels, AreThereForReaders) {
    constexpr int D = TestFixture::D;
    for (const unsigned labels : {1u, 3u, 40u, unsigned{ABACUS_MAX_LABELS}})
        for (const std::size_t memory : {std::size_t{1}, std::size_t{64} << 20}) {
            LabelledMesh<D> mesh(labels);
            mesh.load(some_triangulation<D>(D == 2 ? 2000 : 500), memory);
            mesh.expect_all_in_cells();
            mesh.expect_those_of_places();
            EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
            if (testing::Test::HasFailure()) return;
        }
}

TYPED_TEST(SimplexLabels, SelectSimplicesByRange) {
    constexpr int D = TestFixture::D;
    for (const unsigned labels : {1u, 40u}) {
        LabelledMesh<D> mesh(labels);
        mesh.load(some_triangulation<D>(D == 2 ? 3000 : 800));
        mesh.expect_in_ranges();
        mesh.label({0, labels / 2}, 3);
        mesh.expect_in_ranges();
    }
    LabelledMesh<D> holed(3);
    holed.load(keeping(some_triangulation<D>(1000),
                       [](const Point<D> &c) { return std::abs(c[0] - 0.5) > 0.1; }));
    holed.expect_in_ranges();
}

/// A mesh that is not convex.
TYPED_TEST(SimplexLabels, OfAMeshWithAHole) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(2);
    mesh.load(keeping(some_triangulation<D>(1000),
                      [](const Point<D> &c) { return std::abs(c[0] - 0.5) > 0.1; }));
    EXPECT_EQ(mesh.mesh.loaded_as, ABACUS_NOT_CONVEX);
    mesh.expect_all_in_cells();
    mesh.expect_those_of_places();
    EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
}

/// The pages of simplices do not depend on labels.
TYPED_TEST(SimplexLabels, LeaveSimplexPagesAsTheyAre) {
    constexpr int D = TestFixture::D;
    const auto t = some_triangulation<D>(1000);
    LabelledMesh<D> labelled(5), plain(0);
    labelled.load(t);
    plain.load(t);
    ASSERT_EQ(labelled.mesh.host.pages.size(), plain.mesh.host.pages.size());
    auto other = plain.mesh.host.pages.begin();
    for (const auto &[key, page] : labelled.mesh.host.pages) {
        EXPECT_TRUE(key == other->first);
        EXPECT_EQ(page.words, other->second.words);
        ++other;
    }
    EXPECT_GT(labelled.mesh.host.attribute_pages.size(), 1u);
    EXPECT_TRUE(plain.mesh.host.attribute_pages.empty());
}

TYPED_TEST(SimplexLabels, OfAMeshThatHasAttributesApart) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(2);
    mesh.mesh.header.facts.columns.attributes = 6;
    mesh.mesh.header.facts.columns.apart = 1;
    auto t = some_triangulation<D>(500);
    for (auto &v : t.vertices) v.attributes = {1, 2, 3, 4, 5, double(v.id)};
    for (unsigned i = 0; i < 8; ++i) std::strcpy(mesh.mesh.header.names[i], "a name");
    mesh.load(t);
    mesh.expect_all_in_cells();
    EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
}

TYPED_TEST(SimplexLabels, WhoseNobodyHasOrTooFewAreFaults) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(2);
    mesh.load(some_triangulation<D>(1500));
    auto &pages = mesh.mesh.host.attribute_pages;
    ASSERT_GT(pages.size(), 2u);
    const auto sound = pages;
    pages.erase(std::next(pages.begin()));
    EXPECT_EQ(mesh.mesh.check(),
              std::vector<std::string>{
                  "labels: The pages have more or fewer simplices than the header counts."});
    pages = sound;
    --mesh.mesh.header.facts.census.labelled;
    EXPECT_FALSE(mesh.mesh.check().empty());
    ++mesh.mesh.header.facts.census.labelled;
    // The labels of another mesh with the same number of simplices.
    LabelledMesh<D> other(2);
    auto moved = some_triangulation<D>(1500);
    for (auto &v : moved.vertices)
        for (double &x : v.point) x = 1 - x;
    other.load(moved);
    ASSERT_EQ(other.labelled(), mesh.labelled());
    pages = other.mesh.host.attribute_pages;
    EXPECT_FALSE(mesh.mesh.check().empty());
    pages = sound;
    EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
}

template <int D> std::vector<InputOf<D>> more_points(int n, double width, std::int64_t first_id) {
    std::mt19937_64 random(static_cast<unsigned>(first_id));
    std::uniform_real_distribution<double> along(0, width);
    std::vector<InputOf<D>> points;
    for (int i = 0; i < n; ++i) {
        Point<D> p;
        for (double &x : p) x = along(random);
        points.push_back({first_id + i, p});
    }
    return points;
}

/// A simplex that a change leaves keeps its labels, whatever the kind of change.
TYPED_TEST(SimplexLabels, StayAndGoWithTheirSimplices) {
    constexpr int D = TestFixture::D;
    for (const unsigned threads : {1u, 3u})
        for (const unsigned labels : {2u, 40u}) {
            LabelledMesh<D> mesh(labels, 300 << 10);
            mesh.load(some_triangulation<D>(D == 2 ? 3000 : 700));
            mesh.mesh.host.set_threads(threads, threads > 1);
            for (const int n : {1, 30, 300}) {
                const auto points = more_points<D>(n, 1, 100000 + n);
                ASSERT_EQ(mesh.mesh.insert(points), ABACUS_OK) << mesh.mesh.error.message;
                mesh.expect_followed();
                std::uint64_t deleted = 0;
                ASSERT_EQ(mesh.mesh.remove(points, deleted), ABACUS_OK);
                EXPECT_EQ(deleted, points.size());
                mesh.expect_followed();
                if (testing::Test::HasFailure()) return;
            }
            EXPECT_GT(mesh.mesh.header.facts.census.labelled, 100u);
        }
}

/// A new simplex gets the labels of the one in which its centroid lay, if the mesh inherits labels.
TYPED_TEST(SimplexLabels, AreInherited) {
    constexpr int D = TestFixture::D;
    for (const unsigned threads : {1u, 3u})
        for (const unsigned labels : {2u, 40u}) {
            LabelledMesh<D> mesh(labels, 300 << 10);
            mesh.load(some_triangulation<D>(D == 2 ? 800 : 200));
            mesh.mesh.header.facts.columns.inherits = 1;
            mesh.mesh.host.set_threads(threads, threads > 1);
            for (const int n : {1, 30, 100}) {
                const auto points = more_points<D>(n, 1.1, 100000 + n); // some are outside
                auto before = mesh.all_labelled();
                ASSERT_EQ(mesh.mesh.insert(points), ABACUS_OK) << mesh.mesh.error.message;
                const std::size_t heirs = mesh.expect_inherited(before);
                EXPECT_GE(heirs, n > 1 ? static_cast<std::size_t>(n) : 0u);
                before = mesh.all_labelled();
                std::uint64_t deleted = 0;
                ASSERT_EQ(mesh.mesh.remove(points, deleted), ABACUS_OK);
                EXPECT_EQ(deleted, points.size());
                mesh.expect_inherited(before);
                if (testing::Test::HasFailure()) return;
            }
        }
}

TYPED_TEST(SimplexLabels, AreInheritedInAnotherDomain) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(3);
    mesh.load(some_triangulation<D>(D == 2 ? 1000 : 400));
    mesh.mesh.header.facts.columns.inherits = 1;
    const double width = mesh.mesh.header.facts.form.upper[0];
    const auto before = mesh.all_labelled();
    ASSERT_EQ(mesh.mesh.insert(more_points<D>(2000, 100, 100000)), ABACUS_OK);
    EXPECT_GT(mesh.mesh.header.facts.form.upper[0], width);
    mesh.expect_inherited(before);
    EXPECT_GT(mesh.mesh.header.facts.census.labelled, 500u);
}

TYPED_TEST(SimplexLabels, FollowToAnotherDomain) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(3);
    mesh.load(some_triangulation<D>(2000));
    const double before = mesh.mesh.header.facts.form.upper[0];
    ASSERT_EQ(mesh.mesh.insert(more_points<D>(4000, 100, 100000)), ABACUS_OK);
    EXPECT_GT(mesh.mesh.header.facts.form.upper[0], before);
    mesh.expect_followed();
    EXPECT_GT(mesh.mesh.header.facts.census.labelled, 1000u);
}

/// Most points leave, and the rest is triangulated again; then all leave.
TYPED_TEST(SimplexLabels, OfAMeshThatIsTakenAway) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(3);
    const auto t = some_triangulation<D>(2000);
    mesh.load(t);
    std::vector<InputOf<D>> many(t.vertices.begin(), t.vertices.end() - 100);
    std::uint64_t deleted = 0;
    ASSERT_EQ(mesh.mesh.remove(many, deleted), ABACUS_OK);
    mesh.expect_followed();
    ASSERT_EQ(mesh.mesh.remove({t.vertices.end() - 100, t.vertices.end()}, deleted), ABACUS_OK);
    EXPECT_EQ(mesh.mesh.header.facts.census.simplices, 0u);
    EXPECT_EQ(mesh.mesh.header.facts.census.labelled, 0u);
    EXPECT_TRUE(mesh.mesh.host.attribute_pages.empty());
}

TYPED_TEST(SimplexLabels, AreGivenLater) {
    constexpr int D = TestFixture::D;
    for (const bool is_delaunay : {true, false}) {
        LabelledMesh<D> mesh(0);
        auto t = some_triangulation<D>(D == 2 ? 1500 : 500);
        if (!is_delaunay) flip(t, 200, 3);
        mesh.load(t);
        mesh.label({0}, 1);
        mesh.expect_all_in_cells();
        mesh.label({0}, 2); // other labels
        mesh.expect_all_in_cells();
        std::vector<std::uint32_t> many{0};
        for (std::uint32_t i = 1; i < 70; ++i) many.push_back(i);
        mesh.label(many, 3); // more than a page of labels can hold
        mesh.expect_all_in_cells();
        mesh.label({5, 69, 2}, 4);
        mesh.expect_all_in_cells();
        EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.mesh.host.bytes, 0u);
        if (testing::Test::HasFailure()) return;
    }
}

TYPED_TEST(SimplexLabels, ForASimplexThatIsNoneAreRefused) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(1);
    mesh.load(some_triangulation<D>(300));
    const abacus_simplex simplex = mesh.mesh.simplices(false).front();
    std::vector<std::uint64_t> row{simplex.code};
    row.insert(row.end(), simplex.id, simplex.id + D + 1);
    row.back() = 77777;
    row.push_back(0);
    const std::uint32_t number = 0;
    abacus_labelling *labelling = nullptr;
    abacus_header header = mesh.mesh.header;
    ASSERT_EQ(abacus_labelling_open(mesh.mesh.host.table(), &header.facts, 1, &number, 1, 1 << 16,
                                    1 << 20, &labelling, &mesh.mesh.error),
              ABACUS_OK);
    ASSERT_EQ(abacus_labelling_add(labelling, row.data(), 1, &mesh.mesh.error), ABACUS_OK);
    EXPECT_EQ(abacus_labelling_end(labelling, &header, &mesh.mesh.error), ABACUS_ERROR);
    EXPECT_EQ(mesh.mesh.error.kind, ABACUS_ERROR_ARGUMENT);
    abacus_labelling_close(labelling);
    mesh.expect_all_in_cells();
}

/// The mesh has no labels, or no simplex has one.
TYPED_TEST(SimplexLabels, OfWhichThereAreNone) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(2);
    mesh.load(some_triangulation<D>(100), 64 << 20, 1);
    EXPECT_EQ(mesh.mesh.header.facts.census.labelled, 0u);
    EXPECT_TRUE(mesh.mesh.host.attribute_pages.empty());
    mesh.expect_all_in_cells();
    EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
    Point<D> middle;
    middle.fill(0.5);
    EXPECT_EQ(mesh.mesh.insert({{1000, middle}}), ABACUS_OK) << mesh.mesh.error.message;
}

} // namespace
} // namespace abacus::test
