#include "shards/own_pages.hpp"

#include "mesh/page_attributes.hpp"

#include <abacus/standing.h>

#include <algorithm>

namespace abacus {

namespace {

constexpr Key end_of(std::uint64_t last) {
    return last >= key_word_end - 1 ? end_key : Key{last + 1, 0};
}

} // namespace

template <int D>
OwnPages<D>::OwnPages(const Host &host, const abacus_facts &facts, std::uint64_t first,
                      std::uint64_t last)
    : host_(host), facts_(facts), domain_(domain_of<D>(facts.form)),
      attributes_(page_attributes(facts.columns)), begin_{first, 0},
      end_(last < first ? begin_ : end_of(last)), next_(begin_), made_(host), making_(host, made_),
      maker_(making_, domain_, attributes_,
             CacheOptions{.linked_ghosts = abacus_links_ghosts(facts.standing) != 0}),
      links_(host), slots_(host), border_(host), on_border_(host), outside_(host), kept_(host),
      records_(host), loose_(host) {}

template <int D> void OwnPages<D>::seek(const Key &key) {
    made_.clear();
    next_ = key < begin_ ? begin_ : key;
}

template <int D> void OwnPages<D>::open(const Key &key, abacus_page &page) {
    constexpr const char *unowned = "No page owns a part of the curve.";
    host_.poll();
    if (!host_.find(ABACUS_SIMPLEX_PAGES, key, page)) throw_corrupted(unowned);
    view_.open(page.bytes, page.size, attributes_);
    if (!(view_.lower() <= key && key < view_.upper())) throw_corrupted(unowned);
}

template <int D> bool OwnPages<D>::next(abacus_page &page) {
    if (made_.next(page)) return true;
    made_.clear();
    if (!(next_ < end_)) return false;
    if (facts_.census.simplices == 0) {
        kept_.clear();
        make(begin_, end_, 0, 0);
        next_ = end_;
        return made_.next(page);
    }
    open(next_, page);
    next_ = view_.upper();
    if (begin_ <= view_.lower() && view_.upper() <= end_) {
        page.key = view_.lower();
        page.location = 0;
        return true;
    }
    cut(std::max(begin_, view_.lower(), [](const Key &a, const Key &b) { return a < b; }),
        std::min(end_, view_.upper(), [](const Key &a, const Key &b) { return a < b; }));
    return made_.next(page);
}

template <int D> void OwnPages<D>::cut(const Key &lower, const Key &upper) {
    view_.read_rest();
    slots_.resize(static_cast<std::size_t>(view_.simplices()));
    links_.connect(view_, slots_.data(), Handle{0}, abacus_links_ghosts(facts_.standing) != 0,
                   border_, on_border_);
    outside_.resize(slots_.size() * (D + 1));
    for (int i = 0; i < static_cast<int>(border_.size()); ++i) {
        const Link facet = border_[static_cast<std::size_t>(i)];
        const int vertex = view_.link_vertex(i);
        outside_[to_number(link_simplex(facet)) * (D + 1) +
                 static_cast<std::size_t>(link_facet(facet))] = {
            vertex < view_.vertices() ? domain_.code(view_.point(vertex))
                                      : view_.foreign_code(vertex),
            view_.link_part(i)};
    }
    kept_.clear();
    for (int s = 0; s < view_.simplices(); ++s) {
        const std::uint64_t code = code_of(view_, s, domain_);
        if (lower.code <= code && code < end_.code)
            kept_.push_back({{code, part(s)}, static_cast<std::uint16_t>(s)});
    }
    std::sort(kept_.begin(), kept_.end(), [](const Kept &a, const Kept &b) {
        return a.key < b.key || (a.key == b.key && a.simplex < b.simplex);
    });
    const std::size_t words = static_cast<std::size_t>(1 + D + attributes_);
    records_.resize(static_cast<std::size_t>(view_.vertices()) * words);
    for (int v = 0; v < view_.vertices(); ++v) {
        std::uint64_t *record = records_.data() + static_cast<std::size_t>(v) * words;
        *record++ = static_cast<std::uint64_t>(view_.id(v));
        for (const double x : view_.point(v)) *record++ = std::bit_cast<std::uint64_t>(x);
        for (int i = 0; i < attributes_; ++i)
            *record++ = std::bit_cast<std::uint64_t>(view_.attribute(v, i));
    }
    make(lower, upper, 0, kept_.size());
}

template <int D> std::uint64_t OwnPages<D>::part(int simplex) const {
    std::array<const Point<D> *, D + 1> corners{};
    std::array<std::uint64_t, D + 1> codes{};
    const int n = D + !view_.is_ghost(simplex);
    for (int i = 0; i < n; ++i) {
        corners[i] = &view_.point(view_.corner(simplex, i));
        codes[i] = domain_.code(*corners[i]);
    }
    return Domain<D>::part(corners, codes, n);
}

template <int D> Key OwnPages<D>::beyond(int simplex, int facet) const {
    const Link link =
        slots_[static_cast<std::size_t>(simplex)].link[static_cast<std::size_t>(facet)];
    if (link != unset)
        return {code_of(view_, static_cast<int>(to_number(link_simplex(link))), domain_), 0};
    return outside_[static_cast<std::size_t>(simplex) * (D + 1) + static_cast<std::size_t>(facet)];
}

template <int D>
void OwnPages<D>::make(const Key &lower, const Key &upper, std::size_t begin, std::size_t end) {
    loose_.clear();
    const std::size_t words = static_cast<std::size_t>(1 + D + attributes_);
    for (std::size_t i = begin; i < end; ++i) {
        LooseSimplex<D> simplex{};
        for (int k = 0; k <= D; ++k) {
            const int v = view_.corner(kept_[i].simplex, k);
            if (v < view_.vertices())
                simplex.vertex[k] = records_.data() + static_cast<std::size_t>(v) * words;
            simplex.beyond[k] = beyond(kept_[i].simplex, k);
        }
        loose_.push_back(simplex);
    }
    if (maker_.append(lower, upper, loose_.data(), loose_.size())) return;
    const std::size_t at = middle(begin, end);
    const Key border =
        kept_[at - 1].key.code != kept_[at].key.code ? Key{kept_[at].key.code, 0} : kept_[at].key;
    make(lower, border, begin, at);
    make(border, upper, at, end);
}

template <int D> std::size_t OwnPages<D>::middle(std::size_t begin, std::size_t end) const {
    const std::size_t half = (begin + end) / 2;
    const auto nearest = [&](auto differ) {
        for (std::size_t distance = 0; distance <= (end - begin) / 2 + 1; ++distance)
            for (const std::size_t at : {half - distance, half + distance})
                if (begin < at && at < end && differ(kept_[at - 1].key, kept_[at].key)) return at;
        return end;
    };
    std::size_t at = nearest([](const Key &a, const Key &b) { return a.code != b.code; });
    if (at == end) at = nearest([](const Key &a, const Key &b) { return a < b; });
    if (at == end)
        throw Error(ABACUS_ERROR_LIMIT, "too many simplices share one key",
                    "More simplices than fit on a page have the same place on the curve.");
    return at;
}

template <int D> void OwnPages<D>::count(std::uint64_t &simplices, std::uint64_t &ghosts) {
    simplices = facts_.census.simplices;
    ghosts = facts_.census.ghosts;
    if (simplices == 0) return;
    const auto leave_out = [&](Key from, const Key &to) {
        while (from < to) {
            abacus_page page{};
            open(from, page);
            view_.read_rest();
            for (int s = 0; s < view_.simplices(); ++s) {
                const Key key{code_of(view_, s, domain_), 0};
                if (begin_ <= key && key < end_) continue;
                --(view_.is_ghost(s) ? ghosts : simplices);
            }
            from = view_.upper();
        }
        return from;
    };
    // a page across the whole stretch is read once
    const Key behind = leave_out(first_key, begin_);
    leave_out(behind < end_ ? end_ : behind, end_key);
}

template class OwnPages<2>;
template class OwnPages<3>;

} // namespace abacus
