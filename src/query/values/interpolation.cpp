#include "query/values/interpolation.hpp"

#include "query/locate/nearest.hpp"
#include "query/locate/require_delaunay.hpp"
#include "query/values/barycentric.hpp"
#include "query/values/weighted_mean.hpp"

namespace abacus {

namespace {

template <int D> void require_natural_neighbours(const Reader<D> &reader) {
    if (reader.is_own()) return;
    require_delaunay(reader, "natural neighbours need",
                     "Use the method linear, or load the mesh with retriangulate => true.");
}

} // namespace

template <int D>
bool Interpolation<D>::weigh_corners(Reader<D> &reader, const abacus_interpolation &what,
                                     const Point<D> &p) {
    abacus_simplex simplex;
    CornerValues carried(what.attribute, what.attributes);
    if (!reader.locate(p, simplex, &carried, what.extent)) return false;
    const std::array<double, D + 1> weights = barycentric_weights<D>(simplex, p);
    for (int i = 0; i <= D; ++i)
        add(what, simplex.id[i], weights[i], [&](std::uint32_t n) { return carried.value(i, n); });
    return true;
}

template <int D>
bool Interpolation<D>::weigh_natural(Reader<D> &reader, const abacus_interpolation &what,
                                     const Point<D> &p) {
    require_natural_neighbours(reader);
    abacus_simplex simplex;
    if (!is_all(what.extent) && !reader.locate(p, simplex, nullptr, what.extent)) return false;
    const Handle h = reader.simplex_around(p);
    Cache<D> &cache = reader.cache();
    if (h == no_handle || cache.simplex(h).is_ghost()) return false;
    const VertexHeap<D> &vertices = cache.vertices();
    const auto add_vertex = [&](VertexIndex v, double weight) {
        add(what, vertices.id(v), weight, [&](std::uint32_t n) {
            const auto attribute = static_cast<int>(what.attribute[n]);
            return reader.vertex_values().value(vertices, v, attribute);
        });
    };
    for (const VertexIndex v : cache.simplex(h).vertex)
        if (cache.point(v) == p) {
            add_vertex(v, 1);
            return true;
        }
    if (!sibson_.find(cache, h, p, reader.has_soft_lines())) return weigh_corners(reader, what, p);
    for (std::size_t i = 0; i < sibson_.count(); ++i)
        add_vertex(sibson_.vertex(i), sibson_.weight(i));
    return true;
}

template <int D>
bool Interpolation<D>::weigh_nearest(Reader<D> &reader, const abacus_interpolation &what,
                                     const Point<D> &p) {
    bool is_found = false;
    Nearest<D>(reader).find(p, 1, [&](const std::uint64_t *record) {
        const double *attributes = record_attributes<D>(record);
        add(what, record_id(record), 1,
            [&](std::uint32_t n) { return attributes[what.attribute[n]]; });
        is_found = true;
    });
    return is_found;
}

template <int D>
bool Interpolation<D>::weigh(Reader<D> &reader, const abacus_interpolation &what,
                             const Point<D> &p) {
    weights_.clear();
    values_.clear();
    abacus_simplex simplex;
    bool is_inside = false;
    switch (what.method) {
    case ABACUS_LINEAR:
        is_inside = weigh_corners(reader, what, p);
        break;
    case ABACUS_NATURAL:
        is_inside = weigh_natural(reader, what, p);
        break;
    case ABACUS_NEAREST:
        is_inside = what.outside == ABACUS_OUTSIDE_NOTHING &&
                    reader.locate(p, simplex, nullptr, what.extent) &&
                    weigh_nearest(reader, what, p);
        break;
    }
    return is_inside || (what.outside == ABACUS_OUTSIDE_NEAREST && weigh_nearest(reader, what, p));
}

template <int D>
bool Interpolation<D>::values(Reader<D> &reader, const abacus_interpolation &what,
                              const Point<D> &p, double *values) {
    if (!weigh(reader, what, p)) return false;
    for (std::uint32_t n = 0; n < what.attributes; ++n)
        values[n] = weighted_mean(
            weights_.size(), [&](std::size_t i) { return weights_[i].weight; },
            [&](std::size_t i) { return values_[i * what.attributes + n]; });
    return true;
}

template class Interpolation<2>;
template class Interpolation<3>;

} // namespace abacus
