// Meshes cut into parts, and shares of them, compared with brute force over all simplices.
#include "support/lattice.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"
#include "support/triangulations.hpp"

#include <abacus/locate.h>
#include <abacus/shares.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace abacus::test {
namespace {

constexpr std::size_t little = 60 << 10, ample = 64 << 20;

/// A simplex by the ids of its corners, sorted.
template <int D> using Name = Ids<D>;

template <int D> Name<D> name_of(const abacus_simplex &simplex) {
    Name<D> name;
    std::copy_n(simplex.id, D + 1, name.begin());
    std::sort(name.begin(), name.end());
    return name;
}

struct Vertex {
    std::uint64_t local;
    std::uint32_t owner;
    std::int64_t id;
    std::vector<double> point, attributes;
};

template <int D> struct Read {
    std::vector<Vertex> vertices;
    std::map<Name<D>, std::uint32_t> simplices; // and the part of each
    std::map<Name<D>, std::uint64_t> codes;
};

template <int D> class Parted {
public:
    explicit Parted(MeshOf<D> &mesh, std::size_t memory = ample) : mesh_(mesh), memory_(memory) {
        abacus_error error{};
        EXPECT_EQ(abacus_mesh_open(mesh.host.table(), &mesh.header.facts, memory, &handle_, &error),
                  ABACUS_OK);
    }
    Parted(const Parted &) = delete;
    Parted &operator=(const Parted &) = delete;
    ~Parted() {
        abacus_mesh_close(handle_);
        if (mesh_.host.failed) return;
        EXPECT_EQ(mesh_.host.bytes, 0u);
        EXPECT_TRUE(mesh_.host.spools.empty());
        EXPECT_EQ(mesh_.host.violations, std::vector<std::string>{});
    }

    abacus_status parts(const abacus_cut &cut, std::vector<abacus_part> &parts) {
        return abacus_mesh_parts(
            handle_, &cut, memory_,
            [](void *context, const abacus_part *part) {
                static_cast<std::vector<abacus_part> *>(context)->push_back(*part);
                return ABACUS_HOST_OK;
            },
            &parts, &error);
    }
    abacus_status vertices(const abacus_share &share, std::vector<Vertex> &vertices) {
        struct Context {
            unsigned attributes;
            std::vector<Vertex> &vertices;
        } context{mesh_.header.facts.columns.attributes, vertices};
        return abacus_mesh_share_vertices(
            handle_, &share, memory_,
            [](void *to, const abacus_share_vertex *v) {
                auto &[attributes, all] = *static_cast<Context *>(to);
                all.push_back({v->local,
                               v->owner,
                               v->id,
                               {v->point, v->point + D},
                               {v->attributes, v->attributes + attributes}});
                return ABACUS_HOST_OK;
            },
            &context, &error);
    }
    /// With the vertices, whose ids are behind the numbers.
    abacus_status read(const abacus_share &share, Read<D> &read) {
        if (const abacus_status status = vertices(share, read.vertices); status != ABACUS_OK)
            return status;
        return abacus_mesh_share_simplices(
            handle_, &share, memory_,
            [](void *to, const abacus_share_simplex *s) {
                auto &share = *static_cast<Read<D> *>(to);
                for (int i = 0; i <= D; ++i) {
                    EXPECT_LT(s->local[i], share.vertices.size());
                    const Vertex &vertex = share.vertices[s->local[i]];
                    EXPECT_EQ(vertex.id, s->simplex.id[i]);
                    EXPECT_TRUE(
                        std::equal(vertex.point.begin(), vertex.point.end(), s->simplex.corner[i]));
                }
                const Name<D> name = name_of<D>(s->simplex);
                EXPECT_TRUE(share.simplices.emplace(name, s->owner).second) << "twice";
                share.codes[name] = s->simplex.code;
                return ABACUS_HOST_OK;
            },
            &read, &error);
    }

    abacus_error error{};

private:
    MeshOf<D> &mesh_;
    const std::size_t memory_;
    abacus_mesh *handle_ = nullptr;
};

abacus_cut equal_parts(std::uint32_t parts) { return {parts, ABACUS_WEIGHT_ONE, 0}; }

/// All simplices along the curve: as many parts have one each.
template <int D> std::vector<Name<D>> order_of(Parted<D> &parted, std::uint32_t simplices) {
    std::vector<Name<D>> order;
    std::uint64_t code = 0;
    for (std::uint32_t part = 0; part < simplices; ++part) {
        Read<D> one;
        EXPECT_EQ(parted.read({equal_parts(simplices), part, 0}, one), ABACUS_OK);
        EXPECT_EQ(one.simplices.size(), 1u);
        order.push_back(one.simplices.begin()->first);
        EXPECT_LE(code, one.codes.begin()->second);
        code = one.codes.begin()->second;
    }
    return order;
}

template <int D> class Expected {
public:
    /// By parts of the simplices.
    explicit Expected(std::map<Name<D>, std::uint32_t> parts) : parts_(std::move(parts)) {
        for (const auto &[name, part] : parts_)
            for (const std::int64_t id : name) at_[id].insert(name);
    }
    std::uint32_t owner(std::int64_t id) const {
        std::uint32_t least = UINT32_MAX;
        for (const auto &name : at_.at(id)) least = std::min(least, parts_.at(name));
        return least;
    }
    std::set<Name<D>> share(std::uint32_t part, std::uint32_t halo) const {
        std::set<Name<D>> all;
        for (const auto &[name, of] : parts_)
            if (of == part) all.insert(name);
        for (std::uint32_t layer = 0; layer < halo; ++layer) {
            const auto before = all;
            for (const Name<D> &name : before)
                for (const std::int64_t id : name) all.insert(at_.at(id).begin(), at_.at(id).end());
            if (all.size() == before.size()) break;
        }
        return all;
    }
    abacus_part sizes(std::uint32_t part) const {
        abacus_part sizes{};
        sizes.part = part;
        for (const auto &[id, names] : at_) sizes.vertices += owner(id) == part;
        const auto own = share(part, 0);
        sizes.simplices = own.size();
        sizes.halo = share(part, 1).size() - own.size();
        for (const Name<D> &name : own)
            for (int left_out = 0; left_out <= D; ++left_out) {
                std::set<std::int64_t> facet(name.begin(), name.end());
                facet.erase(name[left_out]);
                for (const Name<D> &other : at_.at(*facet.begin()))
                    sizes.cut_facets +=
                        parts_.at(other) != part &&
                        std::includes(other.begin(), other.end(), facet.begin(), facet.end());
            }
        return sizes;
    }
    void expect(const Read<D> &read, std::uint32_t part, std::uint32_t halo) const {
        const std::set<Name<D>> wanted = share(part, halo);
        ASSERT_EQ(read.simplices.size(), wanted.size());
        std::set<std::int64_t> ids;
        for (const auto &[name, of] : read.simplices) {
            EXPECT_TRUE(wanted.contains(name));
            EXPECT_EQ(of, parts_.at(name));
            ids.insert(name.begin(), name.end());
        }
        std::set<std::int64_t> found;
        std::pair<bool, std::uint32_t> last{false, 0};
        for (const Vertex &vertex : read.vertices) {
            EXPECT_EQ(vertex.local, found.size());
            EXPECT_TRUE(found.insert(vertex.id).second);
            EXPECT_EQ(vertex.owner, owner(vertex.id));
            const std::pair<bool, std::uint32_t> rank{vertex.owner != part, vertex.owner};
            EXPECT_LE(last, rank);
            last = rank;
        }
        EXPECT_EQ(found, ids);
    }

private:
    std::map<Name<D>, std::uint32_t> parts_;
    std::map<std::int64_t, std::set<Name<D>>> at_;
};

/// The vertices of an owner come in the same order in all shares, which are those of part 0, 1, and
/// so on.
void expect_one_order(const std::vector<std::vector<Vertex>> &shares) {
    std::map<std::int64_t, std::uint64_t> order; // in the owner's share
    for (std::size_t part = 0; part < shares.size(); ++part)
        for (const Vertex &vertex : shares[part])
            if (vertex.owner == part) order[vertex.id] = vertex.local;
    for (const auto &share : shares)
        for (std::size_t i = 1; i < share.size(); ++i)
            if (share[i - 1].owner == share[i].owner) {
                EXPECT_LT(order.at(share[i - 1].id), order.at(share[i].id));
            }
}

/// `weights` of simplices, whole numbers; nullptr: they count.
template <int D>
void expect_parts(MeshOf<D> &mesh, const std::vector<Name<D>> &order, const abacus_cut &cut,
                  const std::map<Name<D>, std::uint64_t> *weights,
                  std::initializer_list<std::uint32_t> halos) {
    SCOPED_TRACE(cut.parts);
    std::uint64_t all = 0, before = 0;
    const auto weight = [&](const Name<D> &name) {
        return weights == nullptr ? 1 : weights->at(name);
    };
    for (const Name<D> &name : order) all += weight(name);
    std::map<Name<D>, std::uint32_t> parts;
    for (const Name<D> &name : order) {
        const std::uint64_t middle = 2 * before + weight(name);
        parts[name] = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(cut.parts * middle / (2 * all), cut.parts - 1));
        before += weight(name);
    }
    const Expected<D> expected(parts);
    for (const std::size_t memory : {ample, little}) {
        Parted<D> parted(mesh, memory);
        std::vector<abacus_part> sizes;
        ASSERT_EQ(parted.parts(cut, sizes), ABACUS_OK) << parted.error.message;
        ASSERT_EQ(sizes.size(), cut.parts);
        std::vector<std::vector<Vertex>> shares;
        for (std::uint32_t part = 0; part < cut.parts; ++part) {
            const abacus_part wanted = expected.sizes(part);
            EXPECT_EQ(sizes[part].part, part);
            EXPECT_EQ(sizes[part].vertices, wanted.vertices);
            EXPECT_EQ(sizes[part].simplices, wanted.simplices);
            EXPECT_EQ(sizes[part].cut_facets, wanted.cut_facets);
            EXPECT_EQ(sizes[part].halo, wanted.halo);
            for (const std::uint32_t halo : halos) {
                SCOPED_TRACE("part " + std::to_string(part) + ", halo " + std::to_string(halo));
                Read<D> read;
                ASSERT_EQ(parted.read({cut, part, halo}, read), ABACUS_OK) << parted.error.message;
                expected.expect(read, part, halo);
                if (halo == 1) shares.push_back(read.vertices);
            }
        }
        expect_one_order(shares);
    }
}

template <int D> void expect_shares(MeshOf<D> &mesh) {
    const auto simplices = static_cast<std::uint32_t>(mesh.header.facts.census.simplices);
    std::vector<Name<D>> order;
    {
        Parted<D> parted(mesh);
        order = order_of<D>(parted, simplices);
    }
    EXPECT_EQ(std::set<Name<D>>(order.begin(), order.end()).size(), simplices);
    for (const std::uint32_t parts : {1u, 2u, 3u, 4u})
        expect_parts<D>(mesh, order, equal_parts(parts), nullptr, {0, 1, 2, 3, 1000000});
    for (const std::uint32_t parts : {7u, 9u, 2 * simplices})
        expect_parts<D>(mesh, order, equal_parts(parts), nullptr, {0, 1});
}

template <int D> class Shares : public testing::Test {
public:
    static constexpr int dimension = D;
};
template <class T> class SharesOf : public Shares<T::value> {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SharesOf, Dimensions);

constexpr int some(int dimension) { return sanitized ? 20 : dimension == 2 ? 70 : 35; }

TYPED_TEST(SharesOf, RandomPoints) {
    constexpr int D = TestFixture::dimension;
    MeshOf<D> mesh;
    ASSERT_EQ(mesh.insert(number<D>(random_points<D>(some(D), 3))), ABACUS_OK);
    expect_shares<D>(mesh);
}

/// Many simplices with one code, and ties everywhere.
TYPED_TEST(SharesOf, AGrid) {
    constexpr int D = TestFixture::dimension;
    MeshOf<D> mesh;
    ASSERT_EQ(mesh.insert(number<D>(grid<D>(D == 2 ? 6 : 3))), ABACUS_OK);
    expect_shares<D>(mesh);
}

/// Parts and holes that touch in vertices alone.
TYPED_TEST(SharesOf, LoadedWithHoles) {
    constexpr int D = TestFixture::dimension;
    int number = 0;
    const auto t = keeping<D>(delaunay<D>(random_points<D>(some(D), 5)),
                              [&](const Point<D> &) { return ++number % 2 == 0; });
    MeshOf<D> mesh;
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    expect_shares<D>(mesh);
}

/// Two halves with vertices of their own at the same places.
TYPED_TEST(SharesOf, SplitNodes) {
    constexpr int D = TestFixture::dimension;
    const auto all = delaunay<D>(grid<D>(D == 2 ? 5 : 3));
    const double middle = D == 2 ? 2 : 1;
    auto t = keeping<D>(all, [&](const Point<D> &c) { return c[0] < middle; });
    t.add(keeping<D>(all, [&](const Point<D> &c) { return c[0] > middle; }), 1000);
    MeshOf<D> mesh;
    mesh.split_nodes = true;
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    ASSERT_GT(mesh.header.facts.census.split, 0u);
    expect_shares<D>(mesh);
}

/// The order of insertion, and so the pages, make no difference.
TYPED_TEST(SharesOf, OneMeshInAnyOrder) {
    constexpr int D = TestFixture::dimension;
    auto points = number<D>(random_points<D>(300, 8));
    std::vector<std::vector<Vertex>> found;
    for (int round = 0; round < 2; ++round) {
        MeshOf<D> mesh(0, round == 0 ? ample : little);
        mesh.header.facts.form.has_domain = 1;
        std::fill_n(mesh.header.facts.form.upper, D, 1);
        for (std::size_t at = 0; at < points.size();) {
            const std::size_t n =
                round == 0 ? points.size() : std::min<std::size_t>(70, points.size() - at);
            const auto begin = points.begin() + static_cast<std::ptrdiff_t>(at);
            ASSERT_EQ(mesh.insert({begin, begin + static_cast<std::ptrdiff_t>(n)}), ABACUS_OK)
                << mesh.error.message;
            at += n;
        }
        Parted<D> parted(mesh);
        found.emplace_back();
        ASSERT_EQ(parted.vertices({equal_parts(5), 2, 1}, found.back()), ABACUS_OK);
        std::reverse(points.begin(), points.end());
    }
    ASSERT_EQ(found[0].size(), found[1].size());
    for (std::size_t i = 0; i < found[0].size(); ++i) {
        EXPECT_EQ(found[0][i].id, found[1][i].id);
        EXPECT_EQ(found[0][i].owner, found[1][i].owner);
    }
}

/// Weights of the corners are whole numbers, so brute force sums them exactly.
TYPED_TEST(SharesOf, Weights) {
    constexpr int D = TestFixture::dimension;
    auto points = number<D>(random_points<D>(some(D), 9));
    Random random(2);
    std::map<std::int64_t, double> value;
    for (auto &p : points) {
        // a mean may be 0 though its parts are not; missing ones count as 0
        const bool none = random() % 5 == 0;
        value[p.id] = none ? 0 : static_cast<double>(random() % 1000);
        p.attributes = {none ? double(NAN) : value[p.id], -1};
    }
    MeshOf<D> mesh(2);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    std::vector<Name<D>> order;
    {
        Parted<D> parted(mesh);
        order = order_of<D>(parted, static_cast<std::uint32_t>(mesh.header.facts.census.simplices));
    }
    std::map<Name<D>, std::uint64_t> weights;
    for (const Name<D> &name : order) {
        double sum = 0;
        for (const std::int64_t id : name) sum += value[id];
        weights[name] = static_cast<std::uint64_t>(sum);
    }
    for (const std::uint32_t parts : {1u, 2u, 5u, 9u})
        expect_parts<D>(mesh, order, {parts, ABACUS_WEIGHT_ATTRIBUTE, 0}, &weights, {0, 1});
    Parted<D> parted(mesh);
    std::vector<abacus_part> sizes;
    EXPECT_EQ(parted.parts({2, ABACUS_WEIGHT_ATTRIBUTE, 1}, sizes), ABACUS_ERROR);
    EXPECT_EQ(parted.error.kind, ABACUS_ERROR_ARGUMENT);
    EXPECT_NE(std::string(parted.error.message).find("has the weight (-1)"), std::string::npos)
        << parted.error.message;
}

/// The status of a cut by the weights of a single simplex.
template <int D>
abacus_status cut_by(const std::array<double, D + 1> &values, abacus_error &error) {
    std::vector<InputOf<D>> points;
    for (int i = 0; i <= D; ++i) {
        Point<D> p{};
        if (i > 0) p[i - 1] = 1;
        points.emplace_back(i, p, std::vector<double>{values[i]});
    }
    MeshOf<D> mesh(1);
    EXPECT_EQ(mesh.insert(points), ABACUS_OK);
    Parted<D> parted(mesh);
    std::vector<abacus_part> sizes;
    const abacus_status status = parted.parts({2, ABACUS_WEIGHT_ATTRIBUTE, 0}, sizes);
    error = parted.error;
    return status;
}

TEST(SharesOfWeight, TheSignOfAMeanIsExact) {
    abacus_error error{};
    EXPECT_EQ(cut_by<2>({1, 2, -3}, error), ABACUS_OK)
        << error.message; // thirds would round below 0
    EXPECT_EQ(cut_by<2>({1e300, 1e-300, -1e300}, error), ABACUS_OK) << error.message;
    EXPECT_EQ(cut_by<2>({1e300, -1e-300, -1e300}, error), ABACUS_ERROR);
    EXPECT_EQ(cut_by<2>({1.7e308, 1.7e308, 1.7e308}, error), ABACUS_OK) << error.message;
    EXPECT_EQ(cut_by<2>({INFINITY, 1, 1}, error), ABACUS_ERROR);
    EXPECT_EQ(std::string(error.message), "the simplex (0, 1, 2) has the weight (inf)");
    EXPECT_EQ(cut_by<2>({INFINITY, 1, -INFINITY}, error), ABACUS_ERROR);
    EXPECT_EQ(cut_by<3>({0.1, 0.2, 0.3, -0.6}, error), ABACUS_OK)
        << error.message;                                            // a little more than 0
    EXPECT_EQ(cut_by<3>({0.3, -0.1, -0.2, 0}, error), ABACUS_ERROR); // a little less
    EXPECT_EQ(cut_by<3>({0.25, 0.5, -0.75, 0}, error), ABACUS_OK) << error.message;
}

TEST(SharesOfMany, PartsCanBeCancelled) {
    MeshOf<2> mesh;
    ASSERT_EQ(mesh.insert(number<2>(random_points<2>(30, 1))), ABACUS_OK);
    const abacus_cut many{0x7fffffff, ABACUS_WEIGHT_ONE, 0};
    std::vector<Vertex> vertices;
    {
        Parted<2> small(mesh, 1 << 10);
        EXPECT_EQ(small.vertices({many, 3, 1}, vertices), ABACUS_ERROR);
        EXPECT_EQ(small.error.kind, ABACUS_ERROR_LIMIT) << small.error.message;
        EXPECT_EQ(small.vertices({equal_parts(3), 0, 1}, vertices), ABACUS_OK);
        vertices.clear();
    }
    Parted<2> parted(mesh);
    EXPECT_EQ(parted.vertices({many, 0x7ffffffe, 1}, vertices), ABACUS_OK);
    EXPECT_TRUE(vertices.empty());
    std::uint64_t seen = 0;
    std::pair<MemoryHost *, std::uint64_t *> context{&mesh.host, &seen};
    abacus_error error{};
    abacus_mesh *handle = nullptr;
    ASSERT_EQ(abacus_mesh_open(mesh.host.table(), &mesh.header.facts, ample, &handle, &error),
              ABACUS_OK);
    EXPECT_EQ(abacus_mesh_parts(
                  handle, &many, ample,
                  [](void *to, const abacus_part *) {
                      auto &[host, count] = *static_cast<decltype(context) *>(to);
                      if (++*count == 1000) host->cancel();
                      return ABACUS_HOST_OK;
                  },
                  &context, &error),
              ABACUS_HOST_ERROR);
    EXPECT_LT(seen, 10000u);
    abacus_mesh_close(handle);
}

} // namespace
} // namespace abacus::test
