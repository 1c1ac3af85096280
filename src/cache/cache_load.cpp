// Misses and loading: from stored pages to linked simplices (dissertation §4.10).
//
// A page's vertices get their numbers first: those on its border may be cached
// already and are looked up by coordinates, the others are new. Facets inside the
// page find their partners in a small hash table of local numbers; facets on the
// border look for their partner among the visible facets, or become visible
// themselves. So the large hash tables are asked once for each border vertex and
// border facet, never for each simplex.
#include "cache/cache.hpp"

#include "cache/stopwatch.hpp"

namespace abacus {

namespace {

constexpr Link unset = 0xffffffffu;
constexpr std::size_t facet_table_size = 4096; // more than twice the facets of a page

// Place of a vertex in the page that is being loaded.
constexpr std::uint32_t inner = 0, on_border = 1;

} // namespace

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
    if (!host_.find(key, page)) return no_block;
    const BlockIndex b = load(page);
    if (!blocks_[b].owns(key)) throw_corrupted("No page owns a part of the curve.");
    return b;
}

template <int D> typename Cache<D>::BlockIndex Cache<D>::load(const abacus_page &page) {
    ++counters.loads;
    counters.bytes_read += page.size;
    const auto view = PageView<D>::parse(page.bytes, page.size, vertices_.attribute_count());
    if (!(view.lower() == page.key)) throw_corrupted("A page is stored under another page's key.");
    const auto after = directory_.lower_bound(view.lower());
    if ((after != directory_.end() && after->first < view.upper()) ||
        (after != directory_.begin() && view.lower() < blocks_[std::prev(after)->second].upper))
        throw_corrupted("Two pages own the same part of the curve.");

    next_epoch();
    load_vertices(view);
    const BlockIndex b = new_block(Block::cached);
    Block &block = blocks_[b];
    block.own(view.lower(), view.upper());
    block.location = page.location;
    block.count = block.high_water = static_cast<std::uint32_t>(view.simplices());
    directory_.emplace(block.lower, b);

    const Handle first = b * block_slots<D>;
    corners_.resize(std::size_t(view.simplices()) * (D + 1));
    for (int s = 0; s < view.simplices(); ++s) {
        Simplex<D> &simplex = slots_[first + s];
        for (int i = 0; i <= D; ++i) {
            const auto corner = static_cast<std::uint32_t>(view.corner(s, i));
            corners_[s * (D + 1) + i] = corner;
            simplex.vertex[i] =
                corner < numbered_.size() ? numbered_[corner] : infinite_vertex;
            simplex.link[i] = unset;
            vertices_.acquire(simplex.vertex[i]);
        }
    }
    for (const VertexIndex v : numbered_)
        if (!vertices_.in_use(v)) throw_corrupted("A page has a vertex without simplices.");
    link_inside(view.simplices(), first);
    link_outside(view, first);
    return b;
}

template <int D> void Cache<D>::next_epoch() {
    const std::size_t known = local_.size();
    local_.resize(std::max(known, vertices_.end()));
    std::fill(local_.begin() + known, local_.end(), LocalNumber{});
    if (facets_.empty()) {
        facets_.resize(facet_table_size);
        std::fill(facets_.begin(), facets_.end(), LocalFacet{});
    }
    if (++epoch_ == 0) { // once in four billion pages
        std::fill(local_.begin(), local_.end(), LocalNumber{});
        std::fill(facets_.begin(), facets_.end(), LocalFacet{});
        epoch_ = 1;
    }
}

template <int D> void Cache<D>::load_vertices(const PageView<D> &view) {
    numbered_.resize(view.vertices());
    for (int n = 0; n < view.vertices(); ++n) {
        const Point<D> p = view.point(n);
        VertexIndex v = infinite_vertex;
        if (n < view.border_vertices()) v = vertices_.find_shared(p);
        if (v == infinite_vertex) {
            v = vertices_.create(p, domain_.cell(p), view.id(n), view.attributes(n));
            if (n < view.border_vertices()) vertices_.share(v);
            if (v >= local_.size()) {
                const std::size_t known = local_.size();
                local_.resize(v + 1);
                std::fill(local_.begin() + known, local_.end(), LocalNumber{});
            }
        } else if (local_[v].epoch == epoch_) {
            throw_corrupted("A page has the same vertex twice.");
        } else if (vertices_.id(v) != view.id(n)) {
            throw_corrupted("Two pages have different ids for one vertex.");
        } else if (view.attributes() > 0 &&
                   std::memcmp(vertices_.attributes(v), view.attributes(n),
                               view.attributes() * sizeof(double)) != 0) {
            throw_corrupted("Two pages have different attributes for one vertex.");
        }
        local_[v] = {epoch_, inner};
        numbered_[n] = v;
    }
}

template <int D> void Cache<D>::link_inside(int simplices, Handle first) {
    for (int s = 0; s < simplices; ++s) {
        for (int i = 0; i <= D; ++i) {
            const FacetVertices<D, std::uint32_t> facet(&corners_[s * (D + 1)], i);
            std::uint64_t vertices = 0;
            for (const std::uint32_t v : facet.vertex) vertices = vertices << 16 | v;
            const Link link = make_link(first + s, i);
            std::size_t at = (vertices * 0x9e3779b97f4a7c15ull) >> 52;
            while (facets_[at].epoch == epoch_ && facets_[at].vertices != vertices)
                at = (at + 1) % facet_table_size;
            LocalFacet &entry = facets_[at];
            if (entry.epoch != epoch_) {
                entry = {vertices, epoch_, link, facet.odd};
            } else {
                if (entry.link == unset) throw_corrupted("Three simplices share a facet.");
                if (entry.odd == facet.odd)
                    throw_corrupted("Neighbours have different orientations.");
                connect(entry.link, link);
                entry.link = unset;
            }
        }
    }
}

template <int D> void Cache<D>::link_outside(const PageView<D> &view, Handle first) {
    int links = 0, border_vertices = 0;
    for (int s = 0; s < view.simplices(); ++s) {
        for (int i = 0; i <= D; ++i) {
            const Handle h = first + s;
            if (slots_[h].link[i] != unset) continue;
            for (int j = 0; j <= D; ++j) {
                const std::uint32_t n = corners_[s * (D + 1) + j];
                if (j == i || n >= numbered_.size()) continue;
                if (static_cast<int>(n) >= view.border_vertices())
                    throw_corrupted("A page counts a vertex on its border as an inner one.");
                std::uint32_t &place = local_[numbered_[n]].number;
                border_vertices += place == inner;
                place = on_border;
            }
            if (links == view.links()) throw_corrupted("A page has too few links.");
            const Key beyond = view.link(links++);
            if ((beyond.code >= key_word_end && beyond.code != unknown_code) ||
                (beyond.part >= key_word_end && beyond.part != unknown_part))
                throw_corrupted("A page has a link to an impossible key.");
            const auto outer = this->facet(h, i);
            const std::uint32_t number = visible_.find(outer, [&](Link owner) {
                return this->facet(link_simplex(owner), link_facet(owner)).vertex == outer.vertex;
            });
            const Link link = make_link(h, i);
            if (number == VisibleFacets<D>::none) {
                slots_[h].link[i] = absent | visible_.add(outer, beyond, link);
                continue;
            }
            const Link owner = visible_[number].owner;
            if (this->facet(link_simplex(owner), link_facet(owner)).odd == outer.odd)
                throw_corrupted("Neighbours have different orientations.");
            if (options_.verify_links && !(leads_to(visible_[number].beyond, h) &&
                                           leads_to(beyond, link_simplex(owner))))
                throw_corrupted("A link has the key of another simplex than its neighbour.");
            visible_.remove(number);
            connect(owner, link);
        }
    }
    if (links != view.links()) throw_corrupted("A page has too many links.");
    if (border_vertices != view.border_vertices())
        throw_corrupted("A page counts an inner vertex as one on its border.");
}

template <int D> bool Cache<D>::leads_to(const Key &link, Handle h) const {
    if (link.code != code(slots_[h])) return false;
    // A part of 0 may stand for any: there was none when the link was stored.
    return link.part == unknown_part || link.part == 0 || link.part == part(slots_[h]);
}

template class Cache<2>;
template class Cache<3>;

} // namespace abacus
