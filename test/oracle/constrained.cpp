// oracle_constrained: CGAL's constrained Delaunay triangulation of points and segments.
//
//   oracle_constrained <INPUT >OUTPUT
//
// INPUT   the numbers of points and of segments (64 bits each), points as pairs of doubles, all
//         different, segments as pairs of numbers of points (64 bits each, counted from 0)
// OUTPUT  the numbers of triangles and of constrained edges (64 bits each), triangles as three
//         numbers of points (64 bits each) in positive orientation, the least first, in ascending
//         order; edges as two numbers, the lesser first, in ascending order
//
// All numbers are little-endian. Among cocircular points CGAL chooses by is_flipable(), whose
// perturbation is lexicographic, as that of Abacus is. A crossing outside of a vertex is an error.
#include "copy_format.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <numeric>

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

/// The next words of a file, as numbers or as doubles.
template <class Word, std::size_t N>
std::vector<std::array<Word, N>> read(File &file, std::size_t rows) {
    std::vector<std::array<Word, N>> result(rows);
    file.read(result.data(), rows * sizeof(std::array<Word, N>));
    return result;
}

Triangulation triangulate(const std::vector<std::array<double, 2>> &points,
                          const std::vector<Edge> &segments) {
    std::vector<std::ptrdiff_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<Kernel::Point_2> places;
    for (const auto &[x, y] : points) places.emplace_back(x, y);
    CGAL::spatial_sort(
        order.begin(), order.end(),
        CGAL::Spatial_sort_traits_adapter_2<Kernel, const Kernel::Point_2 *>(places.data()));
    Triangulation result;
    std::vector<Triangulation::Vertex_handle> vertices(points.size());
    Triangulation::Face_handle hint;
    for (const std::ptrdiff_t n : order) {
        const auto i = std::size_t(n);
        vertices[i] = result.insert(places[i], hint);
        vertices[i]->info() = n;
        hint = vertices[i]->face();
    }
    if (result.number_of_vertices() != points.size()) throw std::runtime_error("points are equal");
    for (const auto &[a, b] : segments)
        result.insert_constraint(vertices.at(std::size_t(a)), vertices.at(std::size_t(b)));
    return result;
}

template <class Row> void write(File &file, std::vector<Row> &rows) {
    std::sort(rows.begin(), rows.end());
    file.write(rows.data(), rows.size() * sizeof(Row));
}

void run() {
    File input("-", "r"), output("-", "w");
    const auto count = read<std::int64_t, 2>(input, 1)[0];
    const auto points = read<double, 2>(input, std::size_t(count[0]));
    const Triangulation triangulation =
        triangulate(points, read<std::int64_t, 2>(input, std::size_t(count[1])));

    std::vector<Triangle> triangles;
    std::vector<Edge> edges;
    if (triangulation.dimension() == 2)
        for (auto f = triangulation.finite_faces_begin(); f != triangulation.finite_faces_end();
             ++f) {
            Triangle t{f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()};
            std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
            triangles.push_back(t);
        }
    for (auto e = triangulation.constrained_edges_begin();
         e != triangulation.constrained_edges_end(); ++e) {
        const std::int64_t a = e->first->vertex(Triangulation::cw(e->second))->info();
        const std::int64_t b = e->first->vertex(Triangulation::ccw(e->second))->info();
        edges.push_back({std::min(a, b), std::max(a, b)});
    }
    const Edge counts{std::int64_t(triangles.size()), std::int64_t(edges.size())};
    output.write(&counts, sizeof counts);
    write(output, triangles);
    write(output, edges);
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
