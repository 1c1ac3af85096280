// oracle_constrained: CGAL's constrained Delaunay triangulation of points and segments, and which
// triangles lie within outlines.
//
//   oracle_constrained <INPUT >OUTPUT
//
// INPUT   the numbers of points, of segments and of sides (64 bits each); points as pairs of
//         doubles, all different; segments as pairs of numbers of points (64 bits each, counted
//         from 0); sides of outlines as the number of a region and two of points, each on segments
// OUTPUT  the numbers of triangles, of constrained edges and of triangles within regions (64 bits
//         each); triangles as three numbers of points (64 bits each) in positive orientation, the
//         least first, in ascending order; edges as two numbers, the lesser first, in ascending
//         order; triangles within regions in the same way, after the number of the region
//
// All numbers are little-endian. Among cocircular points CGAL chooses by is_flipable(), whose
// perturbation is lexicographic, as that of Abacus is. A crossing outside of a vertex is an error.
//
// What lies within outlines is found as by CGAL's mark_domain_in_triangulation(), which Debian 12
// does not have: the nesting level of a triangle is the least number of borders on the way to it
// from outside, and those with an odd level are inside. Borders of a region are the edges that its
// sides have an odd number of times.
#include "copy_format.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Unique_hash_map.h>

#include <algorithm>
#include <deque>
#include <map>
#include <numeric>
#include <set>

using namespace abacus::oracle;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int64_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Edge = std::array<std::int64_t, 2>;
using Triangle = std::array<std::int64_t, 3>;
using Face = Triangulation::Face_handle;
using Vertices = std::vector<Triangulation::Vertex_handle>;

/// The next words of a file, as numbers or as doubles.
template <class Word, std::size_t N>
std::vector<std::array<Word, N>> read(File &file, std::size_t rows) {
    std::vector<std::array<Word, N>> result(rows);
    file.read(result.data(), rows * sizeof(std::array<Word, N>));
    return result;
}

/// Vertices in the order of the points.
Vertices triangulate(Triangulation &result, const std::vector<std::array<double, 2>> &points,
                     const std::vector<Edge> &segments) {
    std::vector<std::ptrdiff_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<Kernel::Point_2> places;
    for (const auto &[x, y] : points) places.emplace_back(x, y);
    CGAL::spatial_sort(
        order.begin(), order.end(),
        CGAL::Spatial_sort_traits_adapter_2<Kernel, const Kernel::Point_2 *>(places.data()));
    Vertices vertices(points.size());
    Face hint;
    for (const std::ptrdiff_t n : order) {
        const auto i = std::size_t(n);
        vertices[i] = result.insert(places[i], hint);
        vertices[i]->info() = n;
        hint = vertices[i]->face();
    }
    if (result.number_of_vertices() != points.size()) throw std::runtime_error("points are equal");
    for (const auto &[a, b] : segments)
        result.insert_constraint(vertices.at(std::size_t(a)), vertices.at(std::size_t(b)));
    return vertices;
}

Triangle corners(Face f) {
    Triangle t{f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

Edge ends(const Triangulation::Edge &edge) {
    const std::int64_t a = edge.first->vertex(Triangulation::cw(edge.second))->info();
    const std::int64_t b = edge.first->vertex(Triangulation::ccw(edge.second))->info();
    return {std::min(a, b), std::max(a, b)};
}

/// Lets edges be constraints only if a region has sides on them an odd number of times.
void constrain_borders(Triangulation &triangulation, const Vertices &vertices,
                       const std::vector<Edge> &sides) {
    std::set<Edge> odd;
    for (const auto &[a, b] : sides) {
        Triangulation::Vertex_handle at = vertices.at(std::size_t(a)), next;
        const Triangulation::Vertex_handle last = vertices.at(std::size_t(b));
        for (; at != last; at = next) {
            Face f;
            int i;
            if (!triangulation.includes_edge(at, last, next, f, i))
                throw std::runtime_error("a side is not on edges");
            if (const auto [edge, is_new] = odd.insert(ends({f, i})); !is_new) odd.erase(edge);
        }
    }
    for (const auto &[f, i] : triangulation.finite_edges()) {
        const bool is_border = odd.count(ends({f, i})) > 0;
        f->set_constraint(i, is_border);
        f->neighbor(i)->set_constraint(triangulation.mirror_index(f, i), is_border);
    }
}

/// Triangles with an odd nesting level.
std::vector<Triangle> find_inside(const Triangulation &triangulation) {
    std::vector<Triangle> result;
    CGAL::Unique_hash_map<Face, int> level(-1);
    std::deque<std::pair<Face, int>> border{{triangulation.infinite_face(), 0}};
    for (; !border.empty(); border.pop_front()) {
        std::deque<Face> queue{border.front().first};
        const int here = border.front().second;
        for (; !queue.empty(); queue.pop_front()) {
            const Face f = queue.front();
            if (level[f] >= 0) continue;
            level[f] = here;
            if (here % 2 == 1) result.push_back(corners(f));
            for (int i = 0; i < 3; ++i)
                if (f->is_constrained(i))
                    border.emplace_back(f->neighbor(i), here + 1);
                else
                    queue.push_back(f->neighbor(i));
        }
    }
    return result;
}

template <class Row> void write(File &file, std::vector<Row> &rows) {
    std::sort(rows.begin(), rows.end());
    file.write(rows.data(), rows.size() * sizeof(Row));
}

void run() {
    File input("-", "r"), output("-", "w");
    const auto count = read<std::int64_t, 3>(input, 1)[0];
    const auto points = read<double, 2>(input, std::size_t(count[0]));
    Triangulation triangulation;
    const Vertices vertices =
        triangulate(triangulation, points, read<std::int64_t, 2>(input, std::size_t(count[1])));
    std::map<std::int64_t, std::vector<Edge>> regions;
    for (const auto &[region, a, b] : read<std::int64_t, 3>(input, std::size_t(count[2])))
        regions[region].push_back({a, b});

    std::vector<Triangle> triangles;
    std::vector<Edge> edges;
    if (triangulation.dimension() == 2)
        for (const Face f : triangulation.finite_face_handles()) triangles.push_back(corners(f));
    for (auto e = triangulation.constrained_edges_begin();
         e != triangulation.constrained_edges_end(); ++e)
        edges.push_back(ends(*e));
    std::vector<std::array<std::int64_t, 4>> inside;
    for (const auto &[region, sides] : regions) {
        constrain_borders(triangulation, vertices, sides);
        for (const auto &[a, b, c] : find_inside(triangulation))
            inside.push_back({region, a, b, c});
    }
    const Triangle counts{std::int64_t(triangles.size()), std::int64_t(edges.size()),
                          std::int64_t(inside.size())};
    output.write(&counts, sizeof counts);
    write(output, triangles);
    write(output, edges);
    write(output, inside);
}

} // namespace

int main(int argc, char **) {
    if (argc != 1) {
        std::fprintf(stderr, "usage: oracle_constrained <INPUT >OUTPUT\n");
        return 2;
    }
    try {
        run();
    } catch (const std::exception &error) {
        std::fprintf(stderr, "oracle_constrained: %s\n", error.what());
        return 2;
    }
}
