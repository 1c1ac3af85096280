// Failures at any moment: a clean status, all memory freed, no further call of the host, and the
// caller's header unchanged.
#include "support/located_places.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>

namespace abacus::test {
namespace {

constexpr std::size_t little = 40 << 10, ample = 64 << 20;

std::vector<Input> random_points(int n, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Input> inputs;
    for (int i = 0; i < n; ++i) inputs.push_back({i, {unit(random), unit(random)}, {unit(random)}});
    return inputs;
}

/// A piece of work on a mesh, from opening to closing handles.
struct Work {
    const char *name;
    int staged, built; // points that the mesh starts with; how many of them it contains
    std::function<abacus_status(Mesh &)> run;
};

abacus_status draw(Mesh &mesh) {
    abacus_drawing drawing{};
    drawing.width = 40;
    drawing.edges = 1;
    drawing.exaggeration = 1;
    abacus_picture picture{};
    const abacus_status status =
        abacus_draw(mesh.host.table(), &mesh.header.facts, &drawing, &picture, &mesh.error);
    if (status == ABACUS_OK) mesh.host.host().release(picture.png);
    return status;
}

abacus_status scan(Mesh &mesh) {
    abacus_scan *scan = nullptr;
    abacus_status status =
        abacus_scan_open(mesh.host.table(), &mesh.header.facts, 1, &scan, &mesh.error);
    if (status != ABACUS_OK) return status;
    abacus_simplex s;
    while ((status = abacus_scan_next(scan, &s, &mesh.error)) == ABACUS_OK) {
    }
    abacus_scan_close(scan);
    return status;
}

abacus_status vertex_scan(Mesh &mesh) {
    abacus_vertex_scan *scan = nullptr;
    abacus_status status = abacus_vertex_scan_open(mesh.host.table(), &mesh.header.facts,
                                                   mesh.cache_bytes, &scan, &mesh.error);
    if (status != ABACUS_OK) return status;
    abacus_vertex v;
    while ((status = abacus_vertex_scan_next(scan, &v, &mesh.error)) == ABACUS_OK) {
    }
    abacus_vertex_scan_close(scan);
    return status;
}

abacus_status check(Mesh &mesh) {
    abacus_check *check = nullptr;
    const abacus_status status = abacus_check_open(mesh.host.table(), &mesh.header.facts,
                                                   mesh.cache_bytes, 10, &check, &mesh.error);
    if (status != ABACUS_OK) return status;
    abacus_fault fault;
    EXPECT_EQ(abacus_check_next(check, &fault), ABACUS_END) << fault.message;
    abacus_check_close(check);
    return status;
}

/// Locates and walks along a line through the whole mesh.
abacus_status read(Mesh &mesh) {
    abacus_mesh *handle = nullptr;
    abacus_status status = abacus_mesh_open(mesh.host.table(), &mesh.header.facts, mesh.cache_bytes,
                                            &handle, &mesh.error);
    if (status != ABACUS_OK) return status;
    for (int i = 0; i < 40; ++i) {
        const double p[] = {0.1 + i * 0.02, 0.9 - i * 0.02};
        abacus_simplex s, next;
        status = abacus_mesh_locate(handle, p, &s, &mesh.error);
        if (status == ABACUS_OK)
            status = abacus_mesh_walk(handle, s.code, s.id, i % 3, &next, &mesh.error);
        if (status != ABACUS_OK && status != ABACUS_END) break;
    }
    abacus_mesh_close(handle);
    return status;
}

/// Many places at once, sorted in spools.
abacus_status locate_many(Mesh &mesh) {
    const auto places = random_points(12000, 5);
    std::vector<LocatedPlace> located;
    return locate_places<2>(mesh, places, located, 1);
}

/// A triangulation with a hole, so not Delaunay, or one without.
abacus_status load(Mesh &mesh, bool hole, std::size_t memory) {
    auto t = delaunay<2>(unit_square_points(900, 3));
    if (hole) t = keeping<2>(t, [](const auto &c) { return std::abs(c[0] - 0.5) + c[1] > 0.3; });
    for (auto &v : t.vertices) v.attributes = {v.point[0]};
    return mesh.load(t.vertices, t.simplices, memory);
}

/// Like read(), on a mesh where walks end in a hole.
abacus_status load_and_read(Mesh &mesh) {
    const abacus_header empty = mesh.header;
    abacus_status status = load(mesh, true, ample);
    if (status == ABACUS_OK) status = read(mesh);
    if (status == ABACUS_HOST_ERROR || status == ABACUS_ERROR) mesh.header = empty;
    return status;
}

/// Inserts around the mesh, which gets another domain.
abacus_status insert_outside(Mesh &mesh) {
    auto points = random_points(700, 9);
    for (Input &p : points)
        for (double &x : p.point) x = 20 * x - 10;
    return mesh.insert(points);
}

void PrintTo(const Work &work, std::ostream *out) { *out << work.name; }

const Work works[] = {
    {"stage", 0, 0, [](Mesh &mesh) { return mesh.stage(random_points(400, 1)); }},
    {"stage_through_spools", 0, 0,
     [](Mesh &mesh) { return mesh.stage(random_points(9000, 1), 1); }},
    {"insert", 0, 0, [](Mesh &mesh) { return mesh.insert(random_points(1500, 1)); }},
    {"insert_more", 700, 400, [](Mesh &mesh) { return mesh.insert(random_points(700, 7)); }},
    {"insert_outside", 700, 400, insert_outside},
    {"stage_more", 500, 500, [](Mesh &mesh) { return mesh.stage(random_points(300, 2)); }},
    {"load", 0, 0, [](Mesh &mesh) { return load(mesh, false, ample); }},
    {"load_with_a_hole", 0, 0, [](Mesh &mesh) { return load(mesh, true, ample); }},
    {"load_through_spools", 0, 0, [](Mesh &mesh) { return load(mesh, true, 1); }},
    {"load_and_read", 0, 0, load_and_read},
    {"build", 1500, 0, [](Mesh &mesh) { return mesh.build(); }},
    {"build_more", 1500, 900, [](Mesh &mesh) { return mesh.build(); }},
    {"read", 1500, 1500, read},
    {"locate_through_spools", 1500, 1500, locate_many},
    {"scan", 1500, 1500, scan},
    {"vertex_scan", 1500, 900, vertex_scan},
    {"check", 1500, 900, check},
    {"draw", 1500, 1500, draw},
};

class Failure : public testing::TestWithParam<Work> {
protected:
    void SetUp() override {
        const std::vector<Input> points = random_points(GetParam().staged, 7);
        if (GetParam().staged == 0) return;
        const auto middle = points.begin() + GetParam().built;
        if (GetParam().built > 0) {
            ASSERT_EQ(sound_.stage({points.begin(), middle}), ABACUS_OK);
            ASSERT_EQ(sound_.build(), ABACUS_OK);
        }
        if (middle == points.end()) return;
        ASSERT_EQ(sound_.stage({middle, points.end()}), ABACUS_OK);
    }

    /// Runs the work on a copy of the mesh, after `spoil`.
    abacus_status run(const std::function<void(MemoryHost &)> &spoil) {
        Mesh mesh(1, little);
        mesh.host.restore(sound_.host);
        mesh.header = sound_.header;
        spoil(mesh.host);
        std::memset(&mesh.error, 0, sizeof mesh.error);
        const abacus_status status = GetParam().run(mesh);
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
        if (status != ABACUS_OK && status != ABACUS_END) {
            EXPECT_EQ(std::memcmp(&mesh.header, &sound_.header, sizeof mesh.header), 0);
        }
        kind_ = mesh.error.kind;
        calls_ = mesh.host.calls;
        return status;
    }

    Mesh sound_{1, std::size_t(64) << 20};
    abacus_error_kind kind_{};
    MemoryHost::Calls calls_;
};

bool succeeded(abacus_status status) { return status == ABACUS_OK || status == ABACUS_END; }

/// Every n up to 60, then fewer and fewer: most of the calls are alike.
std::uint64_t after(std::uint64_t n) { return n < 60 ? n + 1 : n + n / 16; }

TEST_P(Failure, OfAnyHostFunction) {
    std::uint64_t n = 1;
    for (;; n = after(n)) {
        const abacus_status status = run([&](MemoryHost &host) { host.fail_at(n); });
        if (succeeded(status)) break;
        ASSERT_EQ(status, ABACUS_HOST_ERROR) << "call " << n;
    }
    EXPECT_GT(n, 3u);
    const bool has_spools = std::string(GetParam().name).ends_with("spools");
    EXPECT_TRUE(!has_spools || calls_.spool_create > 0);
}

TEST_P(Failure, OfAnyAllocation) {
    std::uint64_t n = 1;
    for (;; n = after(n)) {
        const abacus_status status = run([&](MemoryHost &host) { host.fail_resize_at(n); });
        if (succeeded(status)) break;
        ASSERT_EQ(status, ABACUS_ERROR) << "allocation " << n;
        ASSERT_EQ(kind_, ABACUS_ERROR_MEMORY) << "allocation " << n;
    }
    EXPECT_GT(n, 1u);
}

TEST_P(Failure, OfACancelInAnyPhase) {
    // Before everything, and at each report of progress.
    EXPECT_EQ(run([](MemoryHost &host) { host.cancel(); }), ABACUS_HOST_ERROR);
    ASSERT_TRUE(succeeded(run([](MemoryHost &) {})));
    const std::uint64_t reports = calls_.progress;
    for (std::uint64_t report = 1; report < reports; ++report) {
        const abacus_status status = run([&](MemoryHost &host) {
            host.on_progress = [&host, report, at = std::uint64_t(0)](const auto &) mutable {
                if (++at == report) host.cancel();
            };
        });
        // How often a long phase reports depends on the time. The cancel may come with the last
        // report, when everything is done, or not at all. After a noticed cancel no report follows.
        if (succeeded(status))
            EXPECT_LE(calls_.progress, report);
        else
            EXPECT_EQ(status, ABACUS_HOST_ERROR) << "report " << report;
    }
}

INSTANTIATE_TEST_SUITE_P(Works, Failure, testing::ValuesIn(works),
                         [](const auto &info) { return std::string(info.param.name); });

TEST(Failure, OfABuildLeavesWhatCanBeBuiltAgain) {
    // A database rolls back the pages together with the header; here the test restores them.
    Mesh mesh(1, little), whole(1, little);
    const auto points = random_points(2000, 9);
    ASSERT_EQ(mesh.stage(points), ABACUS_OK);
    ASSERT_EQ(whole.stage(points), ABACUS_OK);
    ASSERT_EQ(whole.build(), ABACUS_OK);
    MemoryHost before;
    before.restore(mesh.host);
    mesh.host.fail_at(40);
    ASSERT_EQ(mesh.build(), ABACUS_HOST_ERROR);
    mesh.host.recover();
    mesh.host.restore(before);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    EXPECT_EQ(mesh.positions(), whole.positions());
}

} // namespace
} // namespace abacus::test
