#include "support/oracle.hpp"

#include "support/apart.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>

namespace abacus::test {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// By even permutations, which keep the orientation.
template <int D> Positions<D> canonical(Positions<D> s) {
    const auto first = std::min_element(s.begin(), s.end());
    if constexpr (D == 2) {
        std::rotate(s.begin(), first, s.end());
    } else {
        if (first != s.begin()) {
            std::iter_swap(s.begin(), first);
            const auto after = first == s.begin() + 1 ? s.begin() + 2 : s.begin() + 1;
            std::iter_swap(after, after + 1 == first ? after + 2 : after + 1);
        }
        std::rotate(s.begin() + 1, std::min_element(s.begin() + 1, s.end()), s.end());
    }
    return s;
}

Kernel::Point_2 to_cgal(const Point<2> &p) { return {p[0], p[1]}; }
Kernel::Point_3 to_cgal(const Point<3> &p) { return {p[0], p[1], p[2]}; }

/// CGAL's meshes and their simplices; the same names for both dimensions.
template <int D> struct Cgal;
template <> struct Cgal<2> {
    using Mesh = CGAL::Delaunay_triangulation_2<Kernel>;
    static auto simplices(const Mesh &mesh) { return mesh.finite_face_handles(); }
};
template <> struct Cgal<3> {
    using Mesh = CGAL::Delaunay_triangulation_3<Kernel>;
    static auto simplices(const Mesh &mesh) { return mesh.finite_cell_handles(); }
};

template <int D> std::vector<std::uint64_t> record_of(const InputOf<D> &input) {
    std::vector<std::uint64_t> record{static_cast<std::uint64_t>(input.id)};
    for (const double x : input.point) record.push_back(std::bit_cast<std::uint64_t>(x));
    for (const double x : input.attributes) record.push_back(std::bit_cast<std::uint64_t>(x));
    return record;
}

} // namespace

template <int D> MeshOf<D>::MeshOf(int attributes, std::size_t bytes) : cache_bytes(bytes) {
    header.facts.form.dimension = D;
    header.facts.columns.attributes = static_cast<std::uint32_t>(attributes);
    choose_where_attributes_are(header);
    for (int i = 0; i < attributes; ++i)
        std::snprintf(header.names[i], ABACUS_NAME_BYTES, "a%d", i);
}

template <int D>
abacus_status MeshOf<D>::with_stage(const std::vector<InputOf<D>> &points, std::size_t memory,
                                    const std::function<abacus_status(abacus_stage *)> &use,
                                    bool with_attributes) {
    abacus_stage *stage = nullptr;
    abacus_header staged = header;
    if (!with_attributes) staged.facts.columns.attributes = 0;
    abacus_status status = abacus_stage_open(host.table(), &staged.facts, memory, &stage, &error);
    if (status != ABACUS_OK) return status;
    for (const InputOf<D> &input : points) {
        std::vector<std::uint64_t> record = record_of(input);
        if (!with_attributes) record.resize(1 + D);
        status = abacus_stage_add(stage, record.data(), 1, &error);
        if (status != ABACUS_OK) break;
    }
    if (status == ABACUS_OK) status = use(stage);
    abacus_stage_close(stage);
    return status;
}

template <int D>
abacus_status MeshOf<D>::load(const std::vector<InputOf<D>> &vertices,
                              const std::vector<std::array<std::int64_t, D + 1>> &simplices,
                              std::size_t memory, bool reorient, bool retriangulate,
                              const std::vector<std::vector<double>> &labels,
                              const std::vector<std::uint64_t> &facets) {
    abacus_load *load = nullptr;
    if (split_nodes) header.facts.columns.apart = 0;
    abacus_status status =
        abacus_load_open(host.table(), &header.facts, memory, reorient, split_nodes, &load, &error);
    if (status != ABACUS_OK) return status;
    for (const InputOf<D> &vertex : vertices) {
        const std::vector<std::uint64_t> record = record_of(vertex);
        status = abacus_load_vertices(load, record.data(), 1, &error);
        if (status != ABACUS_OK) break;
    }
    std::vector<std::uint64_t> records;
    for (std::size_t at = 0; status == ABACUS_OK && at < simplices.size();) {
        records.clear();
        const std::size_t begin = at;
        for (; at < std::min(begin + 100, simplices.size()); ++at) {
            records.insert(records.end(), simplices[at].begin(), simplices[at].end());
            for (std::uint32_t i = 0; i < header.facts.columns.labels; ++i)
                records.push_back(std::bit_cast<std::uint64_t>(labels.at(at).at(i)));
        }
        status = abacus_load_simplices(load, records.data(), at - begin, &error);
    }
    if (status == ABACUS_OK && !facets.empty())
        status = abacus_load_facets(load, facets.data(), facets.size() / (D + 1), &error);
    if (status == ABACUS_OK) status = abacus_load_check(load, &loaded_as, &error);
    if (status == ABACUS_OK && retriangulate && loaded_as != ABACUS_DELAUNAY)
        status = with_stage({}, memory, [&](abacus_stage *stage) {
            const abacus_status staged = abacus_load_stage(load, stage, &error);
            return staged == ABACUS_OK ? abacus_stage_finish(stage, &header.facts, &error) : staged;
        });
    else if (status == ABACUS_OK)
        status = abacus_load_write(load, 0, &header, &error);
    abacus_load_close(load);
    return status;
}

template <int D>
abacus_status MeshOf<D>::with_build(const std::function<abacus_status(abacus_build *)> &use) {
    abacus_build *build = nullptr;
    abacus_status status =
        abacus_build_open(host.table(), &header.facts, cache_bytes, &build, &error);
    if (status == ABACUS_OK) status = use(build);
    abacus_build_close(build);
    return status;
}

template <int D>
abacus_status MeshOf<D>::stage(const std::vector<InputOf<D>> &points, std::size_t memory) {
    return with_stage(points, memory, [&](abacus_stage *stage) {
        return abacus_stage_finish(stage, &header.facts, &error);
    });
}

template <int D> abacus_status MeshOf<D>::build() {
    return with_build(
        [&](abacus_build *build) { return abacus_build_run(build, 0, &header, &error); });
}

template <int D>
abacus_status MeshOf<D>::insert(const std::vector<InputOf<D>> &points, std::size_t memory,
                                abacus_on_duplicate on_duplicate) {
    const abacus_header before = header;
    const abacus_status status = with_stage(points, memory, [&](abacus_stage *stage) {
        const abacus_status ended = abacus_stage_end(stage, &header.facts, &error);
        if (ended != ABACUS_OK) return ended;
        return with_build([&](abacus_build *build) {
            return abacus_build_insert(build, stage, on_duplicate, &header, &error);
        });
    });
    if (status != ABACUS_OK) header = before;
    return status;
}

template <int D>
abacus_status MeshOf<D>::remove(const std::vector<InputOf<D>> &points, std::uint64_t &deleted,
                                std::size_t memory, bool exactly) {
    const auto use = [&](abacus_stage *stage) {
        return with_build([&](abacus_build *build) {
            return abacus_build_delete(build, stage, exactly, &header, &deleted, &error);
        });
    };
    return with_stage(points, memory, use, exactly); // otherwise attributes do not count
}

template <int D>
std::vector<Positions<D>> positions_of(const std::vector<abacus_simplex> &simplices) {
    std::vector<Positions<D>> result;
    for (const abacus_simplex &s : simplices) {
        Positions<D> corners;
        for (int i = 0; i <= D; ++i) std::copy_n(s.corner[i], D, corners[i].begin());
        result.push_back(canonical<D>(corners));
    }
    std::sort(result.begin(), result.end());
    return result;
}

template <int D> std::vector<Positions<D>> MeshOf<D>::positions() {
    return positions_of<D>(simplices(false));
}

template <int D> std::vector<abacus_simplex> MeshOf<D>::simplices(bool ghosts) {
    std::vector<abacus_simplex> result;
    abacus_scan *scan = nullptr;
    abacus_status status = abacus_scan_open(host.table(), &header.facts, ghosts, &scan, &error);
    abacus_simplex s;
    while (status == ABACUS_OK && (status = abacus_scan_next(scan, &s, &error)) == ABACUS_OK)
        result.push_back(s);
    EXPECT_EQ(status, ABACUS_END) << error.message << ' ' << error.detail;
    abacus_scan_close(scan);
    return result;
}

template <int D> std::vector<std::string> MeshOf<D>::check() {
    std::vector<std::string> faults;
    abacus_check *check = nullptr;
    const abacus_status status =
        abacus_check_open(host.table(), &header.facts, cache_bytes, 100, &check, &error);
    if (status != ABACUS_OK) return {std::string("status: ") + error.message};
    abacus_fault fault;
    while (abacus_check_next(check, &fault) == ABACUS_OK)
        faults.push_back(std::string(fault.kind) + ": " + fault.message);
    abacus_check_close(check);
    return faults;
}

template <int D> abacus_status MeshOf<D>::locate(const Point<D> &p, abacus_simplex &simplex) {
    abacus_mesh *mesh = nullptr;
    abacus_status status =
        abacus_mesh_open(host.table(), &header.facts, cache_bytes, &mesh, &error);
    if (status != ABACUS_OK) return status;
    status = abacus_mesh_locate(mesh, p.data(), &simplex, &error);
    abacus_mesh_close(mesh);
    return status;
}

template <int D> OpenMeshOf<D>::OpenMeshOf(MeshOf<D> &mesh, std::size_t cache_bytes) {
    EXPECT_EQ(
        abacus_mesh_open(mesh.host.table(), &mesh.header.facts, cache_bytes, &handle_, &error),
        ABACUS_OK);
}

template <int D> abacus_counters OpenMeshOf<D>::counters() const {
    abacus_counters counters;
    abacus_mesh_counters(handle_, &counters);
    return counters;
}

std::vector<Point<2>> unit_square_points(int n, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Point<2>> points(n);
    for (auto &p : points) p = {unit(random), unit(random)};
    return points;
}

template <int D> std::vector<InputOf<D>> number(const std::vector<Point<D>> &points) {
    std::vector<InputOf<D>> inputs;
    for (const Point<D> &p : points)
        inputs.push_back({static_cast<std::int64_t>(inputs.size()), p});
    return inputs;
}

template <int D> std::vector<Positions<D>> cgal_simplices(const std::vector<Point<D>> &points) {
    std::vector<decltype(to_cgal(points[0]))> input;
    for (const Point<D> &p : points) input.push_back(to_cgal(p));
    const typename Cgal<D>::Mesh mesh(input.begin(), input.end());
    std::vector<Positions<D>> result;
    if (mesh.dimension() < D) return result;
    for (const auto simplex : Cgal<D>::simplices(mesh)) {
        Positions<D> corners;
        for (int i = 0; i <= D; ++i)
            for (int axis = 0; axis < D; ++axis)
                corners[i][axis] = simplex->vertex(i)->point()[axis];
        result.push_back(canonical<D>(corners));
    }
    std::sort(result.begin(), result.end());
    return result;
}

template struct MeshOf<2>;
template struct MeshOf<3>;
template class OpenMeshOf<2>;
template class OpenMeshOf<3>;
template std::vector<InputOf<2>> number<2>(const std::vector<Point<2>> &);
template std::vector<InputOf<3>> number<3>(const std::vector<Point<3>> &);
template std::vector<Positions<2>> positions_of<2>(const std::vector<abacus_simplex> &);
template std::vector<Positions<3>> positions_of<3>(const std::vector<abacus_simplex> &);
template std::vector<Positions<2>> cgal_simplices<2>(const std::vector<Point<2>> &);
template std::vector<Positions<3>> cgal_simplices<3>(const std::vector<Point<3>> &);

} // namespace abacus::test
