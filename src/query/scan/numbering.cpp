#include "query/scan/numbering.hpp"

#include "query/pages/page_simplex.hpp"
#include "query/scan/vertex_names.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

namespace {

/// Calls add(page, vertex) for all vertices of all pages; add() returns room for the key.
template <int D, class Add>
void name_vertices(const Host &host, const abacus_facts &facts, Add add) {
    const VertexNames<D> names(facts);
    PageScan<D> pages(host, facts);
    Pacer pacer(host);
    std::uint64_t seen = 0; // simplices
    pacer.begin(ABACUS_PHASE_SCANNING, facts.census.simplices + facts.census.ghosts);
    while (pages.advance()) {
        const PageView<D> &page = pages.page();
        pacer.reached(seen += static_cast<std::uint64_t>(page.simplices()));
        for (int v = 0; v < page.vertices(); ++v) names.write(page, v, add(page, v));
    }
}

} // namespace

// All pages agree about a vertex, so any of its names will do.
template <int D>
NumberedVertices<D>::NumberedVertices(const Host &host, const abacus_facts &facts,
                                      std::size_t memory)
    : vertex_values_(host, facts), key_(VertexNames<D>(facts).words()),
      named_(host, 1 + D + 1 + static_cast<unsigned>(page_attributes(facts.columns)), key_, memory),
      left_(facts.census.vertices), current_(host), apart_(host) {
    named_.expect(static_cast<double>(facts.census.vertices)); // several pages name most vertices
    name_vertices<D>(host, facts, [&](const PageView<D> &page, int v) {
        std::uint64_t *const name = named_.add(), *rest = name + 1 + D;
        *rest++ = static_cast<std::uint64_t>(page.id(v)) ^ id_sign;
        if (!vertex_values_.are_elsewhere())
            vertex_values_.all(page, v, reinterpret_cast<double *>(rest));
        return name;
    });
    named_.finish();
    current_.resize(1 + D + 1 + static_cast<unsigned>(page_attributes(facts.columns)));
    if (vertex_values_.are_elsewhere()) apart_.resize(facts.columns.attributes);
    ahead_ = named_.next();
}

template <int D> bool NumberedVertices<D>::next(abacus_vertex &vertex) {
    if ((ahead_ == nullptr) != (left_ == 0)) throw_corrupted(other_vertex_count);
    if (ahead_ == nullptr) {
        named_.close();
        return false;
    }
    --left_;
    std::copy_n(ahead_, current_.size(), current_.data());
    do ahead_ = named_.next();
    while (ahead_ != nullptr && std::equal(ahead_, ahead_ + key_, current_.data()));

    vertex = {};
    for (int axis = 0; axis < D; ++axis) vertex.point[axis] = from_ordered(current_[1 + axis]);
    const std::uint64_t *const rest = current_.data() + 1 + D;
    vertex.id = vertex.vertex = static_cast<std::int64_t>(rest[0] ^ id_sign);
    vertex.attributes = reinterpret_cast<const double *>(rest + 1);
    if (vertex_values_.are_elsewhere()) {
        Point<D> p;
        std::copy_n(vertex.point, D, p.begin());
        vertex_values_.all_of(vertex.id, p, apart_.data());
        vertex.attributes = apart_.data();
    }
    return true;
}

template <int D>
NumberedSimplices<D>::NumberedSimplices(const Host &host, const abacus_facts &facts,
                                        std::size_t memory)
    : domain_(domain_of<D>(facts.form)), ranks_(host, VertexNames<D>(facts).words(), memory),
      pages_(host, facts), numbers_(host) {
    ranks_.expect(static_cast<double>(facts.census.vertices));
    name_vertices<D>(host, facts, [&](const PageView<D> &, int) { return ranks_.add(); });
    if (ranks_.finish() != facts.census.vertices) throw_corrupted(other_vertex_count);
}

template <int D> void NumberedSimplices<D>::enter_page() {
    in_page_ = true;
    at_ = 0;
    numbers_.resize(static_cast<std::size_t>(pages_.page().vertices()));
    for (std::uint64_t &number : numbers_) number = ranks_.next();
}

template <int D> bool NumberedSimplices<D>::next(abacus_simplex &simplex, std::uint64_t *numbers) {
    for (;;) {
        const PageView<D> &page = pages_.page();
        while (in_page_ && at_ < page.simplices()) {
            const int s = at_++;
            if (page.is_ghost(s)) continue;
            const auto &order = describe(page, s, domain_, simplex);
            for (int i = 0; i <= D; ++i) numbers[i] = numbers_[page.corner(s, order[i])];
            return true;
        }
        if (!pages_.advance()) {
            ranks_.close();
            return false;
        }
        enter_page();
    }
}

template class NumberedVertices<2>;
template class NumberedVertices<3>;
template class NumberedSimplices<2>;
template class NumberedSimplices<3>;

} // namespace abacus
