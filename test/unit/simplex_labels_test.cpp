// Labels of simplices: what a mesh is loaded with is there for every reader, and the check tells
// what is not as it should be.
#include "attributes/attribute_key.hpp"
#include "geometry/predicates.hpp"
#include "keys/domain_of.hpp"
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
    /// Gives some simplices other values of these labels, of which the last ones may be new.
    void label(const std::vector<std::uint32_t> &numbers, unsigned seed) {
        std::mt19937_64 random(seed);
        const std::uint32_t known = mesh.header.labels;
        abacus_header named = mesh.header;
        for (const std::uint32_t number : numbers)
            if (number >= named.labels) {
                named.labels = number + 1;
                std::strcpy(named.names[number], ("label " + std::to_string(number)).c_str());
            }
        labels_ = named.labels;
        for (auto &[ids, row] : known_) row.resize(labels_, null_value);
        auto simplices = mesh.simplices(false);
        std::shuffle(simplices.begin(), simplices.end(), random);
        simplices.resize(simplices.size() / 2);
        std::vector<std::uint64_t> rows;
        for (const abacus_simplex &simplex : simplices) {
            rows.push_back(simplex.code);
            Ids<D> ids = ids_of<D>(simplex);
            std::shuffle(ids.begin(), ids.end(), random);
            rows.insert(rows.end(), ids.begin(), ids.end());
            for (const std::uint32_t number : numbers) {
                const double value = random() % 9 == 0 ? null_value : double(random() % 100);
                rows.push_back(std::bit_cast<std::uint64_t>(value));
                known_.at(ids_of<D>(simplex))[number] = value;
            }
        }
        abacus_labelling *labelling = nullptr;
        ASSERT_EQ(abacus_labelling_open(mesh.host.table(), &named, known, numbers.data(),
                                        numbers.size(), 1 << 16, 1 << 20, &labelling, &mesh.error),
                  ABACUS_OK);
        EXPECT_EQ(abacus_labelling_add(labelling, rows.data(), simplices.size(), &mesh.error),
                  ABACUS_OK);
        EXPECT_EQ(abacus_labelling_end(labelling, &named, &mesh.error), ABACUS_OK)
            << mesh.error.message;
        abacus_labelling_close(labelling);
        mesh.header = named;
    }
    /// After a change: simplices that are still there have kept theirs, others have none.
    void expect_followed() {
        LabelsByIds<D> left;
        std::uint64_t kept = 0;
        for (const abacus_simplex &simplex : mesh.simplices(false)) {
            const auto before = known_.find(ids_of<D>(simplex));
            const bool is_new = before == known_.end();
            left[ids_of<D>(simplex)] =
                is_new ? std::vector<double>(labels_, null_value) : before->second;
            kept += !is_new;
        }
        EXPECT_LT(kept, known_.size());
        known_ = left;
        expect_all_in_cells();
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_TRUE(mesh.host.spools.empty());
    }
    /// A simplex that has labels.
    struct Labelled {
        Owner<D, D + 1> simplex;
        std::vector<double> labels;
    };
    std::vector<Labelled> all_labelled() {
        std::vector<Labelled> result;
        for (const abacus_simplex &simplex : mesh.simplices(false)) {
            const auto &labels = known_.at(ids_of<D>(simplex));
            if (std::all_of(labels.begin(), labels.end(), [](double x) { return std::isnan(x); }))
                continue;
            result.push_back({owner(simplex), labels});
        }
        return result;
    }
    /// After a change: those that are still there have kept theirs, others have what the one had
    /// before in which their centroid lies. Returns how many have got some so.
    std::size_t expect_inherited(const std::vector<Labelled> &before) {
        LabelsByIds<D> now;
        std::size_t heirs = 0;
        for (const abacus_simplex &simplex : mesh.simplices(false)) {
            const Ids<D> ids = ids_of<D>(simplex);
            if (known_.contains(ids)) {
                now[ids] = known_[ids];
                continue;
            }
            const Labelled *from = has_centroid(before, owner(simplex));
            now[ids] = from == nullptr ? std::vector<double>(labels_, null_value) : from->labels;
            heirs += from != nullptr;
        }
        known_ = now;
        expect_all_in_cells();
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_TRUE(mesh.host.spools.empty());
        return heirs;
    }
    std::uint64_t labelled() const { return labelled_; }

    MeshOf<D> mesh;

private:
    static Owner<D, D + 1> owner(const abacus_simplex &simplex) {
        std::array<Point<D>, D + 1> points;
        for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, points[i].begin());
        return owner_of<D, D + 1>(points);
    }
    static int position(const Owner<D, D + 1> &simplex, const Point<D> &p) {
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) corners[i] = &simplex[i];
        if (orientation<D>(corners) < 0) std::swap(corners[0], corners[1]);
        return in_simplex<D>(corners, p);
    }
    /// Of several the one with the least key; null if there is none.
    const Labelled *has_centroid(const std::vector<Labelled> &all, const Owner<D, D + 1> &simplex) {
        const Domain<D> domain = domain_of<D>(mesh.header);
        Point<D> centroid{};
        for (const Point<D> &p : simplex)
            for (int axis = 0; axis < D; ++axis) centroid[axis] += p[axis] / (D + 1);
        if (position(simplex, centroid) <= 0) return nullptr;
        const auto key = [&](const Labelled &labelled) {
            return attribute_key<D, D + 1>(labelled.simplex,
                                           code_of<D, D + 1>(domain, labelled.simplex));
        };
        const Labelled *first = nullptr;
        for (const Labelled &labelled : all)
            if (position(labelled.simplex, centroid) >= 0 &&
                (first == nullptr || key(labelled) < key(*first)))
                first = &labelled;
        return first;
    }

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

/// As of one that is not convex.
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

/// The pages of simplices know nothing of labels.
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
    mesh.mesh.header.attributes = 6;
    mesh.mesh.header.apart = 1;
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
                  "labels: The pages have another number of simplices than the header counts."});
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

/// A simplex that a change leaves keeps them, whoever made the change.
TYPED_TEST(SimplexLabels, StayAndGoWithTheirSimplices) {
    constexpr int D = TestFixture::D;
    for (const unsigned threads : {1u, 3u})
        for (const unsigned labels : {2u, 40u}) {
            LabelledMesh<D> mesh(labels, 300 << 10);
            mesh.load(some_triangulation<D>(D == 2 ? 6000 : 1500));
            mesh.mesh.host.set_threads(threads, threads > 1);
            for (const int n : {1, 30, 700}) {
                const auto points = more_points<D>(n, 1, 100000 + n);
                ASSERT_EQ(mesh.mesh.insert(points), ABACUS_OK) << mesh.mesh.error.message;
                mesh.expect_followed();
                std::uint64_t deleted = 0;
                ASSERT_EQ(mesh.mesh.remove(points, deleted), ABACUS_OK);
                EXPECT_EQ(deleted, points.size());
                mesh.expect_followed();
                if (testing::Test::HasFailure()) return;
            }
            EXPECT_GT(mesh.mesh.header.labelled, 100u);
        }
}

/// A new one gets those of the one that its centroid lay in, if the mesh wants that.
TYPED_TEST(SimplexLabels, AreInherited) {
    constexpr int D = TestFixture::D;
    for (const unsigned threads : {1u, 3u})
        for (const unsigned labels : {2u, 40u}) {
            LabelledMesh<D> mesh(labels, 300 << 10);
            mesh.load(some_triangulation<D>(D == 2 ? 1500 : 400));
            mesh.mesh.header.inherits = 1;
            mesh.mesh.host.set_threads(threads, threads > 1);
            for (const int n : {1, 30, 300}) {
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
    mesh.mesh.header.inherits = 1;
    const double width = mesh.mesh.header.upper[0];
    const auto before = mesh.all_labelled();
    ASSERT_EQ(mesh.mesh.insert(more_points<D>(2000, 100, 100000)), ABACUS_OK);
    EXPECT_GT(mesh.mesh.header.upper[0], width);
    mesh.expect_inherited(before);
    EXPECT_GT(mesh.mesh.header.labelled, 500u);
}

TYPED_TEST(SimplexLabels, FollowToAnotherDomain) {
    constexpr int D = TestFixture::D;
    LabelledMesh<D> mesh(3);
    mesh.load(some_triangulation<D>(2000));
    const double before = mesh.mesh.header.upper[0];
    ASSERT_EQ(mesh.mesh.insert(more_points<D>(4000, 100, 100000)), ABACUS_OK);
    EXPECT_GT(mesh.mesh.header.upper[0], before);
    mesh.expect_followed();
    EXPECT_GT(mesh.mesh.header.labelled, 1000u);
}

/// Most points leave, and the rest is triangulated anew; then all leave.
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
    EXPECT_EQ(mesh.mesh.header.simplices, 0u);
    EXPECT_EQ(mesh.mesh.header.labelled, 0u);
    EXPECT_TRUE(mesh.mesh.host.attribute_pages.empty());
}

TYPED_TEST(SimplexLabels, AreGivenLater) {
    constexpr int D = TestFixture::D;
    for (const bool is_delaunay : {true, false}) {
        LabelledMesh<D> mesh(0);
        auto t = some_triangulation<D>(1500);
        if (!is_delaunay) flip(t, 200, 3);
        mesh.load(t);
        mesh.label({0}, 1);
        mesh.expect_all_in_cells();
        mesh.label({0}, 2); // others
        mesh.expect_all_in_cells();
        std::vector<std::uint32_t> many{0};
        for (std::uint32_t i = 1; i < 70; ++i) many.push_back(i);
        mesh.label(many, 3); // more than a page of labels has
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
    ASSERT_EQ(abacus_labelling_open(mesh.mesh.host.table(), &header, 1, &number, 1, 1 << 16,
                                    1 << 20, &labelling, &mesh.mesh.error),
              ABACUS_OK);
    ASSERT_EQ(abacus_labelling_add(labelling, row.data(), 1, &mesh.mesh.error), ABACUS_OK);
    EXPECT_EQ(abacus_labelling_end(labelling, &header, &mesh.mesh.error), ABACUS_ERROR);
    EXPECT_EQ(mesh.mesh.error.kind, ABACUS_ERROR_ARGUMENT);
    abacus_labelling_close(labelling);
    mesh.expect_all_in_cells();
}

/// Nobody has named labels, or no simplex has one.
TYPED_TEST(SimplexLabels, OfWhichThereAreNone) {
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
