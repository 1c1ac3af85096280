// CGAL's Delaunay triangulation of the points of a table, as a sorted set of canonical simplices,
// with one specialization for each dimension.
#pragma once

#include "point_table.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

namespace abacus::oracle {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <int D> struct Delaunay;

template <> struct Delaunay<2> {
    using Point = Kernel::Point_2;
    using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
    using Triangulation =
        CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;

    static Point point(const Coordinates<2> &p) { return {p[0], p[1]}; }

    template <class Visit> static void for_each_cell(const Triangulation &t, Visit visit) {
        for (auto face = t.finite_faces_begin(); face != t.finite_faces_end(); ++face) visit(*face);
    }
};

template <> struct Delaunay<3> {
    using Point = Kernel::Point_3;
    using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
    using CellBase = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
    using Triangulation =
        CGAL::Delaunay_triangulation_3<Kernel,
                                       CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

    static Point point(const Coordinates<3> &p) { return {p[0], p[1], p[2]}; }

    template <class Visit> static void for_each_cell(const Triangulation &t, Visit visit) {
        for (auto cell = t.finite_cells_begin(); cell != t.finite_cells_end(); ++cell) visit(*cell);
    }
};

template <int D> bool is_positive(const Points<D> &points, const Simplex<D> &s) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return CGAL::orientation(Delaunay<D>::point(points[s[I]])...) == CGAL::POSITIVE;
    }
    (std::make_index_sequence<D + 1>());
}

template <int D> std::vector<Simplex<D>> delaunay(const Points<D> &points) {
    std::vector<std::pair<typename Delaunay<D>::Point, std::uint32_t>> input;
    input.reserve(points.size());
    for (const Coordinates<D> &p : points)
        input.emplace_back(Delaunay<D>::point(p), std::uint32_t(input.size()));
    typename Delaunay<D>::Triangulation triangulation;
    triangulation.insert(input.begin(), input.end());
    input = {};

    std::vector<Simplex<D>> simplices;
    if (triangulation.dimension() == D)
        Delaunay<D>::for_each_cell(triangulation, [&](const auto &cell) {
            Simplex<D> simplex;
            for (int i = 0; i <= D; ++i) simplex[i] = cell.vertex(i)->info();
            simplices.push_back(canonical<D>(simplex));
        });
    std::sort(simplices.begin(), simplices.end());
    return simplices;
}

} // namespace abacus::oracle
