// All points: the vertices of the mesh page by page, then the points equal to one, then those that
// wait.
#pragma once

#include "points/repeated_points.hpp"
#include "points/vertex_reader.hpp"
#include "query/locate/reader.hpp"
#include "traverse/own_vertices.hpp"

#include <abacus/simplex.h>

namespace abacus {

template <int D> class VertexScan {
public:
    VertexScan(const Host &host, const abacus_facts &facts, std::size_t cache_bytes);

    /// False after the last point.
    bool next(abacus_vertex &vertex);

private:
    bool next_vertex(abacus_vertex &vertex);
    bool next_repeated(abacus_vertex &vertex);
    bool next_waiting(abacus_vertex &vertex);
    bool next_listed(abacus_vertex &vertex);
    /// Takes the vertices of the next page.
    void collect();

    const unsigned attributes_;
    const bool listed_; // a mesh that is not Delaunay has its vertices in pages of their own
    Reader<D> mesh_;
    OwnVertices<D> own_;
    Key page_;                     // the next one to take vertices from
    Arena<std::uint64_t> records_; // those of the page before: the cache may change between calls
    std::size_t at_ = 0;
    std::uint64_t vertices_left_; // as the header counts them
    RepeatedReader<D> repeated_;
    bool more_repeated_ = true;
    std::uint64_t repeated_left_; // as the header counts them
    VertexReader<D> waiting_;
};

} // namespace abacus
