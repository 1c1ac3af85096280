// From linked simplices to pages, and out of the cache (dissertation §4.5.2, §4.9).
//
// The walk that puts a block's simplices in the order of its page, or else a survey of the block,
// also lists its border and numbers its vertices. These lists serve to write the page and to untie
// the block. Its links to simplices that stay become visible facets. Links to blocks that leave
// with it need nothing. When all have left, border vertices that no cached simplex uses any more
// are freed; the other vertices went with their blocks.
//
// The contents of a page lie in cold memory (blocks/block_cache_evict.hpp): the vertices, and the
// simplices beyond the border. They are prefetched before the first is read.
#include "mesh/cache.hpp"

#include "host/processor_cache.hpp"
#include "host/stopwatch.hpp"

namespace abacus {

template <int D> void Cache<D>::untie(BlockIndex b) {
    ABACUS_ASSERT(border_.block == b);
    const Stopwatch stopwatch(counters.translation_ns);
    border_.hashes.resize(border_.facets.size());
    for (std::size_t i = 0; i < border_.facets.size(); ++i) {
        const Link link =
            slots_[link_simplex(border_.facets[i])].link[link_facet(border_.facets[i])];
        if (is_absent(link))
            visible_.prefetch_entry(visible_facet(link));
        else if (blocks_[block_of(link_simplex(link))].leaving)
            continue;
        border_.hashes[i] = hash(border_.facets[i]);
        visible_.prefetch(border_.hashes[i]);
    }
    for (std::size_t i = 0; i < border_.facets.size(); ++i) {
        const Handle h = link_simplex(border_.facets[i]);
        const Link link = slots_[h].link[link_facet(border_.facets[i])];
        if (is_absent(link)) {
            visible_.remove(visible_facet(link));
            continue;
        }
        const Handle neighbour = link_simplex(link);
        if (blocks_[block_of(neighbour)].leaving) continue;
        const Simplex<D> &s = slots_[h];
        const Key key{code(s), blocks_[b].has_parts() ? part(s) : 0};
        slots_[neighbour].link[link_facet(link)] =
            absent_link(visible_.add(border_.hashes[i], key, link));
    }
    for_each_record(b, [&](Handle h) {
        for (const VertexIndex v : slots_[h].vertex) vertices_.release(v);
        forget_fixed(h);
    });
    // All simplices of a vertex off the border are in this block.
    for (std::size_t n = 0; n < border_.vertices.size(); ++n) {
        const VertexIndex v = border_.vertices[n];
        if (border_.has_vertex[n])
            left_.push_back(v);
        else if (vertices_.in_use(v))
            throw_corrupted("A vertex has two separate stars.");
        else
            vertices_.destroy(v);
    }
}

template <int D> void Cache<D>::end_eviction() {
    const Stopwatch stopwatch(counters.translation_ns);
    for (const VertexIndex v : left_)
        if (vertices_.in_use(v)) vertices_.prefetch_slot(point(v));
    border_.vertices.clear();
    for (const VertexIndex v : left_) {
        if (border_.vertices.contains(vertices_, v)) continue; // on the border of several blocks
        border_.vertices.number(vertices_, v);
        if (vertices_.in_use(v))
            vertices_.share(v);
        else
            vertices_.destroy(v);
    }
}

template <int D> Key Cache<D>::key_beyond(Handle h, int facet) const {
    const Link link = slots_[h].link[facet];
    if (is_absent(link)) return visible_[visible_facet(link)].beyond;
    const Handle neighbour = link_simplex(link);
    const Simplex<D> &s = slots_[neighbour];
    return {code(s), blocks_[block_of(neighbour)].has_parts() ? part(s) : 0};
}

template <int D> void Cache<D>::ask_for_contents(BlockIndex b) const {
    // Nearly every vertex is the first of some simplex.
    const Simplex<D> *const slots = &slots_[first_of(b)];
    for (std::uint32_t i = 0; i < blocks_[b].high_water; ++i)
        if (!slots[i].is_free()) touch(&vertices_[slots[i].vertex[0]]);
}

template <int D> void Cache<D>::survey(BlockIndex b) {
    const Handle first = first_of(b);
    border_.block = b;
    border_.vertices.clear();
    border_.facets.clear();
    for_each_record(b, [&](Handle h) {
        const Simplex<D> &s = slots_[h];
        for (int i = 0; i <= D; ++i) {
            if (s.vertex[i] != infinite_vertex) border_.vertices.number(vertices_, s.vertex[i]);
            // An absent link is far above the handles of any block.
            if (link_simplex(s.link[i]) - first >= block_slots<D>)
                border_.facets.push_back(make_link(h, i));
        }
    });
    mark_border();
}

/// Marks the vertices on the border, and prefetches the simplices beyond it.
template <int D> void Cache<D>::mark_border() {
    border_.has_vertex.resize(border_.vertices.size());
    std::fill(border_.has_vertex.begin(), border_.has_vertex.end(), false);
    for (const Link inner : border_.facets) {
        const Simplex<D> &s = slots_[link_simplex(inner)];
        const Link outer = s.link[link_facet(inner)];
        if (is_absent(outer))
            visible_.prefetch_entry(visible_facet(outer));
        else
            touch(&slots_[link_simplex(outer)]);
        for (int i = 0; i <= D; ++i)
            if (i != link_facet(inner) && s.vertex[i] != infinite_vertex)
                border_.has_vertex[vertices_[s.vertex[i]].number] = true;
    }
}

template <int D> EncodedPage Cache<D>::encode_page(BlockIndex b) {
    const Handle first = first_of(b);
    border_.block = b;
    writer_.order(&slots_[first], blocks_[b].high_water, first, vertices_, border_.vertices,
                  border_.facets, fixed_of(first));
    mark_border();
    // The opposite vertex is the neighbour's only one that is not on the facet.
    for (const Link inner : border_.facets) {
        const Link outer = slots_[link_simplex(inner)].link[link_facet(inner)];
        if (!is_absent(outer))
            touch(&vertices_[slots_[link_simplex(outer)].vertex[link_facet(outer)]]);
    }
    for (std::size_t n = 0; n < border_.vertices.size(); ++n)
        vertices_.prefetch_id(border_.vertices[n]);
    for (std::size_t i = 0; i < border_.facets.size(); ++i) {
        Key beyond = key_beyond(link_simplex(border_.facets[i]), link_facet(border_.facets[i]));
        if (beyond.part == unknown_part) beyond.part = 0;
        writer_.set_link(i, beyond);
    }
    const bool fits = writer_.finish(blocks_[b].lower, blocks_[b].upper, vertices_,
                                     border_.vertices, border_.has_vertex.data());
    return {writer_.bytes(), writer_.size(), fits};
}

} // namespace abacus
