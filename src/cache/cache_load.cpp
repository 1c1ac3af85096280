// Misses and loading: from stored pages to linked simplices (dissertation §4.10).
//
// Half of the links inside a page are stored; the other facets find their partners in a
// small hash table of local numbers. What finds none is the page's border. Vertices
// there may be cached already and are looked up by coordinates, the others are new.
// Facets on the border look for their partner among the visible facets, or become
// visible themselves. So the large hash tables are asked once for each border vertex
// and border facet, never for each simplex.
#include "cache/cache.hpp"

#include "cache/stopwatch.hpp"

namespace abacus {

template <int D> Link Cache<D>::miss(Handle h, int facet) {
    ++counters.misses;
    host_.poll();
    const Key beyond = visible_[slots_[h].link[facet] & ~absent].beyond;
    const bool known = options_.stored_links && beyond.code != unknown_code;
    if (!known) probe(h, facet);
    else if (!follow_stored_link(h, facet, beyond))
        throw_corrupted("A link has a key under which its neighbour is not found.");
    return slots_[h].link[facet];
}

template <int D>
bool Cache<D>::follow_stored_link(Handle h, int facet, const Key &beyond) {
    if (beyond.part != unknown_part) {
        ++counters.link_probes;
        if (owner(beyond) == no_block) return false;
        if (present(h, facet)) return true;
    }
    // Several pages may share the code: from the last one back.
    for (Key key{beyond.code, key_word_end - 1};;) {
        ++counters.link_probes;
        const BlockIndex b = owner(key);
        if (b == no_block) return false;
        if (present(h, facet)) return true;
        if (blocks_[b].lower <= Key{beyond.code, 0}) return false;
        key = predecessor(blocks_[b].lower);
    }
}

template <int D> typename Cache<D>::BlockIndex Cache<D>::owner(const Key &key) {
    const BlockIndex cached = cached_owner(key);
    if (cached != no_block) return cached;
    const Stopwatch stopwatch(counters.translation_ns);
    abacus_page page{};
    if (!host_.find(ABACUS_SIMPLEX_PAGES, key, page)) return no_block;
    const BlockIndex b = load(page);
    if (!blocks_[b].owns(key)) throw_corrupted("No page owns a part of the curve.");
    return b;
}

template <int D> typename Cache<D>::BlockIndex Cache<D>::load(const abacus_page &page) {
    ++counters.loads;
    counters.bytes_read += page.size;
    view_.read(page.bytes, page.size, vertices_.attribute_count(),
               options_.verify_checksums ? PageView<D>::Checksum::verify
                                         : PageView<D>::Checksum::ignore);
    if (!(view_.lower() == page.key)) throw_corrupted("A page is stored under another page's key.");
    const BlockIndex before = directory_.floor(view_.lower());
    const BlockIndex after = directory_.after(view_.lower());
    if ((before != no_block && view_.lower() < blocks_[before].upper) ||
        (after != no_block && blocks_[after].lower < view_.upper()))
        throw_corrupted("Two pages own the same part of the curve.");

    const BlockIndex b = new_block(Block::cached);
    Block &block = blocks_[b];
    block.own(view_.lower(), view_.upper());
    block.location = page.location;
    block.count = block.high_water = static_cast<std::uint32_t>(view_.simplices());
    directory_.insert(block.lower, b);

    const Handle first = b * block_slots<D>;
    link_inside(first);
    load_vertices();
    load_simplices(first);
    link_outside();
    return b;
}

template <int D> void Cache<D>::link_inside(Handle first) {
    const int simplices = view_.simplices();
    std::size_t open = std::size_t(simplices) * (D + 1); // facets
    for (int s = 0; s < simplices; ++s) {
        slots_[first + s].link.fill(unset);
        if (view_.parent(s) == PageView<D>::no_link) continue;
        const Link parent = view_.parent(s);
        connect(make_link(first + link_simplex(parent), link_facet(parent)),
                make_link(first + s, view_.facet_to_parent(s)));
        open -= 2;
    }
    if (facets_.empty() || ++epoch_ == 0) { // at first, and once in four billion pages
        facets_.resize(std::bit_ceil(std::size_t(block_slots<D>) * (D + 1) + 1));
        std::fill(facets_.begin(), facets_.end(), LocalFacet{});
        epoch_ = 1;
    }
    // As small as can be: at most one entry a facet, fewer in a sound page.
    const std::size_t mask = std::bit_ceil(open + 1) - 1;
    const int shift = 64 - std::bit_width(mask);
    for (int s = 0; s < simplices; ++s) {
        for (int i = 0; i <= D; ++i) {
            if (slots_[first + s].link[i] != unset) continue;
            const Link link = make_link(first + s, i);
            if (is_loose(view_.corner(s, D) == view_.vertices(), i)) {
                slots_[first + s].link[i] = link;
                continue;
            }
            const FacetVertices<D, std::uint32_t> facet(view_.corners(s), i);
            std::uint64_t vertices = 0;
            for (const std::uint32_t v : facet.vertex) vertices = vertices << 16 | v;
            const Link odd = facet.odd ? absent : 0;
            std::size_t at = mask == 0 ? 0 : (vertices * 0x9e3779b97f4a7c15ull) >> shift;
            while (facets_[at].epoch == epoch_ && facets_[at].vertices != vertices)
                at = (at + 1) & mask;
            LocalFacet &entry = facets_[at];
            if (entry.epoch != epoch_) {
                entry = {vertices, epoch_, link | odd};
            } else {
                if (entry.link == unset) throw_corrupted("Three simplices share a facet.");
                if ((entry.link & absent) == odd)
                    throw_corrupted("Neighbours have different orientations.");
                connect(entry.link & ~absent, link);
                entry.link = unset;
            }
        }
    }
    border_.clear();
    on_border_.resize(static_cast<std::size_t>(view_.vertices()));
    std::fill(on_border_.begin(), on_border_.end(), false);
    for (int s = 0; s < simplices; ++s)
        for (int i = 0; i <= D; ++i) {
            if (slots_[first + s].link[i] != unset) continue;
            border_.push_back(make_link(first + s, i));
            for (int j = 0; j <= D; ++j)
                if (j != i && view_.corner(s, j) < view_.vertices())
                    on_border_[view_.corner(s, j)] = true;
        }
    if (static_cast<int>(border_.size()) != view_.links())
        throw_corrupted("A page has another number of links than of facets on its border.");
}

template <int D> void Cache<D>::load_vertices() {
    for (int n = 0; n < view_.vertices(); ++n)
        if (on_border_[n]) vertices_.prefetch_slot(view_.point(n));
    for (int n = 0; n < view_.vertices(); ++n)
        if (on_border_[n]) vertices_.prefetch_vertex(view_.point(n));
    numbered_.clear();
    for (int n = 0; n < view_.vertices(); ++n) {
        const Point<D> &p = view_.point(n);
        for (int i = 0; i < view_.attributes(); ++i) values_[i] = view_.attribute(n, i);
        VertexIndex v = on_border_[n] ? vertices_.find_shared(p) : infinite_vertex;
        if (v == infinite_vertex) {
            v = vertices_.create(p, domain_.code(p), view_.id(n), values_.data());
            if (on_border_[n]) vertices_.share(v);
        } else if (numbered_.contains(vertices_, v)) {
            throw_corrupted("A page has the same vertex twice.");
        } else if (vertices_.id(v) != view_.id(n)) {
            throw_corrupted("Two pages have different ids for one vertex.");
        } else if (view_.attributes() > 0 &&
                   std::memcmp(vertices_.attributes(v), values_.data(),
                               values_.size() * sizeof(double)) != 0) {
            throw_corrupted("Two pages have different attributes for one vertex.");
        }
        numbered_.number(vertices_, v);
    }
}

template <int D> void Cache<D>::load_simplices(Handle first) {
    uses_.resize(numbered_.size() + 1); // that of the point at infinity is the last
    std::fill(uses_.begin(), uses_.end(), 0);
    for (int s = 0; s < view_.simplices(); ++s)
        for (int i = 0; i <= D; ++i) {
            const auto corner = static_cast<std::size_t>(view_.corner(s, i));
            ++uses_[corner];
            slots_[first + s].vertex[i] =
                corner < numbered_.size() ? numbered_[corner] : infinite_vertex;
        }
    for (std::size_t n = 0; n < numbered_.size(); ++n) vertices_.acquire(numbered_[n], uses_[n]);
    vertices_.acquire(infinite_vertex, uses_[numbered_.size()]);
}

template <int D> void Cache<D>::link_outside() {
    const auto facet_of = [&](Link link) { return facet(link_simplex(link), link_facet(link)); };
    for (const Link link : border_) visible_.prefetch_bucket(facet_of(link));
    for (const Link link : border_) visible_.prefetch_entry(facet_of(link));
    for (std::size_t i = 0; i < border_.size(); ++i) {
        const int n = view_.link_vertex(static_cast<int>(i));
        const std::uint64_t code = n < view_.vertices() ? vertices_[numbered_[n]].code
                                                        : view_.foreign_code(n);
        link_outside(border_[i], {code, view_.link_part(static_cast<int>(i))});
    }
}

template <int D> void Cache<D>::link_outside(Link link, const Key &beyond) {
    if ((beyond.code >= key_word_end && beyond.code != unknown_code) ||
        (beyond.part >= key_word_end && beyond.part != unknown_part))
        throw_corrupted("A page has a link to an impossible key.");
    const Handle h = link_simplex(link);
    const auto outer = facet(h, link_facet(link));
    const std::uint32_t number = visible_.find(outer, [&](Link owner) {
        return facet(link_simplex(owner), link_facet(owner)).vertex == outer.vertex;
    });
    if (number == VisibleFacets<D>::none) {
        slots_[h].link[link_facet(link)] = absent | visible_.add(outer, beyond, link);
        return;
    }
    const Link owner = visible_[number].owner;
    if (facet(link_simplex(owner), link_facet(owner)).odd == outer.odd)
        throw_corrupted("Neighbours have different orientations.");
    if (options_.verify_links &&
        !(leads_to(visible_[number].beyond, h) && leads_to(beyond, link_simplex(owner))))
        throw_corrupted("A link has the key of another simplex than its neighbour.");
    visible_.remove(number);
    connect(owner, link);
}

template <int D> bool Cache<D>::leads_to(const Key &link, Handle h) const {
    if (link.code != code(slots_[h])) return false;
    // A part of 0 may stand for any: there was none when the link was stored.
    return link.part == unknown_part || link.part == 0 || link.part == part(slots_[h]);
}

template class Cache<2>;
template class Cache<3>;

} // namespace abacus
