// Labels of simplices: what a mesh is loaded with is there for every reader, and the check tells
// what is not as it should be.
#include "attributes/attribute_key.hpp"
#include "support/located_places.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

namespace abacus::test {
namespace {

/// Labels by the sorted ids of a simplex.
template <int D> using LabelsByIds = std::map<Ids<D>, std::vector<double>>;

template <int D> Ids<D> ids_of(const abacus_simplex &simplex) {
    Ids<D> ids;
    std::copy_n(simplex.id, D + 1, ids.begin());
    std::sort(ids.begin(), ids.end());
    return ids;
}

bool is_same(const std::vector<double> &a, const double *b) {
    return std::memcmp(a.data(), b, a.size() * sizeof(double)) == 0;
}

template <int D> class LabelledMesh {
public:
    explicit LabelledMesh(unsigned labels, std::size_t cache_bytes = 1 << 20)
        : mesh(0, cache_bytes), labels_(labels) {
        mesh.header.labels = labels;
        for (unsigned i = 0; i < labels; ++i)
            std::strcpy(mesh.header.names[i], ("label " + std::to_string(i)).c_str());
    }

    /// Every `every`th simplex gets none.
    void load(Triangulation<D> t, std::size_t memory = 64 << 20, unsigned every = 7) {
        t.shuffle(5);
        std::mt19937_64 random(4);
        std::vector<std::vector<double>> given;
        for (Ids<D> ids : t.simplices) {
            std::vector<double> row(labels_);
            const bool none = given.size() % every == 0;
            for (double &label : row) {
                const bool null = none || random() % 4 == 0;
                label = null ? null_value : double(random() % 1000);
            }
            given.push_back(row);
            labelled_ +=
                !std::all_of(row.begin(), row.end(), [](double x) { return std::isnan(x); });
            std::sort(ids.begin(), ids.end());
            known_[ids] = row;
        }
        ASSERT_EQ(mesh.load(t.vertices, t.simplices, memory, true, false, given), ABACUS_OK)
            << mesh.error.message << ' ' << mesh.error.detail;
        EXPECT_EQ(mesh.header.labelled, labelled_);
        EXPECT_TRUE(mesh.host.spools.empty());
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
    void expect_all_in_cells() {
        abacus_window window{};
        abacus_cells *cells = nullptr;
        ASSERT_EQ(
            abacus_cells_open(mesh.host.table(), &mesh.header, &window, 0, &cells, &mesh.error),
            ABACUS_OK);
        std::size_t seen = 0;
        abacus_simplex simplex;
        while (abacus_cells_next(cells, &simplex, nullptr, &mesh.error) == ABACUS_OK) {
            const double *labels = nullptr;
            ASSERT_EQ(abacus_cells_labels(cells, &simplex, &labels, &mesh.error), ABACUS_OK);
            ASSERT_TRUE(is_same(known_.at(ids_of<D>(simplex)), labels));
            ++seen;
        }
        abacus_cells_close(cells);
        EXPECT_EQ(seen, known_.size());
    }
    void expect_those_of_places() {
        std::mt19937_64 random(6);
        std::uniform_real_distribution<double> wide(-0.1, 1.1);
        abacus_places *places = nullptr;
        ASSERT_EQ(abacus_places_open(mesh.host.table(), &mesh.header, 1 << 20, 1 << 20, &places,
                                     &mesh.error),
                  ABACUS_OK);
        for (std::uint64_t i = 0; i < 500; ++i) {
            std::array<std::uint64_t, 1 + D> record{i};
            for (int axis = 0; axis < D; ++axis)
                record[1 + axis] = std::bit_cast<std::uint64_t>(wide(random));
            ASSERT_EQ(abacus_places_add(places, record.data(), 1, &mesh.error), ABACUS_OK);
        }
        inside_ = 0;
        EXPECT_EQ(abacus_places_locate(places, expect_labels, this, &mesh.error), ABACUS_OK);
        abacus_places_close(places);
        EXPECT_GT(inside_, 100);
    }
    std::uint64_t labelled() const { return labelled_; }

    MeshOf<D> mesh;

private:
    static abacus_host_status expect_labels(void *context, std::int64_t,
                                            const abacus_simplex *simplex, const double *labels) {
        auto &of = *static_cast<LabelledMesh *>(context);
        EXPECT_EQ(simplex == nullptr, labels == nullptr);
        if (simplex == nullptr) return ABACUS_HOST_OK;
        ++of.inside_;
        EXPECT_TRUE(is_same(of.known_.at(ids_of<D>(*simplex)), labels));
        return ABACUS_HOST_OK;
    }

    unsigned labels_;
    LabelsByIds<D> known_;
    std::uint64_t labelled_ = 0;
    int inside_ = 0;
};

template <int D> Triangulation<D> some_triangulation(int n) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Point<D>> points(static_cast<std::size_t>(n));
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    return delaunay<D>(points);
}

template <class Dimension> class LoadLabels : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LoadLabels, Dimensions);

TYPED_TEST(LoadLabels, AreThereForReaders) {
    constexpr int D = TestFixture::D;
    for (const unsigned labels : {1u, 3u, 40u, unsigned{ABACUS_MAX_NAMES}})
        for (const std::size_t memory : {std::size_t{1}, std::size_t{64} << 20}) {
            LabelledMesh<D> mesh(labels);
            mesh.load(some_triangulation<D>(D == 2 ? 2000 : 500), memory);
            mesh.expect_all_in_cells();
            mesh.expect_those_of_places();
            EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
            if (testing::Test::HasFailure()) return;
        }
}

/// As of one that is not convex.
TYPED_TEST(LoadLabels, OfAMeshWithAHole) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(2);
    mesh.load(keeping(some_triangulation<D>(1000),
                      [](const Point<D> &c) { return std::abs(c[0] - 0.5) > 0.1; }));
    EXPECT_EQ(mesh.mesh.loaded_as, ABACUS_NOT_CONVEX);
    mesh.expect_all_in_cells();
    mesh.expect_those_of_places();
    EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
}

/// The pages of simplices know nothing of labels.
TYPED_TEST(LoadLabels, LeaveSimplexPagesAsTheyAre) {
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

TYPED_TEST(LoadLabels, OfAMeshThatHasAttributesApart) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(2);
    mesh.mesh.header.attributes = 6;
    mesh.mesh.header.apart = 1;
    auto t = some_triangulation<D>(500);
    for (auto &v : t.vertices) v.attributes = {1, 2, 3, 4, 5, double(v.id)};
    for (unsigned i = 0; i < 8; ++i) std::strcpy(mesh.mesh.header.names[i], "a name");
    mesh.load(t);
    mesh.expect_all_in_cells();
    EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
}

TYPED_TEST(LoadLabels, WhoseNobodyHasOrTooFewAreFaults) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(2);
    mesh.load(some_triangulation<D>(1500));
    auto &pages = mesh.mesh.host.attribute_pages;
    ASSERT_GT(pages.size(), 2u);
    const auto sound = pages;
    pages.erase(std::next(pages.begin()));
    EXPECT_EQ(mesh.mesh.check(),
              std::vector<std::string>{
                  "labels: The pages of labels have other simplices than the header counts."});
    pages = sound;
    --mesh.mesh.header.labelled;
    EXPECT_FALSE(mesh.mesh.check().empty());
    ++mesh.mesh.header.labelled;
    // Those of another mesh with as many.
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

/// None of its simplices may go while nobody takes its labels away.
TYPED_TEST(LoadLabels, AMeshWithThemIsNotChanged) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(1);
    mesh.load(some_triangulation<D>(100));
    Point<D> middle;
    middle.fill(0.5);
    EXPECT_EQ(mesh.mesh.insert({{1, middle}}), ABACUS_ERROR);
    EXPECT_EQ(mesh.mesh.error.kind, ABACUS_ERROR_STATE);
    std::uint64_t deleted = 0;
    EXPECT_EQ(mesh.mesh.remove({{1, middle}}, deleted), ABACUS_ERROR);
    EXPECT_EQ(mesh.mesh.error.kind, ABACUS_ERROR_STATE);
    mesh.expect_all_in_cells();
}

/// Nobody has named labels, or no simplex has one.
TYPED_TEST(LoadLabels, OfWhichThereAreNone) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(2);
    mesh.load(some_triangulation<D>(100), 64 << 20, 1);
    EXPECT_EQ(mesh.mesh.header.labelled, 0u);
    EXPECT_TRUE(mesh.mesh.host.attribute_pages.empty());
    mesh.expect_all_in_cells();
    EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
    Point<D> middle;
    middle.fill(0.5);
    EXPECT_EQ(mesh.mesh.insert({{1000, middle}}), ABACUS_OK) << mesh.mesh.error.message;
}

} // namespace
} // namespace abacus::test
