// Markers of facets: both sides agree, and a facet keeps its marker as long as it is in the mesh.
#include "attributes/attribute_pages.hpp"
#include "attributes/attribute_reader.hpp"
#include "keys/domain_of.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace abacus::test {
namespace {

template <int D> class MarkedMesh {
public:
    using Facet = std::array<std::int64_t, D>;

    explicit MarkedMesh(std::size_t cache_bytes = 1 << 20) : mesh(0, cache_bytes) {}

    void load(Triangulation<D> t) {
        t.shuffle(5);
        ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    }
    /// Loads it with markers of about every third facet, some of them named from both sides.
    void load_marked(Triangulation<D> t, std::size_t memory) {
        t.shuffle(5);
        std::mt19937_64 random(6);
        std::vector<std::uint64_t> facets;
        for (const Ids<D> &ids : t.simplices)
            for (int i = 0; i <= D; ++i) {
                Facet facet;
                for (int k = 0; k < D; ++k) facet[k] = ids[k + (k >= i)];
                Facet sorted = facet;
                std::sort(sorted.begin(), sorted.end());
                const auto known = known_.find(sorted);
                if (known == known_.end() && random() % 6 != 0) continue;
                const double marker = known == known_.end() ? double(random() % 7) : known->second;
                known_[sorted] = marker;
                facets.insert(facets.end(), facet.begin(), facet.end());
                facets.push_back(std::bit_cast<std::uint64_t>(marker));
            }
        ASSERT_EQ(mesh.load(t.vertices, t.simplices, memory, true, false, {}, facets), ABACUS_OK)
            << mesh.error.message << ' ' << mesh.error.detail;
    }
    /// Marks a facet of about every `every`th simplex, or removes its marker.
    void mark(unsigned every, unsigned seed, bool takes_away = false) {
        std::mt19937_64 random(seed);
        auto simplices = mesh.simplices(false);
        std::shuffle(simplices.begin(), simplices.end(), random);
        std::vector<std::uint64_t> rows;
        std::set<Facet> named;
        std::size_t count = 0;
        for (const abacus_simplex &simplex : simplices) {
            if (random() % every != 0) continue;
            const std::uint64_t corner = random() % (D + 1);
            const Facet facet = facet_of_ids(simplex, static_cast<int>(corner));
            if (!named.insert(facet).second) continue;
            const double marker = takes_away ? std::nan("") : double(random() % 5) - 2;
            rows.push_back(simplex.code);
            rows.insert(rows.end(), simplex.id, simplex.id + D + 1);
            rows.push_back(corner);
            rows.push_back(std::bit_cast<std::uint64_t>(marker));
            ++count;
            if (takes_away)
                known_.erase(facet);
            else
                known_[facet] = marker;
        }
        EXPECT_EQ(run(rows, count), ABACUS_OK) << mesh.error.message;
    }
    abacus_status run(const std::vector<std::uint64_t> &rows, std::size_t count) {
        abacus_marking *marking = nullptr;
        abacus_status status = abacus_marking_open(mesh.host.table(), &mesh.header.facts, 1 << 16,
                                                   1 << 20, &marking, &mesh.error);
        if (status == ABACUS_OK)
            status = abacus_marking_add(marking, rows.data(), count, &mesh.error);
        if (status == ABACUS_OK) status = abacus_marking_end(marking, &mesh.header, &mesh.error);
        abacus_marking_close(marking);
        return status;
    }
    /// All facets with markers, or those with this one.
    std::map<Facet, double> facets(double marker = std::nan("")) {
        std::map<Facet, double> result;
        abacus_facets *facets = nullptr;
        EXPECT_EQ(abacus_facets_open(mesh.host.table(), &mesh.header.facts, marker, 1 << 16,
                                     1 << 20, &facets, &mesh.error),
                  ABACUS_OK);
        abacus_facet facet;
        double last = -std::numeric_limits<double>::infinity();
        abacus_status status;
        while ((status = abacus_facets_next(facets, &facet, &mesh.error)) == ABACUS_OK) {
            Facet ids;
            std::copy_n(facet.id, D, ids.begin());
            std::sort(ids.begin(), ids.end());
            EXPECT_TRUE(result.emplace(ids, facet.marker).second) << "twice";
            EXPECT_LE(last, facet.marker);
            last = facet.marker;
        }
        EXPECT_EQ(status, ABACUS_END) << mesh.error.detail;
        abacus_facets_close(facets);
        return result;
    }
    void expect_known() {
        EXPECT_EQ(facets(), known_);
        std::map<Facet, double> of_one;
        for (const auto &[facet, marker] : known_)
            if (marker == 1) of_one.emplace(facet, marker);
        EXPECT_EQ(facets(1), of_one);
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_TRUE(mesh.host.spools.empty());
    }
    /// After a change: remaining facets have kept their markers.
    void expect_followed() {
        std::set<Facet> there;
        for (const abacus_simplex &simplex : mesh.simplices(false))
            for (int i = 0; i <= D; ++i) there.insert(facet_of_ids(simplex, i));
        const std::size_t before = known_.size();
        std::erase_if(known_, [&](const auto &known) { return !there.contains(known.first); });
        gone_ += before - known_.size();
        expect_known();
    }
    std::size_t gone() const { return gone_; }
    std::size_t count() const { return known_.size(); }

    MeshOf<D> mesh;

private:
    static Facet facet_of_ids(const abacus_simplex &simplex, int corner) {
        Facet facet;
        for (int i = 0; i < D; ++i) facet[i] = simplex.id[i + (i >= corner)];
        std::sort(facet.begin(), facet.end());
        return facet;
    }

    std::map<Facet, double> known_;
    std::size_t gone_ = 0;
};

template <int D> Triangulation<D> uniform(int n) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Point<D>> points(static_cast<std::size_t>(n));
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    return delaunay<D>(points);
}

template <int D> std::vector<InputOf<D>> points_in(int n, double width, std::int64_t first_id) {
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

template <class Dimension> class Markers : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Markers, Dimensions);

TYPED_TEST(Markers, AreGivenAndTakenAway) {
    constexpr int D = TestFixture::D;
    for (const bool is_delaunay : {true, false}) {
        MarkedMesh<D> mesh;
        auto t = uniform<D>(D == 2 ? 1500 : 300);
        if (!is_delaunay)
            t = keeping(t, [](const Point<D> &c) { return std::abs(c[0] - 0.5) > 0.1; });
        mesh.load(t);
        mesh.expect_known(); // none
        mesh.mark(3, 1);
        mesh.expect_known();
        mesh.mark(3, 2); // some of them others
        mesh.expect_known();
        mesh.mark(2, 3, true);
        mesh.expect_known();
        EXPECT_GT(mesh.count(), 100u);
        for (unsigned seed = 10; seed < 60; ++seed) mesh.mark(1, seed, true);
        mesh.expect_known();
        EXPECT_EQ(mesh.count(), 0u);
        EXPECT_EQ(mesh.mesh.header.facts.census.marked, 0u);
        EXPECT_TRUE(mesh.mesh.host.attribute_pages.empty());
        if (testing::Test::HasFailure()) return;
    }
}

TYPED_TEST(Markers, ComeWithALoad) {
    constexpr int D = TestFixture::D;
    for (const bool is_delaunay : {true, false})
        for (const std::size_t memory : {std::size_t{1}, std::size_t{64} << 20}) {
            MarkedMesh<D> mesh;
            auto t = uniform<D>(D == 2 ? 3000 : 600);
            if (!is_delaunay)
                t = keeping(t, [](const Point<D> &c) { return std::abs(c[0] - 0.5) > 0.1; });
            mesh.load_marked(t, memory);
            mesh.expect_known();
            EXPECT_GT(mesh.count(), 300u);
            if (testing::Test::HasFailure()) return;
        }
}

TYPED_TEST(Markers, OfFacetsThatNoSimplexHasAreFaults) {
    constexpr int D = TestFixture::D;
    const auto t = uniform<D>(100);
    const auto load = [&](std::vector<std::int64_t> facet, double marker, int times = 1) {
        MeshOf<D> mesh(0, 1 << 20);
        std::vector<std::uint64_t> facets;
        for (; times > 0; --times, marker += 1) {
            facets.insert(facets.end(), facet.begin(), facet.end());
            facets.push_back(std::bit_cast<std::uint64_t>(marker));
        }
        const auto status = mesh.load(t.vertices, t.simplices, 16 << 20, true, false, {}, facets);
        return status == ABACUS_ERROR && mesh.error.kind == ABACUS_ERROR_ARGUMENT;
    };
    const Ids<D> &simplex = t.simplices.front();
    std::vector<std::int64_t> facet(simplex.begin(), simplex.begin() + D);
    EXPECT_FALSE(load(facet, 1));
    EXPECT_TRUE(load(facet, 1, 2));
    EXPECT_TRUE(load(facet, 0.5));
    facet[0] = 99999;
    EXPECT_TRUE(load(facet, 1));
    facet[0] = facet[1];
    EXPECT_TRUE(load(facet, 1));
}

TYPED_TEST(Markers, StayAsLongAsTheirFacets) {
    constexpr int D = TestFixture::D;
    for (const unsigned threads : {1u, 3u}) {
        MarkedMesh<D> mesh(300 << 10);
        mesh.load(uniform<D>(D == 2 ? 3000 : 800));
        mesh.mark(2, 1);
        mesh.mesh.host.set_threads(threads, threads > 1);
        for (const int n : {1, 30, 700}) {
            const auto points = points_in<D>(n, 1, 100000 + n);
            ASSERT_EQ(mesh.mesh.insert(points), ABACUS_OK) << mesh.mesh.error.message;
            mesh.expect_followed();
            std::uint64_t deleted = 0;
            ASSERT_EQ(mesh.mesh.remove(points, deleted), ABACUS_OK);
            mesh.expect_followed();
            if (testing::Test::HasFailure()) return;
        }
        EXPECT_GT(mesh.gone(), 50u);
        EXPECT_GT(mesh.count(), 200u);
    }
}

TYPED_TEST(Markers, FollowToAnotherDomain) {
    constexpr int D = TestFixture::D;
    MarkedMesh<D> mesh;
    mesh.load(uniform<D>(2000));
    mesh.mark(2, 1);
    const double before = mesh.mesh.header.facts.form.upper[0];
    ASSERT_EQ(mesh.mesh.insert(points_in<D>(4000, 100, 100000)), ABACUS_OK);
    EXPECT_GT(mesh.mesh.header.facts.form.upper[0], before);
    mesh.expect_followed();
    EXPECT_GT(mesh.count(), 500u);
}

TYPED_TEST(Markers, OfAMeshThatIsTakenAway) {
    constexpr int D = TestFixture::D;
    MarkedMesh<D> mesh;
    const auto t = uniform<D>(2000);
    mesh.load(t);
    mesh.mark(1, 1);
    std::uint64_t deleted = 0;
    ASSERT_EQ(mesh.mesh.remove({t.vertices.begin(), t.vertices.end() - 100}, deleted), ABACUS_OK);
    mesh.expect_followed();
    ASSERT_EQ(mesh.mesh.remove({t.vertices.end() - 100, t.vertices.end()}, deleted), ABACUS_OK);
    EXPECT_EQ(mesh.mesh.header.facts.census.marked, 0u);
    EXPECT_TRUE(mesh.mesh.host.attribute_pages.empty());
}

TYPED_TEST(Markers, OfWhatIsNoFacetAreRefused) {
    constexpr int D = TestFixture::D;
    MarkedMesh<D> mesh;
    mesh.load(uniform<D>(300));
    const abacus_simplex simplex = mesh.mesh.simplices(false).front();
    const auto refused = [&](std::int64_t last_id, std::uint64_t corner, double marker) {
        std::vector<std::uint64_t> row{simplex.code};
        row.insert(row.end(), simplex.id, simplex.id + D);
        row.push_back(static_cast<std::uint64_t>(last_id));
        row.push_back(corner);
        row.push_back(std::bit_cast<std::uint64_t>(marker));
        const abacus_header before = mesh.mesh.header;
        const bool is_error =
            mesh.run(row, 1) == ABACUS_ERROR && mesh.mesh.error.kind == ABACUS_ERROR_ARGUMENT;
        mesh.mesh.header = before;
        return is_error;
    };
    EXPECT_TRUE(refused(777777, 0, 1));
    EXPECT_TRUE(refused(simplex.id[D], D + 1, 1));
    EXPECT_TRUE(refused(simplex.id[D], ~std::uint64_t{0}, 1));
    EXPECT_TRUE(refused(simplex.id[D], 0, 1.5));
    EXPECT_TRUE(refused(simplex.id[D], 0, 1e10));
    mesh.expect_known();
    EXPECT_FALSE(refused(simplex.id[D], 0, 1));
}

TYPED_TEST(Markers, ThatDifferOnTwoSidesAreAFault) {
    constexpr int D = TestFixture::D;
    MarkedMesh<D> mesh;
    mesh.load(uniform<D>(1500));
    mesh.mark(1, 1);
    auto &pages = mesh.mesh.host.attribute_pages;
    ASSERT_GT(pages.size(), 2u);
    const auto sound = pages;
    const Host host = mesh.mesh.host.host();
    const auto domain = domain_of<D>(mesh.mesh.header.facts.form);
    AttributePages<D, D + 1> markers(host, domain, D + 1, marker_group);
    // Changes one side of a facet.
    AttributeScan<D, D + 1> scan(host, domain, D + 1, marker_group);
    ASSERT_TRUE(scan.fetch());
    scan.read();
    const auto simplex = scan.page().owner(0);
    std::array<double, D + 1> changed;
    for (unsigned i = 0; i <= D; ++i) changed[i] = scan.page().value(0, i) + 10;
    markers.put(simplex, code_of<D, D + 1>(domain, simplex), changed.data());
    markers.flush();
    EXPECT_EQ(mesh.mesh.check().front(),
              "markers: The two sides of a facet have different markers.");
    pages = sound;
    pages.erase(std::next(pages.begin()));
    EXPECT_FALSE(mesh.mesh.check().empty());
    pages = sound;
    EXPECT_EQ(mesh.mesh.check(), std::vector<std::string>{});
}

} // namespace
} // namespace abacus::test
