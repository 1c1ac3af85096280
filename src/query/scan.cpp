#include "query/scan.hpp"

#include "cache/domain_of.hpp"
#include "query/describe.hpp"

namespace abacus {

template <int D>
SimplexScan<D>::SimplexScan(const Host &host, const abacus_header &header, bool ghosts)
    : domain_(domain_of<D>(header)), pages_(host, header.attributes), ghosts_(ghosts) {}

template <int D> bool SimplexScan<D>::next(abacus_simplex &simplex) {
    for (;;) {
        if (!in_page_) {
            if (!pages_.advance()) return false;
            in_page_ = true;
            at_ = 0;
        }
        const PageView<D> &page = pages_.page();
        while (at_ < page.simplices()) {
            const int s = at_++;
            const bool ghost = page.is_ghost(s);
            if (ghost && !ghosts_) continue;
            std::array<Point<D>, D + 1> points;
            std::uint64_t code = 0;
            for (int i = 0; i < D + !ghost; ++i) {
                points[i] = page.point(page.corner(s, i));
                code = std::max(code, domain_.code(points[i]));
            }
            SimplexWriter<D> writer(simplex, code, ghost);
            for (int i = 0; i < D + !ghost; ++i)
                writer.corner(i, page.id(page.corner(s, i)), points[i]);
            writer.finish();
            return true;
        }
        in_page_ = false;
    }
}

template <int D>
VertexScan<D>::VertexScan(const Host &host, const abacus_header &header, std::size_t cache_bytes)
    : inserted_(header.simplices > 0 ? header.inserted : 0), first_batch_(header.first_batch),
      points_(host, header.attributes, 0, header.points), mesh_(host, header, cache_bytes),
      values_(host) {
    values_.resize(header.attributes);
}

template <int D> bool VertexScan<D>::next(abacus_vertex &vertex) {
    if (!points_.advance()) return false;
    const Point<D> p = points_.point();
    vertex.sequence = points_.sequence();
    vertex.id = points_.id();
    std::copy(p.begin(), p.end(), vertex.point);
    points_.attributes(values_.data());
    vertex.attributes = values_.data();
    vertex.inserted = vertex.sequence < inserted_;
    vertex.vertex = vertex.inserted ? vertex_of(vertex.sequence, p, vertex.id) : 0;
    return true;
}

template <int D>
std::int64_t VertexScan<D>::vertex_of(std::uint64_t sequence, const Point<D> &p, std::int64_t id) {
    std::int64_t vertex = id;
    if (has_previous_ && previous_ == p) {
        vertex = previous_vertex_;
    } else if (sequence >= first_batch_) {
        const auto found = mesh_.vertex_at(p);
        if (!found) throw_corrupted("An inserted point is no vertex of the mesh.");
        vertex = found->id;
    }
    has_previous_ = true;
    previous_ = p;
    previous_vertex_ = vertex;
    return vertex;
}

template class SimplexScan<2>;
template class SimplexScan<3>;
template class VertexScan<2>;
template class VertexScan<3>;

} // namespace abacus
