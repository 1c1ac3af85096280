// Appending: pages of a mesh that comes in the order of keys, as in loading. Each page is put
// together as a block like any other, so that there is only one way to make a page.
#include "mesh/cache.hpp"

namespace abacus {

template <int D> VertexIndex Cache<D>::appended_vertex(const std::uint64_t *record) {
    if (record == nullptr) return infinite_vertex;
    Point<D> p;
    std::int64_t id;
    std::memcpy(p.data(), record + 1, sizeof p);
    std::memcpy(&id, record, sizeof id);
    VertexIndex v = vertices_.find_shared(p, id);
    if (v == infinite_vertex) {
        v = vertices_.create(p, domain_.code(p), id,
                             reinterpret_cast<const double *>(record + 1 + D));
        vertices_.share(v);
    }
    return v;
}

template <int D>
bool Cache<D>::append(const Key &lower, const Key &upper, const LooseSimplex<D> *simplices,
                      std::size_t n) {
    const BlockIndex b = this->begin_appended(lower, upper, n);
    const Handle first = first_of(b);
    for (std::size_t s = 0; s < n; ++s) {
        Simplex<D> &simplex = slots_[first + s];
        for (int i = 0; i <= D; ++i) {
            simplex.vertex[i] = appended_vertex(simplices[s].vertex[i]);
            vertices_.acquire(simplex.vertex[i]);
        }
    }
    for (std::size_t s = 0; s < n; ++s)
        for (int i = 0; i <= D; ++i) {
            const Link link = make_link(first + static_cast<std::uint32_t>(s), i);
            Simplex<D> &simplex = slots_[first + s];
            if (is_loose_ridge<D>(options_.linked_ghosts, simplex.is_ghost(), i))
                simplex.link[i] = link;
            else
                link_outside(link, hash(link), simplices[s].beyond[i]);
        }
    return this->end_appended(b);
}

} // namespace abacus
