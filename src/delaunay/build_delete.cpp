// Taking points away.
#include "delaunay/build.hpp"

#include "staging/vertex_page.hpp"

namespace abacus {

template <int D> bool Build<D>::erase(const Point<D> &p, std::int64_t id, bool by_id) {
    Removal<D> &removal = core_->removal;
    if (header_->duplicates > 0 && repeated_->contains(p)) {
        const auto vertex = removal.id_at(p);
        if (!vertex) throw_corrupted("A repeated point equals no vertex of the mesh.");
        if (*vertex == id || !repeated_->take(p, id)) {
            if (*vertex != id && by_id) return false;
            // the next point takes over
            const std::uint64_t *next = repeated_->take_first(p);
            removal.rename(p, record_id(next), record_attributes<D>(next));
        }
        --header_->duplicates;
        return true;
    }
    switch (by_id ? removal.remove(p, id) : removal.remove(p)) {
    case Removed::no_such_vertex: return false;
    case Removed::removed: --header_->vertices; break;
    case Removed::collapses: collapse(); break;
    }
    return true;
}

template <int D> void Build<D>::collapse() {
    // Of equal points the vertex comes first, as it did.
    VertexPageWriter pages(host_, D, attributes_, header_->staged);
    std::uint64_t record[record_words(D, ABACUS_MAX_ATTRIBUTES)];
    core_->removal.each_neighbour([&](VertexIndex v) {
        const VertexHeap<D> &vertices = core_->cache.vertices();
        fill_record<D>(record, vertices.id(v), vertices.point(v), vertices.attributes(v),
                       attributes_);
        pages.add(record);
    });
    repeated_->flush();
    RepeatedReader<D> repeated(host_, domain_, attributes_, true);
    while (repeated.advance()) pages.add(repeated.record());
    repeated_->forget();
    pages.finish();
    header_->staged = pages.next();
    forget_simplices();
}

template <int D> void Build<D>::erase_pages(abacus_page_kind kind) {
    abacus_page page;
    for (bool more = host_.next(kind, nullptr, page); more;
         more = host_.next(kind, &page.key, page)) {
        host_.erase(kind, page);
        host_.poll();
    }
}

template <int D> void Build<D>::forget_simplices() {
    erase_pages(ABACUS_SIMPLEX_PAGES);
    header_->vertices = header_->duplicates = header_->simplices = header_->ghosts = 0;
    const abacus_counters counters = core_->cache.counters;
    core_.emplace(host_, *header_, cache_bytes_);
    core_->cache.counters = counters;
}

template bool Build<2>::erase(const Point<2> &, std::int64_t, bool);
template bool Build<3>::erase(const Point<3> &, std::int64_t, bool);
template void Build<2>::erase_pages(abacus_page_kind);
template void Build<3>::erase_pages(abacus_page_kind);
template void Build<2>::forget_simplices();
template void Build<3>::forget_simplices();
template void Build<2>::collapse();
template void Build<3>::collapse();

} // namespace abacus
