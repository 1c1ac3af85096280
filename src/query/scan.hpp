// The content of a mesh as sequences: simplices in key order, staged points in
// insertion order.
#pragma once

#include "query/page_scan.hpp"
#include "query/reader.hpp"
#include "staging/vertex_reader.hpp"

namespace abacus {

template <int D> class SimplexScan {
public:
    SimplexScan(const Host &host, const abacus_header &header, bool ghosts);

    /// False after the last simplex.
    bool next(abacus_simplex &simplex);

private:
    Domain<D> domain_;
    PageScan<D> pages_;
    bool ghosts_;
    bool in_page_ = false;
    int at_ = 0;
};

template <int D> class VertexScan {
public:
    VertexScan(const Host &host, const abacus_header &header, std::size_t cache_bytes);

    /// False after the last staged point.
    bool next(abacus_vertex &vertex);

private:
    /// Within the first staging, equal points follow one another and the first of them
    /// is the vertex. Points of later ones may equal earlier points: the mesh knows.
    std::int64_t vertex_of(std::uint64_t sequence, const Point<D> &p, std::int64_t id);

    std::uint64_t inserted_, first_batch_;
    VertexReader<D> points_;
    Reader<D> mesh_;
    Arena<double> values_;
    bool has_previous_ = false;
    Point<D> previous_{};
    std::int64_t previous_vertex_ = 0;
};

} // namespace abacus
