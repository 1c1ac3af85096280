// Several shards, each with a mesh of its own, exchange vertices until none is missing: their
// simplices are those of one mesh of all points.
#include "attributes/attribute_key.hpp"
#include "geometry/conflict.hpp"
#include "shards/regions.hpp"
#include "support/oracle.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace abacus::test {
namespace {

/// All that SQL shows of a simplex.
template <int D> struct Row {
    std::uint64_t code;
    std::array<std::int64_t, D + 1> ids;
    std::array<Point<D>, D + 1> corners;
    auto operator<=>(const Row &) const = default;
};

template <int D> std::vector<Row<D>> rows(MeshOf<D> &mesh) {
    std::vector<Row<D>> rows;
    for (const abacus_simplex &s : mesh.simplices(false)) {
        Row<D> row;
        row.code = s.code;
        for (int i = 0; i <= D; ++i) {
            row.ids[i] = s.id[i];
            std::copy_n(s.corner[i], D, row.corners[i].begin());
        }
        rows.push_back(row);
    }
    return rows;
}

template <class Dimension> class Shards : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    using Inputs = std::vector<InputOf<D>>;

    struct Shard {
        std::unique_ptr<MeshOf<D>> mesh;
        std::set<Point<D>> guests;
        Inputs arriving;
    };
    /// What all shards together have become.
    struct Outcome {
        std::vector<Row<D>> rows;
        std::map<std::int64_t, std::pair<Point<D>, std::vector<double>>> vertices; // of the rows
        std::size_t sent = 0;
        int rounds = 0;
    };

    Inputs number(const std::vector<Point<D>> &points) const {
        Inputs inputs;
        for (const Point<D> &p : points) {
            const auto id = static_cast<std::int64_t>(inputs.size());
            std::vector<double> values;
            for (int i = 0; i < attributes; ++i)
                values.push_back(static_cast<double>(id) / (3 + i));
            inputs.push_back({id, p, values});
        }
        return inputs;
    }

    /// A survey of each part of the points, and the plan that follows from them.
    void plan(const Inputs &inputs, std::uint32_t shards) {
        MeshOf<D> host(attributes);
        abacus_survey *all = nullptr;
        ASSERT_EQ(abacus_survey_open(host.host.table(), &host.header.facts, &all, &host.error),
                  ABACUS_OK);
        for (std::uint32_t part = 0; part < shards; ++part) {
            abacus_survey *survey = nullptr;
            ASSERT_EQ(
                abacus_survey_open(host.host.table(), &host.header.facts, &survey, &host.error),
                ABACUS_OK);
            for (std::size_t i = part; i < inputs.size(); i += shards) {
                std::vector<std::uint64_t> record{static_cast<std::uint64_t>(inputs[i].id)};
                for (const double x : inputs[i].point)
                    record.push_back(std::bit_cast<std::uint64_t>(x));
                record.resize(record.size() + static_cast<std::size_t>(attributes));
                ASSERT_EQ(abacus_survey_add(survey, record.data(), 1, &host.error), ABACUS_OK);
            }
            std::uint64_t points;
            const double *sample;
            std::size_t count;
            abacus_box box;
            ASSERT_EQ(abacus_survey_result(survey, &points, &box, &sample, &count, &host.error),
                      ABACUS_OK);
            ASSERT_EQ(abacus_survey_merge(all, points, &box, sample, count, &host.error),
                      ABACUS_OK);
            abacus_survey_close(survey);
        }
        std::uint64_t points;
        const double *sample;
        std::size_t count;
        ASSERT_EQ(abacus_survey_result(all, &points, &extent, &sample, &count, &host.error),
                  ABACUS_OK);
        EXPECT_EQ(points, inputs.size());
        borders.assign(shards - 1, 0);
        form = host.header.facts.form;
        ASSERT_EQ(abacus_survey_plan(all, shards, &form, borders.data(), &host.error), ABACUS_OK);
        abacus_survey_close(all);
        EXPECT_EQ(host.host.bytes, 0u);
        EXPECT_TRUE(std::is_sorted(borders.begin(), borders.end()));
    }
    std::uint64_t code(const Point<D> &p) const {
        std::uint64_t code = 0;
        abacus_error error;
        EXPECT_EQ(abacus_codes(&form, p.data(), 1, &code, &error), ABACUS_OK);
        return code;
    }
    std::uint32_t owner(std::uint64_t code) const {
        return static_cast<std::uint32_t>(std::upper_bound(borders.begin(), borders.end(), code) -
                                          borders.begin());
    }

    void take(Shard &shard) {
        if (shard.arriving.empty()) return;
        ASSERT_EQ(shard.mesh->stage(shard.arriving), ABACUS_OK) << shard.mesh->error.message;
        ASSERT_EQ(shard.mesh->build(), ABACUS_OK) << shard.mesh->error.message;
        shard.arriving.clear();
    }
    /// One shard's part of a round; returns how many vertices have not been sent there before.
    std::size_t send(std::uint32_t from, std::vector<Shard> &shards) {
        MeshOf<D> &mesh = *shards[from].mesh;
        abacus_exports *exports = nullptr;
        EXPECT_EQ(abacus_exports_open(mesh.host.table(), &mesh.header.facts, borders.data(),
                                      borders.size(), from, &extent, &exports, &mesh.error),
                  ABACUS_OK);
        std::size_t sent = 0;
        std::uint32_t to;
        abacus_vertex vertex;
        abacus_status status;
        while ((status = abacus_exports_next(exports, &to, &vertex, &mesh.error)) == ABACUS_OK) {
            Point<D> p;
            std::copy_n(vertex.point, D, p.begin());
            EXPECT_NE(to, from);
            EXPECT_NE(owner(code(p)), to);
            if (!shards[to].guests.insert(p).second) continue;
            shards[to].arriving.push_back(
                {vertex.id, p, {vertex.attributes, vertex.attributes + attributes}});
            ++sent;
        }
        EXPECT_EQ(status, ABACUS_END) << mesh.error.message << " " << mesh.error.detail;
        abacus_exports_close(exports);
        return sent;
    }
    /// How many simplices a shard counts as its own.
    std::uint64_t owned(std::uint32_t shard, MeshOf<D> &mesh) {
        abacus_exports *exports = nullptr;
        std::uint64_t count = 0;
        EXPECT_EQ(abacus_exports_open(mesh.host.table(), &mesh.header.facts, borders.data(),
                                      borders.size(), shard, &extent, &exports, &mesh.error),
                  ABACUS_OK);
        EXPECT_EQ(abacus_exports_count(exports, &count, &mesh.error), ABACUS_OK);
        abacus_exports_close(exports);
        return count;
    }
    Outcome build(const Inputs &inputs, std::uint32_t count) {
        Outcome outcome;
        plan(inputs, count);
        std::vector<Shard> shards(count);
        for (Shard &shard : shards) {
            shard.mesh = std::make_unique<MeshOf<D>>(attributes);
            shard.mesh->header.facts.form = form;
        }
        for (const InputOf<D> &input : inputs)
            shards[owner(code(input.point))].arriving.push_back(input);
        for (bool sends = true; sends; ++outcome.rounds) {
            for (Shard &shard : shards) take(shard);
            sends = false;
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::size_t sent = send(i, shards);
                outcome.sent += sent;
                sends |= sent > 0;
            }
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            EXPECT_EQ(shards[i].mesh->check(), std::vector<std::string>{});
            const std::size_t before = outcome.rows.size();
            for (const Row<D> &row : rows(*shards[i].mesh))
                if (owner(row.code) == i) outcome.rows.push_back(row);
            EXPECT_EQ(owned(i, *shards[i].mesh), outcome.rows.size() - before);
            EXPECT_EQ(shards[i].mesh->host.bytes, 0u);
        }
        std::sort(outcome.rows.begin(), outcome.rows.end());
        if (shards[0].mesh->header.facts.census.simplices > 0 || !outcome.rows.empty())
            expect_pages(shards, outcome.rows);
        return outcome;
    }

    std::uint64_t first(std::uint32_t shard) const { return shard == 0 ? 0 : borders[shard - 1]; }
    /// As PostgreSQL's greatest bigint of the last one.
    std::uint64_t last(std::uint32_t shard) const {
        return shard < borders.size() ? borders[shard] - 1 : key_word_end - 1;
    }
    /// Calls put() with each page of a kind that the shard has of the mesh of all, from a key on.
    template <class Put>
    void each_own_page(Shard &shard, std::uint32_t number, abacus_page_kind kind, const Key &from,
                       Put put) {
        MeshOf<D> &mesh = *shard.mesh;
        if (last(number) + 1 == first(number)) return;
        abacus_own_pages *pages = nullptr;
        ASSERT_EQ(abacus_own_pages_open(mesh.host.table(), &mesh.header.facts, kind, first(number),
                                        last(number), &from, &pages, &mesh.error),
                  ABACUS_OK)
            << mesh.error.message;
        abacus_page page{};
        abacus_status status;
        while ((status = abacus_own_pages_next(pages, &page, &mesh.error)) == ABACUS_OK) put(page);
        EXPECT_EQ(status, ABACUS_END) << mesh.error.message << " " << mesh.error.detail;
        abacus_own_pages_close(pages);
    }
    /// What shards have of the mesh of all is a sound mesh, with the same simplices.
    void expect_pages(std::vector<Shard> &shards, const std::vector<Row<D>> &expected) {
        MeshOf<D> all(attributes);
        all.header.facts.form = form;
        abacus_census &census = all.header.facts.census;
        const auto keep = [&](abacus_page_kind kind) {
            return [&all, kind](abacus_page page) {
                page.location = 0;
                EXPECT_EQ(all.host.table()->put(all.host.table()->context, kind, &page),
                          ABACUS_HOST_OK);
            };
        };
        for (std::uint32_t i = 0; i < shards.size(); ++i) {
            MeshOf<D> &mesh = *shards[i].mesh;
            std::uint64_t simplices, ghosts;
            if (last(i) + 1 != first(i)) {
                ASSERT_EQ(abacus_own_count(mesh.host.table(), &mesh.header.facts, first(i), last(i),
                                           &simplices, &ghosts, &mesh.error),
                          ABACUS_OK)
                    << mesh.error.message << mesh.error.detail;
                census.simplices += simplices;
                census.ghosts += ghosts;
            }
            if (mesh.header.facts.census.simplices > 0)
                census.vertices += mesh.header.facts.census.vertices - shards[i].guests.size();
            each_own_page(shards[i], i, ABACUS_SIMPLEX_PAGES, {first(i), 0},
                          keep(ABACUS_SIMPLEX_PAGES));
            const unsigned groups =
                mesh.header.facts.columns.apart == 0 ? 0 : (attributes + 31) / 32;
            for (unsigned group = 0; group < groups; ++group)
                each_own_page(shards[i], i, ABACUS_ATTRIBUTE_PAGES, group_begin(group),
                              keep(ABACUS_ATTRIBUTE_PAGES));
        }
        EXPECT_EQ(all.check(), std::vector<std::string>{});
        std::vector<Row<D>> found = rows(all);
        std::sort(found.begin(), found.end());
        EXPECT_TRUE(found == expected) << found.size() << " simplices, not " << expected.size();
        for (const auto &[key, stored] : all.host.pages) { // each page is found by its key alone
            const std::uint32_t i = owner(key.code);
            int n = 0;
            each_own_page(shards[i], i, ABACUS_SIMPLEX_PAGES, key, [&](const abacus_page &page) {
                if (n++ > 0) return;
                EXPECT_TRUE(page.key <= key);
                EXPECT_TRUE(!(page.key == key) || page.size == stored.size);
            });
            EXPECT_GT(n, 0);
            if (all.host.pages.size() > 20) break;
        }
    }
    void expect_same(const std::vector<Point<D>> &points) {
        const Inputs inputs = number(points);
        MeshOf<D> alone(attributes);
        ASSERT_EQ(alone.insert(inputs), ABACUS_OK);
        std::vector<Row<D>> expected = rows(alone);
        std::sort(expected.begin(), expected.end());
        for (const std::uint32_t shards : {1u, 2u, 4u, 7u}) {
            const Outcome outcome = build(inputs, shards);
            EXPECT_TRUE(outcome.rows == expected) << shards << " shards: " << outcome.rows.size()
                                                  << " simplices, not " << expected.size();
            if (form.has_domain == 0) continue;
            EXPECT_TRUE(std::equal(form.lower, form.lower + D, alone.header.facts.form.lower));
            EXPECT_TRUE(std::equal(form.upper, form.upper + D, alone.header.facts.form.upper));
        }
    }

    int attributes = 1;
    abacus_form form{};
    abacus_box extent{};
    std::vector<std::uint64_t> borders;
    Random random{5};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Shards, Dimensions);

TYPED_TEST(Shards, MakeTheMeshOfOneServer) {
    constexpr int D = TypeParam::value;
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(this->random);
        constexpr std::size_t most = D == 2 ? 6000 : 2500;
        if (points.size() > most) { // of any order
            std::shuffle(points.begin(), points.end(), this->random);
            points.resize(most);
        }
        this->expect_same(points);
    }
}

TYPED_TEST(Shards, MakeItOfFewPointsAndOfPointsOnALine) {
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> few;
    for (int n = 0; n <= D + 3; ++n) {
        SCOPED_TRACE(n);
        this->expect_same(few);
        few.push_back({});
        for (double &x : few.back()) x = unit(this->random);
    }
    std::vector<Point<D>> line;
    for (int i = 0; i < 200; ++i) {
        line.push_back({});
        for (double &x : line.back()) x = (i * 37 % 150) * 0.5; // some are equal
    }
    this->expect_same(line);
    line.push_back({});
    line.back()[0] = 1; // beside the line
    this->expect_same(line);
    std::vector<Point<D>> plane; // in space; in the plane a line along an axis
    for (int i = 0; i < 400; ++i) {
        plane.push_back({});
        for (int axis = 0; axis + 1 < D; ++axis)
            plane.back()[axis] = std::floor(unit(this->random) * 20);
    }
    this->expect_same(plane);
    plane.push_back({});
    plane.back()[D - 1] = 1e6;
    this->expect_same(plane);
}

TYPED_TEST(Shards, MakeItOfPointsInOneShardAndOfOutliers) {
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> points;
    for (int i = 0; i < 1500; ++i) {
        points.push_back({});
        for (double &x : points.back()) x = 1 + 1e-7 * unit(this->random);
    }
    points.push_back({}); // all others are in one corner of the domain
    this->expect_same(points);
    points.back()[0] = 1e300; // a domain that leaves it out
    points.push_back({});
    points.back()[D - 1] = -1e300;
    this->expect_same(points);
}

TYPED_TEST(Shards, HaveAttributesApart) {
    constexpr int D = TypeParam::value;
    this->attributes = 40; // two groups
    std::vector<Point<D>> points(D == 2 ? 3000 : 1200);
    for (auto &p : points)
        for (double &x : p) x = unit(this->random);
    this->expect_same(points);
}

TYPED_TEST(Shards, SayAroundAllVerticesWhatTheySayAtOnce) {
    constexpr int D = TypeParam::value;
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(this->random);
        std::shuffle(points.begin(), points.end(), this->random);
        points.resize(std::min<std::size_t>(points.size(), 700));
        const auto inputs = this->number(points);
        this->plan(inputs, 4);
        MeshOf<D> mesh(1); // of some of the points: so it calls for others
        mesh.header.facts.form = this->form;
        ASSERT_EQ(mesh.insert(inputs), ABACUS_OK) << mesh.error.message;
        if (mesh.header.facts.census.simplices == 0) continue;
        using Sent = std::set<std::pair<std::uint32_t, Point<D>>>;
        Sent all, around;
        abacus_exports *exports = nullptr;
        ASSERT_EQ(abacus_exports_open(mesh.host.table(), &mesh.header.facts, this->borders.data(),
                                      this->borders.size(), 1, &this->extent, &exports,
                                      &mesh.error),
                  ABACUS_OK);
        std::uint32_t to;
        abacus_vertex vertex;
        while (abacus_exports_next(exports, &to, &vertex, &mesh.error) == ABACUS_OK) {
            Point<D> p;
            std::copy_n(vertex.point, D, p.begin());
            all.emplace(to, p);
        }
        const auto report = [](void *sent, std::uint32_t shard, const abacus_vertex *found) {
            Point<D> p;
            std::copy_n(found->point, D, p.begin());
            static_cast<Sent *>(sent)->emplace(shard, p);
            return ABACUS_HOST_OK;
        };
        for (const Point<D> &p : points)
            ASSERT_EQ(abacus_exports_around(exports, p.data(), report, &around, &mesh.error),
                      ABACUS_OK)
                << mesh.error.message;
        EXPECT_TRUE(all == around) << all.size() << " at once, " << around.size() << " around";
        Point<D> beside = points[0]; // no vertex is there
        beside[0] = std::nextafter(beside[0], 1e9);
        if (std::find(points.begin(), points.end(), beside) == points.end()) {
            const std::size_t before = around.size();
            ASSERT_EQ(abacus_exports_around(exports, beside.data(), report, &around, &mesh.error),
                      ABACUS_OK);
            EXPECT_EQ(around.size(), before);
        }
        abacus_exports_close(exports);
        EXPECT_EQ(mesh.host.bytes, 0u);
    }
}

TYPED_TEST(Shards, SendFewPoints) {
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> points(D == 2 ? 60000 : 30000);
    for (auto &p : points)
        for (double &x : p) x = unit(this->random);
    const auto outcome = this->build(this->number(points), 4);
    EXPECT_LE(outcome.rounds, 8);
    EXPECT_LT(outcome.sent, points.size() / (D == 2 ? 25 : 2));
    this->RecordProperty("sent", static_cast<int>(outcome.sent));
    this->RecordProperty("rounds", outcome.rounds);
}

TYPED_TEST(Shards, ReportEveryRegionWithAPointInConflict) {
    constexpr int D = TypeParam::value;
    MemoryHost memory;
    const Host host = memory.host();
    const auto coordinate = [&] { // some are equal; some lie outside the domain
        return this->random() % 3 == 0 ? std::floor(unit(this->random) * 8) - 2
                                       : unit(this->random) * 6 - 1;
    };
    const auto draw = [&] {
        Point<D> p;
        for (double &x : p) x = coordinate();
        return p;
    };
    Point<D> lower, upper;
    lower.fill(0);
    upper.fill(4);
    const Domain<D> domain(lower, upper);
    lower.fill(-2);
    upper.fill(6);
    std::uint64_t conflicts = 0, quiet = 0;
    for (int i = 0; i < 60; ++i) {
        std::vector<std::uint64_t> borders(1 + i % 5);
        for (std::uint64_t &border : borders) {
            border = this->random() % (std::uint64_t{1} << (D * code_bits<D>));
            if (i % 2 == 0) border = border >> (D * 15) << (D * 15); // coarse cells
        }
        std::sort(borders.begin(), borders.end());
        const ShardRegions<D> regions(host, domain, borders, {lower, upper});
        for (int n = 0; n < 60; ++n) {
            std::array<Point<D>, D + 1> points;
            Corners<D> corners;
            const bool is_small = n % 2 == 0;
            const Point<D> centre = draw();
            for (int c = 0; c <= D; ++c) {
                points[c] = draw();
                for (int k = 0; is_small && k < D; ++k)
                    points[c][k] = std::clamp(centre[k] + points[c][k] / 64, -2.0, 6.0);
                corners[c] = &points[c];
            }
            if (orientation<D>(corners) == 0) continue;
            if (orientation<D>(corners) < 0) std::swap(corners[0], corners[1]);
            for (const bool is_ghost : {false, true}) {
                std::set<std::uint32_t> met;
                regions.each_met(corners, is_ghost,
                                 [&](std::uint32_t shard) { met.insert(shard); });
                quiet += met.size() < regions.shards();
                for (int q = 0; q < 40; ++q) {
                    const Point<D> p = draw();
                    const Side side =
                        is_ghost ? side_of_ghost<D>(corners, p) : side_of_simplex<D>(corners, p);
                    if (side == Side::outside) continue;
                    ++conflicts;
                    ASSERT_TRUE(met.contains(regions.owner(p)));
                }
            }
        }
    }
    EXPECT_GT(conflicts, 1000u);
    EXPECT_GT(quiet, 1000u); // so not all regions are reported always
}

TYPED_TEST(Shards, EncloseSpheresInDoublesOrSayThatTheyCannot) {
    constexpr int D = TypeParam::value;
    int certain = 0, tests = 0;
    for (int n = 0; n < 4000; ++n) {
        const double size = std::ldexp(1.0, static_cast<int>(this->random() % 120) - 60);
        const double flat = std::ldexp(1.0, -static_cast<int>(this->random() % 50));
        std::array<Point<D>, D + 1> points;
        Corners<D> corners;
        for (int c = 0; c <= D; ++c) {
            for (int k = 0; k < D; ++k)
                points[c][k] = 3 + size * (unit(this->random) - 0.5) * (k == 0 ? flat : 1);
            corners[c] = &points[c];
        }
        if (orientation<D>(corners) == 0) continue;
        if (orientation<D>(corners) < 0) std::swap(corners[0], corners[1]);
        Box<D> quick;
        if (!quick_sphere_box<D>(corners, quick)) continue;
        ++certain;
        const Box<D> sure = sphere_box<D>(corners);
        // The sphere touches each side of its box at the middle of the others.
        for (int k = 0; k < D; ++k)
            for (const double part : {0.0, 1e-14, 1e-12, 1e-10}) {
                Point<D> p;
                for (int j = 0; j < D; ++j) p[j] = sure.lower[j] / 2 + sure.upper[j] / 2;
                for (const bool is_upper : {false, true}) {
                    const double width = sure.upper[k] - sure.lower[k];
                    p[k] = is_upper ? sure.upper[k] - part * width : sure.lower[k] + part * width;
                    if (in_sphere(corners, p) <= 0) continue;
                    ++tests;
                    ASSERT_TRUE(quick.contains(p));
                }
            }
        for (int k = 0; k < D; ++k) // not much too large either
            EXPECT_LT(quick.upper[k] - quick.lower[k],
                      (sure.upper[k] - sure.lower[k]) * 1.1 + 1e-10);
    }
    EXPECT_GT(certain, 1000);
    EXPECT_GT(tests, 1000);
}

TYPED_TEST(Shards, CutTheCurveIntoEvenShares) {
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> points(40000);
    for (auto &p : points)
        for (double &x : p) x = std::pow(unit(this->random), 3);
    this->plan(this->number(points), 4);
    std::vector<std::size_t> count(4);
    for (const auto &p : points) ++count[this->owner(this->code(p))];
    for (const std::size_t n : count) {
        EXPECT_GT(n, points.size() / 4 * 9 / 10);
        EXPECT_LT(n, points.size() / 4 * 11 / 10);
    }
}

} // namespace
} // namespace abacus::test
