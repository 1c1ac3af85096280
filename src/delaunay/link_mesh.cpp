#include "delaunay/link_mesh.hpp"

#include "staging/rounds.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

template <int D>
Domain<D> LinkMesh<D>::domain(const Cache<D> &cache, const Arena<VertexIndex> &link) {
    Point<D> lower, upper;
    lower.fill(std::numeric_limits<double>::infinity());
    upper.fill(-std::numeric_limits<double>::infinity());
    for (const VertexIndex v : link) {
        if (v == infinite_vertex) continue;
        for (int i = 0; i < D; ++i) {
            lower[i] = std::min(lower[i], cache.point(v)[i]);
            upper[i] = std::max(upper[i], cache.point(v)[i]);
        }
    }
    return {lower, upper};
}

template <int D> VertexIndex LinkMesh<D>::create(const Cache<D> &cache, VertexIndex v) {
    return own_.create_vertex(cache.point(v), static_cast<std::int64_t>(v), nullptr);
}

template <int D>
LinkMesh<D>::LinkMesh(const Cache<D> &cache, const Arena<VertexIndex> &link,
                      const Vertices &independent)
    : host_(cache.host()), own_(host_, domain(cache, link), 0,
                                CacheOptions{.budget = std::numeric_limits<std::size_t>::max()}),
      mesh_(host_, own_, 0, 0), insertion_(mesh_), inside_(host_) {
    struct Place {
        unsigned round;
        VertexIndex vertex;
        std::uint64_t code;
    };
    Arena<Place> order(host_);
    const Rounds<D> rounds(link.size());
    for (const VertexIndex v : link) {
        if (v == infinite_vertex ||
            std::find(independent.begin(), independent.end(), v) != independent.end())
            continue;
        const Point<D> &p = cache.point(v);
        order.push_back({rounds.round(p), v, own_.domain().code(p)});
    }
    std::sort(order.begin(), order.end(), [](const Place &a, const Place &b) {
        return a.round != b.round ? a.round < b.round : a.code < b.code;
    });
    Vertices first;
    for (int i = 0; i <= D; ++i) first[i] = create(cache, independent[i]);
    insertion_.start(first);
    for (std::size_t n = 0; n < order.size(); ++n) {
        if (n % 256 == 0) host_.poll();
        const VertexIndex v = order[n].vertex;
        insertion_.insert(cache.point(v), static_cast<std::int64_t>(v), nullptr);
    }
}

template <int D> typename LinkMesh<D>::Vertices LinkMesh<D>::vertices(Handle h) const {
    const Simplex<D> &s = own_.simplex(h);
    Vertices result;
    for (int i = 0; i <= D; ++i)
        result[i] = s.vertex[i] == infinite_vertex
                        ? infinite_vertex
                        : static_cast<VertexIndex>(own_.vertices().id(s.vertex[i]));
    return result;
}

template <int D>
const Arena<typename LinkMesh<D>::Vertices> &LinkMesh<D>::inside(const OpenFacets<D> &rim) {
    // From the simplices that stand on the rim, all that are reached without crossing it.
    Arena<Handle> found(host_);
    const auto find = [&](Handle h) {
        if (mesh_.marks.get(h) == Marks::inside) return;
        mesh_.marks.set(h, Marks::inside);
        found.push_back(h);
    };
    const auto on_rim = [&](const Vertices &vertices, int i) {
        return rim.find(FacetVertices<D, VertexIndex>(vertices, i)) != nullptr;
    };
    for (Key key = first_key; key < end_key;) {
        host_.poll();
        key = own_.visit(key, [&](Handle h) {
            const Vertices vertices = this->vertices(h);
            for (int i = 0; i <= D; ++i)
                if (on_rim(vertices, i)) find(h);
        });
    }
    for (std::size_t n = 0; n < found.size(); ++n) {
        if (n % 4096 == 0) host_.poll();
        const Vertices vertices = this->vertices(found[n]);
        for (int i = 0; i <= D; ++i)
            if (!on_rim(vertices, i)) find(link_simplex(own_.cross(found[n], i)));
        inside_.push_back(vertices);
    }
    return inside_;
}

template class LinkMesh<2>;
template class LinkMesh<3>;

} // namespace abacus
