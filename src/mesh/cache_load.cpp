// Misses and loading: from stored pages to linked simplices (dissertation §4.10).
//
// Inside a page, simplices are linked by local numbers (inner_links.hpp). Facets without a partner
// there are the page's border. Vertices on the border may be cached already and are looked up by
// coordinates; the others are new. Facets on the border look for their partner among the visible
// facets, or become visible themselves. So the large hash tables are used once for each border
// vertex and border facet, never for each simplex.
#include "mesh/cache.hpp"

#include <cstddef>
#include <limits>

namespace abacus {

template <int D> Link Cache<D>::miss(Handle h, int facet) {
    ++counters.misses;
    host_.poll();
    const Key beyond = visible_[visible_facet(slots_[h].link[facet])].beyond;
    const bool known = options_.stored_links && beyond.code != unknown_code;
    if (!known)
        probe(h, facet);
    else if (!follow_stored_link(h, facet, beyond))
        throw_corrupted("A link has a key under which its neighbour is not found.");
    return slots_[h].link[facet];
}

template <int D> bool Cache<D>::follow_stored_link(Handle h, int facet, const Key &beyond) {
    if (beyond.part != unknown_part) {
        ++counters.link_probes;
        if (owner(beyond) == no_block) return false;
        if (present(h, facet)) return true;
    }
    // Several pages may share the code: start with the last one.
    for (Key key{beyond.code, key_word_end - 1};;) {
        ++counters.link_probes;
        const BlockIndex b = owner(key);
        if (b == no_block) return false;
        if (present(h, facet)) return true;
        if (blocks_[b].lower <= Key{beyond.code, 0}) return false;
        key = predecessor(blocks_[b].lower);
    }
}

template <int D> PageContents Cache<D>::open_page(const abacus_page &page) {
    const bool is_outdated = has_former_attributes(page);
    view_.read(
        page.bytes, page.size, is_outdated ? options_.former.count : vertices_.attribute_count(),
        options_.verify_checksums ? PageView<D>::Checksum::verify : PageView<D>::Checksum::ignore);
    return {view_.lower(), view_.upper(), static_cast<std::uint32_t>(view_.simplices()),
            is_outdated};
}

template <int D> bool Cache<D>::has_former_attributes(const abacus_page &page) const {
    constexpr std::size_t at = offsetof(PageHeader, attributes);
    return options_.former.count >= 0 && page.size > at &&
           page.bytes[at] == options_.former.count &&
           options_.former.count != vertices_.attribute_count();
}

template <int D> void Cache<D>::read_attributes(int vertex) {
    const int count = vertices_.attribute_count();
    if (view_.attributes() == count) {
        for (int i = 0; i < count; ++i) values_[i] = view_.attribute(vertex, i);
        return;
    }
    for (int i = 0; i < count; ++i) {
        const std::uint32_t source = options_.former.source[i];
        values_[i] = source == no_attribute ? std::numeric_limits<double>::quiet_NaN()
                                            : view_.attribute(vertex, static_cast<int>(source));
    }
}

template <int D> void Cache<D>::tie(BlockIndex b) {
    const Handle first = first_of(b);
    border_.block = b;
    inner_links_.connect(view_, &slots_[first], first, options_.linked_ghosts, border_.facets,
                         border_.has_vertex);
    load_vertices();
    notes_[b] = run_of_vertices();
    load_simplices(first);
    load_fixed(first);
    link_outside();
}

template <int D> void Cache<D>::load_vertices() {
    for (int n = 0; n < view_.vertices(); ++n)
        if (border_.has_vertex[n]) vertices_.prefetch_slot(view_.point(n));
    for (int n = 0; n < view_.vertices(); ++n)
        if (border_.has_vertex[n]) vertices_.prefetch_vertex(view_.point(n));
    // In a loop of their own, as each is a chain of table look-ups.
    codes_.resize(static_cast<std::size_t>(view_.vertices()));
    for (int n = 0; n < view_.vertices(); ++n) codes_[n] = domain_.code(view_.point(n));
    border_.vertices.clear();
    for (int n = 0; n < view_.vertices(); ++n) {
        const Point<D> &p = view_.point(n);
        read_attributes(n);
        if (other_values_ != nullptr)
            blocks_[border_.block].dirty |= other_values_->give(p, view_.id(n), values_.data());
        VertexIndex v =
            border_.has_vertex[n] ? vertices_.find_shared(p, view_.id(n)) : infinite_vertex;
        if (v == infinite_vertex) {
            v = vertices_.create(p, codes_[n], view_.id(n), values_.data());
            if (border_.has_vertex[n]) vertices_.share(v);
        } else if (border_.vertices.contains(vertices_, v)) {
            throw_corrupted("A page has the same vertex twice.");
        } else if (vertices_.id(v) != view_.id(n)) {
            throw_corrupted("Two pages have different ids for one vertex.");
        } else if (!values_.empty() && std::memcmp(vertices_.attributes(v), values_.data(),
                                                   values_.size() * sizeof(double)) != 0) {
            throw_corrupted("Two pages have different attributes for one vertex.");
        }
        border_.vertices.number(vertices_, v);
    }
}

/// The run of the vertices that were made for the current page, for prefetching.
template <int D> VertexRun Cache<D>::run_of_vertices() const {
    VertexIndex least = free_mark, greatest{};
    for (std::size_t n = 0; n < border_.vertices.size(); ++n) {
        if (border_.has_vertex[n]) continue; // it may be of another page
        least = std::min(least, border_.vertices[n]);
        greatest = std::max(greatest, border_.vertices[n]);
    }
    if (least > greatest) return {};
    const std::size_t length = to_number(greatest) - to_number(least) + 1;
    return {least, static_cast<std::uint16_t>(std::min(length, 2 * border_.vertices.size()))};
}

template <int D> void Cache<D>::load_simplices(Handle first) {
    uses_.resize(border_.vertices.size() + 1); // the last is the point at infinity
    std::fill(uses_.begin(), uses_.end(), 0);
    for (int s = 0; s < view_.simplices(); ++s)
        for (int i = 0; i <= D; ++i) {
            const auto corner = static_cast<std::size_t>(view_.corner(s, i));
            ++uses_[corner];
            slots_[first + s].vertex[i] =
                corner < border_.vertices.size() ? border_.vertices[corner] : infinite_vertex;
        }
    for (std::size_t n = 0; n < border_.vertices.size(); ++n)
        vertices_.acquire(border_.vertices[n], uses_[n]);
    vertices_.acquire(infinite_vertex, uses_[border_.vertices.size()]);
}

/// Facets on the border are not linked yet.
template <int D> void Cache<D>::load_fixed(Handle first) {
    if (!view_.is_lined()) return;
    for (int s = 0; s < view_.simplices(); ++s) {
        const FixedFacets<D> facets = view_.fixed(s);
        if (!facets.is_sound()) throw_corrupted("An edge is soft that is not fixed.");
        if (view_.is_ghost(s) && facets.count() > (facets.is_fixed(D) ? 1 : 0))
            throw_corrupted("An edge at the point at infinity is fixed.");
        set_fixed(first + static_cast<std::uint32_t>(s), facets);
    }
    for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(view_.simplices()); ++s)
        for (int i = 0; i <= D; ++i)
            if (const Link link = slots_[first + s].link[i]; link != unset)
                check_fixed(make_link(first + s, i), link);
}

template <int D> void Cache<D>::link_outside() {
    // The data of other blocks lies in cold memory: table, entry, simplex.
    border_.hashes.resize(border_.facets.size());
    for (std::size_t i = 0; i < border_.facets.size(); ++i) {
        border_.hashes[i] = hash(border_.facets[i]);
        visible_.prefetch(border_.hashes[i]);
    }
    guesses_.resize(border_.facets.size());
    for (std::size_t i = 0; i < border_.facets.size(); ++i) {
        guesses_[i] = visible_.guess(border_.hashes[i]);
        if (guesses_[i] != VisibleFacets<D>::none) visible_.prefetch_entry(guesses_[i]);
    }
    for (const std::uint32_t guess : guesses_)
        if (guess != VisibleFacets<D>::none)
            __builtin_prefetch(&slots_[link_simplex(visible_[guess].owner)], 1);
    for (std::size_t i = 0; i < border_.facets.size(); ++i) {
        const int n = view_.link_vertex(static_cast<int>(i));
        const std::uint64_t code =
            n < view_.vertices() ? vertices_[border_.vertices[n]].code : view_.foreign_code(n);
        link_outside(border_.facets[i], border_.hashes[i],
                     {code, view_.link_part(static_cast<int>(i))});
    }
}

template <int D> void Cache<D>::link_outside(Link link, std::uint32_t hash, const Key &beyond) {
    if ((beyond.code >= key_word_end && beyond.code != unknown_code) ||
        (beyond.part >= key_word_end && beyond.part != unknown_part))
        throw_corrupted("A page has a link to an impossible key.");
    const Handle h = link_simplex(link);
    const auto outer = facet(link);
    const std::uint32_t number =
        visible_.find(hash, [&](Link owner) { return facet(owner).vertex == outer.vertex; });
    if (number == VisibleFacets<D>::none) {
        slots_[h].link[link_facet(link)] = absent_link(visible_.add(hash, beyond, link));
        return;
    }
    const Link owner = visible_[number].owner;
    if (facet(owner).odd == outer.odd) throw_corrupted("Neighbours have different orientations.");
    if (options_.verify_links &&
        !(leads_to(visible_[number].beyond, h) && leads_to(beyond, link_simplex(owner))))
        throw_corrupted("A link has the key of a simplex other than its neighbour.");
    visible_.remove(number);
    connect(owner, link);
    check_fixed(owner, link);
}

template <int D> bool Cache<D>::leads_to(const Key &link, Handle h) const {
    if (link.code != code(slots_[h])) return false;
    // A part of 0 may stand for any part: the code had no parts when the link was stored.
    return link.part == unknown_part || link.part == 0 || link.part == part(slots_[h]);
}

} // namespace abacus
