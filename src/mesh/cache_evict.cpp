// Eviction and storing: from linked simplices to pages (dissertation §4.5.2, §4.9).
//
// Blocks leave in batches, one after the other: each is surveyed, written if it has
// changed, and unlinked. Its links to simplices that stay become visible facets. Those
// to blocks of the same batch need nothing: what has left stays readable, for the keys
// in the pages of its neighbours, until the whole batch has left. Then the vertices on
// the borders that no cached simplex uses any more are freed; those off the borders went
// with their blocks.
//
// What leaves has not been used for long, so it is in no processor cache, and a page
// is made from some hundred places in memory: the vertices, and the simplices beyond
// its border. All of them are asked for before the first is read: the vertices while the
// block before is made a page, and its slots, which tell the vertices, while the one before
// that is.
#include "mesh/cache.hpp"

#include "host/processor_cache.hpp"
#include "host/stopwatch.hpp"

namespace abacus {

template <int D> void Cache<D>::shrink() {
    counters.peak_bytes = std::max<std::uint64_t>(counters.peak_bytes, bytes());
    Arena<BlockIndex> victims(host_);
    // The last two stay: the next operation starts in one of them.
    while (bytes() > replacement_.limit() && cached_blocks_ > 2) {
        replacement_.choose(blocks_, cached_blocks_, clock_, victims);
        evict(victims);
        // All may have gone up in their neighbours.
        counters.eviction_batches += !victims.empty();
    }
}

template <int D> void Cache<D>::evict(Arena<BlockIndex> &victims) {
    // In the order of the curve: each fills up from the next one.
    std::sort(victims.begin(), victims.end(),
              [&](BlockIndex a, BlockIndex b) { return blocks_[a].lower < blocks_[b].lower; });
    for (const BlockIndex b : victims) blocks_[b].leaving = true;
    for (std::size_t i = 0; i < victims.size(); ++i) {
        ask_ahead(victims, i + 1); // it fills up from the next one
        if (blocks_[victims[i]].state == Block::cached && !dissolve(victims[i]))
            fill_up(victims[i], true);
    }
    const auto is_gone = [&](BlockIndex b) { return blocks_[b].state != Block::cached; };
    victims.resize(static_cast<std::size_t>(
        std::remove_if(victims.begin(), victims.end(), is_gone) - victims.begin()));
    left_.clear();
    for (std::size_t i = 0; i < victims.size(); ++i) {
        const BlockIndex b = victims[i];
        ask_ahead(victims, i);
        if (blocks_[b].dirty) {
            while (!encode(b)) victims.push_back(halve(b)); // too many bytes, not too many slots
            store(b);
        } else {
            survey(b);
        }
        unlink(b);
    }
    const Stopwatch stopwatch(counters.translation_ns);
    for (const VertexIndex v : left_)
        if (vertices_.in_use(v)) vertices_.prefetch_slot(point(v));
    numbered_.clear();
    for (const VertexIndex v : left_) {
        if (numbered_.contains(vertices_, v)) continue; // on the border of several
        numbered_.number(vertices_, v);
        if (vertices_.in_use(v))
            vertices_.share(v);
        else
            vertices_.destroy(v);
    }
    for (const BlockIndex b : victims) {
        directory_.erase(blocks_[b].lower);
        free_block(b);
        ++counters.evictions;
    }
}

template <int D> void Cache<D>::unlink(BlockIndex b) {
    const Stopwatch stopwatch(counters.translation_ns);
    hashes_.resize(border_.size());
    for (std::size_t i = 0; i < border_.size(); ++i) {
        const Link link = slots_[link_simplex(border_[i])].link[link_facet(border_[i])];
        if (is_absent(link))
            visible_.prefetch_entry(link & ~absent);
        else if (blocks_[block_of<D>(link_simplex(link))].leaving)
            continue;
        hashes_[i] = hash(border_[i]);
        visible_.prefetch(hashes_[i]);
    }
    for (std::size_t i = 0; i < border_.size(); ++i) {
        const Handle h = link_simplex(border_[i]);
        const Link link = slots_[h].link[link_facet(border_[i])];
        if (is_absent(link)) {
            visible_.remove(link & ~absent);
            continue;
        }
        const Handle neighbour = link_simplex(link);
        if (blocks_[block_of<D>(neighbour)].leaving) continue;
        const Simplex<D> &s = slots_[h];
        const Key key{code(s), blocks_[b].has_parts() ? part(s) : 0};
        slots_[neighbour].link[link_facet(link)] = absent | visible_.add(hashes_[i], key, link);
    }
    for_each_simplex(b, [&](Handle h) {
        for (const VertexIndex v : slots_[h].vertex) vertices_.release(v);
    });
    // A vertex off the border has no other simplices than these.
    for (std::size_t n = 0; n < numbered_.size(); ++n) {
        const VertexIndex v = numbered_[n];
        if (on_border_[n])
            left_.push_back(v);
        else if (vertices_.in_use(v))
            throw_corrupted("A vertex has two separate stars.");
        else
            vertices_.destroy(v);
    }
}

template <int D> void Cache<D>::flush() {
    counters.peak_bytes = std::max<std::uint64_t>(counters.peak_bytes, bytes());
    for (Key key = first_key;;) {
        const BlockIndex b =
            directory_.contains(key) ? directory_.floor(key) : directory_.after(key);
        if (b == no_block) break;
        key = blocks_[b].lower;
        host_.poll();
        if (dissolve(b)) continue; // perhaps into the next one, under the same key
        fill_up(b, false);
        key = blocks_[b].upper;
    }
    Arena<BlockIndex> changed(host_);
    for (BlockIndex b = 0; b < blocks_.size(); ++b)
        if (blocks_[b].state == Block::cached && blocks_[b].dirty) changed.push_back(b);
    for (std::size_t i = 0; i < changed.size(); ++i) {
        ask_ahead(changed, i);
        while (!encode(changed[i])) changed.push_back(halve(changed[i]));
        store(changed[i]);
        host_.poll();
    }
}

template <int D> Key Cache<D>::key_beyond(Handle h, int facet) const {
    const Link link = slots_[h].link[facet];
    if (is_absent(link)) return visible_[link & ~absent].beyond;
    const Handle neighbour = link_simplex(link);
    const Simplex<D> &s = slots_[neighbour];
    return {code(s), blocks_[block_of<D>(neighbour)].has_parts() ? part(s) : 0};
}

template <int D> void Cache<D>::ask_for_vertices(BlockIndex b) const {
    // Nearly every vertex is the first of some simplex.
    const Simplex<D> *const slots = &slots_[b * block_slots<D>];
    for (std::uint32_t i = 0; i < blocks_[b].high_water; ++i)
        if (!slots[i].is_free()) touch(&vertices_[slots[i].vertex[0]]);
}

template <int D> void Cache<D>::ask_ahead(const Arena<BlockIndex> &blocks, std::size_t at) const {
    if (at + 1 < blocks.size() && blocks_[blocks[at + 1]].state == Block::cached)
        ask_for_vertices(blocks[at + 1]);
    if (at + 2 < blocks.size()) ask_for_slots(blocks[at + 2]);
}

template <int D> void Cache<D>::survey(BlockIndex b) {
    const Handle first = b * block_slots<D>;
    numbered_.clear();
    border_.clear();
    for_each_simplex(b, [&](Handle h) {
        const Simplex<D> &s = slots_[h];
        for (int i = 0; i <= D; ++i) {
            if (s.vertex[i] != infinite_vertex) numbered_.number(vertices_, s.vertex[i]);
            // An absent link is far above the handles of any block.
            if (link_simplex(s.link[i]) - first >= block_slots<D>)
                border_.push_back(make_link(h, i));
        }
    });
    mark_border();
}

/// Of the vertices numbered, and asks for the simplices beyond.
template <int D> void Cache<D>::mark_border() {
    on_border_.resize(numbered_.size());
    std::fill(on_border_.begin(), on_border_.end(), false);
    for (const Link inner : border_) {
        const Simplex<D> &s = slots_[link_simplex(inner)];
        const Link outer = s.link[link_facet(inner)];
        if (is_absent(outer))
            visible_.prefetch_entry(outer & ~absent);
        else
            touch(&slots_[link_simplex(outer)]);
        for (int i = 0; i <= D; ++i)
            if (i != link_facet(inner) && s.vertex[i] != infinite_vertex)
                on_border_[vertices_[s.vertex[i]].number] = true;
    }
}

template <int D> bool Cache<D>::encode(BlockIndex b) {
    const Stopwatch stopwatch(counters.translation_ns);
    const Handle first = b * block_slots<D>;
    writer_.order(&slots_[first], blocks_[b].high_water, first, vertices_, numbered_, border_);
    mark_border();
    // The opposite vertex is all of the neighbour that is not the facet's.
    for (const Link inner : border_) {
        const Link outer = slots_[link_simplex(inner)].link[link_facet(inner)];
        if (!is_absent(outer))
            touch(&vertices_[slots_[link_simplex(outer)].vertex[link_facet(outer)]]);
    }
    for (std::size_t n = 0; n < numbered_.size(); ++n) vertices_.prefetch_id(numbered_[n]);
    for (std::size_t i = 0; i < border_.size(); ++i) {
        Key beyond = key_beyond(link_simplex(border_[i]), link_facet(border_[i]));
        if (beyond.part == unknown_part) beyond.part = 0;
        writer_.set_link(i, beyond);
    }
    const bool fits =
        writer_.finish(blocks_[b].lower, blocks_[b].upper, vertices_, numbered_, on_border_.data());
    if (writer_.size() != 0)
        blocks_[b].capacity = capacity_.learn(blocks_[b].count, writer_.size());
    return fits;
}

template <int D> void Cache<D>::store(BlockIndex b) {
    const Stopwatch stopwatch(counters.translation_ns);
    Block &block = blocks_[b];
    abacus_page page{block.lower, writer_.bytes(), writer_.size(), block.location};
    ++counters.stores;
    if (block.location != 0) ++counters.rewrites;
    counters.bytes_written += writer_.size();
    host_.put(ABACUS_SIMPLEX_PAGES, page);
    block.location = page.location;
    block.dirty = false;
}

template class Cache<2>;
template class Cache<3>;

} // namespace abacus
