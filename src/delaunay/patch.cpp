#include "delaunay/patch.hpp"

#include <algorithm>

namespace abacus {

Patch::Patch(Delaunay<2> &mesh)
    : Pieces(mesh.cache()), mesh_(mesh), outer_(cache_.host()), pairs_(cache_.host()),
      created_(cache_.host()) {}

void Patch::begin() {
    clear();
    outer_.clear();
    pairs_.clear();
}

Patch::Side Patch::outside(Link edge) {
    outer_.push_back(edge);
    return Pieces::outside(edge == unset ? Fixed::no : cache_.fixed(edge));
}

std::array<Patch::Side, 2> Patch::inside(Fixed how) {
    const Side a = outside(unset), b = outside(unset);
    pairs_.push_back({{a, b}, how});
    return {a, b};
}

void Patch::join_pairs() {
    if (pairs_.empty()) return;
    Arena<Side> holders(cache_.host()); // of what is outside
    holders.resize(outer_.size());
    std::fill(holders.begin(), holders.end(), unknown);
    const Pieces &pieces = *this;
    for (std::size_t n = 0; n < size(); ++n)
        for (int i = 0; i < 3; ++i)
            if (is_outside(pieces[n].beyond[i])) holders[number(pieces[n].beyond[i])] = side(n, i);
    for (const Pair &pair : pairs_) {
        const Side a = holders[number(pair.side[0])], b = holders[number(pair.side[1])];
        if (a == unknown || b == unknown) throw_no_triangulation();
        join(a, b, pair.how);
    }
}

std::size_t Patch::finish() {
    join_pairs();
    improve();
    create_all();
    return size();
}

void Patch::create_all() {
    mesh_.forget();
    created_.clear();
    std::int64_t ghosts = 0;
    const Pieces &pieces = *this;
    for (std::size_t n = 0; n < size(); ++n) {
        bring_infinity_last(n);
        ghosts += pieces[n].vertex[2] == infinite_vertex;
        const Handle h = cache_.create(pieces[n].vertex);
        cache_.set_fixed(h, pieces[n].fixed);
        mesh_.remember(created_.size(), h);
        if (mesh_.log != nullptr) mesh_.log->come(cache_, h);
        created_.push_back(h);
        if (created_.size() % 4096 == 0) cache_.poll();
    }
    for (std::size_t n = 0; n < size(); ++n)
        for (int i = 0; i < 3; ++i) {
            const Side beyond = pieces[n].beyond[i];
            const Link here = make_link(created_[n], i);
            if (is_outside(beyond)) {
                cache_.connect(here, outer_[number(beyond)]);
                cache_.mark_dirty(link_simplex(outer_[number(beyond)]));
            } else {
                cache_.point_at(here, make_link(created_[piece_of(beyond)], facet_of(beyond)));
            }
        }
    mesh_.count(static_cast<std::int64_t>(size()) - ghosts, ghosts);
}

} // namespace abacus
