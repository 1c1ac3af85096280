// Taking points away.
#include "delaunay/build.hpp"

#include "attributes/rewriting.hpp"
#include "delaunay/intake.hpp"
#include "keys/domain_of.hpp"
#include "points/vertex_page.hpp"
#include "traverse/own_vertices.hpp"

namespace abacus {

template <int D> std::uint64_t Build<D>::erase(const Point<D> &p, Leaving &leaving) {
    if (rest_ && rest_->has_left_out(p)) return 0;
    const bool is_repeated = facts_->census.duplicates > 0 && repeated_->contains(p);
    if (!is_repeated) return erase_vertex(p, &leaving);
    leaving.begin();
    const auto more = core_->removal.offer(p, leaving);
    if (!more) throw_corrupted("A repeated point equals no vertex of the mesh.");
    if (*more) repeated_->offer(p, leaving);
    leaving.decide();
    const std::uint64_t taken = repeated_->take(p, leaving);
    if (taken > facts_->census.duplicates)
        throw_corrupted("There are more repeated points than the header counts.");
    facts_->census.duplicates -= taken;
    return taken + (leaving.has_first() ? pass_on(p) : 0);
}

template <int D> void Build<D>::forget_repeated(const Point<D> &p) {
    const std::uint64_t taken = repeated_->take_all(p);
    if (taken > facts_->census.duplicates)
        throw_corrupted("There are more repeated points than the header counts.");
    facts_->census.duplicates -= taken;
}

template <int D> void Build<D>::rename(const Point<D> &p, const std::uint64_t *record) {
    core_->removal.rename(p, record_id(record), record_attributes<D>(record));
    if (apart_) apart_->put(p, domain_.code(p), record_attributes<D>(record));
}

template <int D> void Build<D>::read_vertex(VertexIndex v, std::uint64_t *record) {
    const VertexHeap<D> &vertices = core_->cache.vertices();
    const Vertex<D> &vertex = vertices[v];
    fill_record<D>(record, vertices.id(v), vertex.point, vertices.attributes(v),
                   static_cast<std::size_t>(vertices.attribute_count()));
    if (!apart_) return;
    std::array<double, ABACUS_MAX_ATTRIBUTES> values;
    apart_->get(vertex.point, vertex.code, values.data());
    fill_record<D>(record, vertices.id(v), vertex.point, values.data(), attributes_);
}

template <int D> std::uint64_t Build<D>::pass_on(const Point<D> &p) {
    const std::uint64_t *next = facts_->census.duplicates > 0 ? repeated_->take_first(p) : nullptr;
    if (next == nullptr) return erase_vertex(p);
    rename(p, next);
    --facts_->census.duplicates;
    return 1;
}

template <int D> std::uint64_t Build<D>::erase_vertex(const Point<D> &p, Leaving *want) {
    if (rest_) {
        if (!core_->removal.finds(p, want)) return 0;
        rest_->leave_out(p);
        return 1;
    }
    switch (core_->removal.remove(p, want)) {
    case Removed::no_such_vertex:
        return 0;
    case Removed::removed:
        --facts_->census.vertices;
        if (apart_) apart_->drop(p, domain_.code(p));
        break;
    case Removed::collapses:
        collapse();
        break;
    }
    return 1;
}

template <int D> void Build<D>::collapse() {
    // Of equal points the vertex comes first, as it did.
    VertexPageWriter pages(host_, D, attributes_, facts_->census.staged);
    std::uint64_t record[record_words(D, ABACUS_MAX_ATTRIBUTES)];
    core_->removal.each_neighbour([&](VertexIndex v) {
        read_vertex(v, record);
        pages.add(record);
    });
    make_repeated_wait(pages);
    forget_simplices();
}

template <int D> void Build<D>::make_repeated_wait(VertexPageWriter &pages) {
    repeated_->flush();
    RepeatedReader<D> repeated(host_, domain_, attributes_, true);
    while (repeated.advance()) pages.add(repeated.record());
    repeated_->forget();
    pages.finish();
    facts_->census.staged = pages.next();
    facts_->census.duplicates = 0;
}

template <int D> void Build<D>::put_off_removals(std::size_t memory) {
    rest_.emplace(host_, *facts_, memory);
}

template <int D> void Build<D>::triangulate_rest() {
    std::uint64_t record[record_words(D, ABACUS_MAX_ATTRIBUTES)];
    each_vertex(core_->cache, [&](VertexIndex v) {
        read_vertex(v, record);
        rest_->add(record);
    });
    const std::uint64_t repeated = facts_->census.duplicates, vertices = facts_->census.vertices;
    forget_simplices();
    facts_->census.duplicates = repeated; // their vertices come again, and their pages stay
    Intake intake(*this, vertices);
    rest_->emit(intake);
    rest_.reset();
    insert_waiting(0); // if they had to be staged after all
    if (has_simplices() || repeated == 0) return;
    VertexPageWriter pages(host_, D, attributes_, facts_->census.staged);
    make_repeated_wait(pages);
}

template <int D> void Build<D>::erase_pages(abacus_page_kind kind) {
    abacus_page page;
    for (bool more = host_.next(kind, nullptr, page); more;
         more = host_.next(kind, &page.key, page)) {
        host_.erase(kind, page);
        host_.poll();
    }
}

/// Their codes are those that they have from now on: the header may have another domain by now.
template <int D> void Build<D>::log_all_gone() {
    if (changes_ == nullptr || !has_simplices()) return;
    const Domain<D> domain = domain_of<D>(facts_->form);
    Cache<D> &cache = core_->cache;
    for (Key page = first_key; page < end_key;) {
        cache.trim();
        cache.poll();
        page = cache.visit(page, [&](Handle h) { changes_->log().go(cache, h, domain); });
    }
}

template <int D> void Build<D>::forget_simplices() {
    log_all_gone();
    erase_pages(ABACUS_SIMPLEX_PAGES);
    if (apart_) {
        apart_->forget();
        erase_attributes(host_, first_group<1>);
    }
    facts_->census.vertices = facts_->census.duplicates = facts_->census.simplices =
        facts_->census.ghosts = 0;
    forget_cache();
}

template std::uint64_t Build<2>::erase(const Point<2> &, Leaving &);
template std::uint64_t Build<3>::erase(const Point<3> &, Leaving &);
template void Build<2>::rename(const Point<2> &, const std::uint64_t *);
template void Build<3>::rename(const Point<3> &, const std::uint64_t *);
template void Build<2>::read_vertex(VertexIndex, std::uint64_t *);
template void Build<3>::read_vertex(VertexIndex, std::uint64_t *);
template void Build<2>::forget_repeated(const Point<2> &);
template void Build<3>::forget_repeated(const Point<3> &);
template void Build<2>::erase_pages(abacus_page_kind);
template void Build<3>::erase_pages(abacus_page_kind);
template void Build<2>::forget_simplices();
template void Build<3>::forget_simplices();
template void Build<2>::put_off_removals(std::size_t);
template void Build<3>::put_off_removals(std::size_t);
template void Build<2>::triangulate_rest();
template void Build<3>::triangulate_rest();

} // namespace abacus
