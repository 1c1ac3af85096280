#include "shards/exports.hpp"

#include "keys/domain_of.hpp"
#include "query/pages/page_simplex.hpp"
#include "shards/given_box.hpp"

#include <string>

namespace abacus {

namespace {

/// The cache for places.
constexpr std::size_t reader_bytes = std::size_t{16} << 20;

} // namespace

template <int D>
Exports<D>::Exports(const Host &host, const abacus_facts &facts,
                    std::span<const std::uint64_t> borders, std::uint32_t shard,
                    const abacus_box &extent)
    : host_(host), facts_(facts), shard_(shard), extent_(given_box<D>(extent)),
      regions_(host, domain_of<D>(facts.form), borders, extent_),
      attributes_(facts.columns.attributes),
      waiting_(host, facts.columns.attributes, facts.census.inserted, facts.census.staged),
      next_receiver_(regions_.shards()), values_(host, facts), of_vertex_(host), links_(host),
      slots_(host), border_(host), on_border_(host), owners_(host), to_send_(host) {
    of_vertex_.resize(attributes_);
}

template <int D> bool Exports<D>::next(std::uint32_t &to, abacus_vertex &vertex) {
    if (facts_.census.simplices == 0) return next_waiting(to, vertex);
    while (at_ == to_send_.size()) {
        if (!advance()) return false;
        collect();
    }
    const std::uint64_t pair = to_send_[at_++];
    const int v = static_cast<int>(pair & ~std::uint32_t{0});
    const PageView<D> &page = pages_->page();
    to = static_cast<std::uint32_t>(pair >> 32);
    vertex = {};
    vertex.id = vertex.vertex = page.id(v);
    std::copy_n(page.point(v).begin(), D, vertex.point);
    values_.all(page, v, of_vertex_.data());
    vertex.attributes = of_vertex_.data();
    return true;
}

template <int D> BorderPages<D> &Exports<D>::pages() {
    if (!pages_) pages_.emplace(host_, facts_, regions_, shard_);
    return *pages_;
}

template <int D> bool Exports<D>::advance() {
    if (!pages().advance()) return false;
    const PageView<D> &page = pages_->page();
    owners_.resize(static_cast<std::size_t>(page.vertices()));
    for (int v = 0; v < page.vertices(); ++v)
        owners_[static_cast<std::size_t>(v)] = owner(page.point(v), page.id(v));
    return true;
}

template <int D> std::uint64_t Exports<D>::count_owned() {
    std::uint64_t others = 0; // simplices: each has a corner of another shard, so it is near
    while (facts_.census.simplices > 0 && advance()) {
        for (int simplex = 0; simplex < pages_->page().simplices(); ++simplex)
            others += !pages_->page().is_ghost(simplex) && owner_of(simplex) != shard_;
    }
    return facts_.census.simplices - others;
}

/// Finds what the page's simplices say, each vertex once for a shard.
template <int D> void Exports<D>::collect() {
    to_send_.clear();
    at_ = 0;
    for (int simplex = 0; simplex < pages_->page().simplices(); ++simplex)
        if (pages_->is_near(simplex)) collect(simplex);
    collect_beyond();
    std::sort(to_send_.begin(), to_send_.end());
    to_send_.resize(
        static_cast<std::size_t>(std::unique(to_send_.begin(), to_send_.end()) - to_send_.begin()));
}

template <int D> void Exports<D>::collect(int simplex) {
    const PageView<D> &page = pages_->page();
    const bool is_ghost = page.is_ghost(simplex);
    Corners<D> corners{};
    std::array<std::uint32_t, D + 1> owners{};
    for (int i = 0; i < D + !is_ghost; ++i) {
        const int v = page.corner(simplex, i);
        corners[i] = &page.point(v);
        owners[i] = owners_[static_cast<std::size_t>(v)];
    }
    each_receiver(corners, owners, is_ghost, [&](std::uint32_t to) { send(simplex, to); });
}

template <int D>
template <class Send>
void Exports<D>::each_receiver(const Corners<D> &corners,
                               const std::array<std::uint32_t, D + 1> &owners, bool is_ghost,
                               Send send) const {
    bool has_own = false;
    for (int i = 0; i < D + !is_ghost; ++i) {
        has_own |= owners[i] == shard_;
        if (owners[i] != shard_) send(owners[i]);
    }
    if (!has_own) return;
    std::uint32_t last = shard_; // that got them; regions come in stretches
    regions_.each_met(corners, is_ghost, [&](std::uint32_t met) {
        if (met != shard_ && met != last) send(last = met);
    });
}

/// Of the greatest of its vertices, which has the greatest owner.
template <int D> std::uint32_t Exports<D>::owner_of(int simplex) const {
    const PageView<D> &page = pages_->page();
    std::uint32_t greatest = 0;
    for (int i = 0; i < D + !page.is_ghost(simplex); ++i)
        greatest = std::max(greatest, owners_[static_cast<std::size_t>(page.corner(simplex, i))]);
    return greatest;
}

/// Simplices whose neighbours other shards own. Most pages have none.
template <int D> void Exports<D>::collect_beyond() {
    const PageView<D> &page = pages_->page();
    const auto own = [&](std::uint32_t owner) { return owner == shard_; };
    bool is_inside = std::all_of(owners_.begin(), owners_.end(), own);
    const auto link_owner = [&](int link) {
        const int v = page.link_vertex(link);
        return v < page.vertices() ? owners_[static_cast<std::size_t>(v)]
                                   : regions_.owner(page.foreign_code(v));
    };
    for (int i = 0; is_inside && i < page.links(); ++i) is_inside = own(link_owner(i));
    if (is_inside || std::none_of(owners_.begin(), owners_.end(), own)) return;
    slots_.resize(static_cast<std::size_t>(page.simplices()));
    links_.connect(page, slots_.data(), Handle{0}, true, border_, on_border_);
    for (int s = 0; s < page.simplices(); ++s)
        for (int i = 0; i <= D; ++i)
            if (const Link link = slots_[static_cast<std::size_t>(s)].link[i]; link != unset)
                send_across(s, i, owner_of(static_cast<int>(to_number(link_simplex(link)))));
    for (int i = 0; i < page.links(); ++i) {
        const Link facet = border_[static_cast<std::size_t>(i)];
        send_across(static_cast<int>(to_number(link_simplex(facet))), link_facet(facet),
                    link_owner(i));
    }
}

/// The owner of the simplex beyond a facet gets the corners, if the shard owns one of the facet.
template <int D> void Exports<D>::send_across(int simplex, int facet, std::uint32_t beyond) {
    const PageView<D> &page = pages_->page();
    if (beyond == shard_) return;
    bool has_own = false;
    for (int i = 0; i < D + !page.is_ghost(simplex); ++i)
        has_own |=
            i != facet && owners_[static_cast<std::size_t>(page.corner(simplex, i))] == shard_;
    if (has_own) send(simplex, beyond);
}

/// All corners but those that the receiver owns.
template <int D> void Exports<D>::send(int simplex, std::uint32_t to) {
    const PageView<D> &page = pages_->page();
    for (int i = 0; i < D + !page.is_ghost(simplex); ++i) {
        const auto v = static_cast<std::uint32_t>(page.corner(simplex, i));
        if (owners_[v] != to) to_send_.push_back(std::uint64_t{to} << 32 | v);
    }
}

template <int D> std::uint32_t Exports<D>::owner(const Point<D> &p, std::int64_t id) const {
    if (!extent_.contains(p))
        throw Error(ABACUS_ERROR_ARGUMENT, "a point lies outside the extent of all points",
                    "Its id is " + std::to_string(id) + ".", {});
    return regions_.owner(p);
}

/// All corners of a cached simplex but those that the receiver owns.
template <int D> void Exports<D>::send_cached(Handle h, std::uint32_t to) {
    const Cache<D> &cache = reader_->cache();
    const Simplex<D> &s = cache.simplex(h);
    for (int i = 0; i < s.finite_vertices(); ++i)
        if (regions_.owner(cache.point(s.vertex[i])) != to)
            to_send_.push_back(std::uint64_t{to} << 32 | to_number(s.vertex[i]));
}

template <int D> std::uint32_t Exports<D>::owner_cached(Handle h) {
    const Cache<D> &cache = reader_->cache();
    const Simplex<D> &s = cache.simplex(h);
    std::uint32_t greatest = 0;
    for (int i = 0; i < s.finite_vertices(); ++i)
        greatest =
            std::max(greatest, owner(cache.point(s.vertex[i]), cache.vertices().id(s.vertex[i])));
    return greatest;
}

/// The rules for the star of the vertex at p, which the first simplex has, and rule 3 for its
/// neighbours.
template <int D> void Exports<D>::collect_around(const Point<D> &p, Handle first) {
    Cache<D> &cache = reader_->cache();
    const auto has_p = [&](Handle h, int facet) {
        const VertexIndex v = cache.simplex(h).vertex[facet];
        return v == infinite_vertex || cache.point(v) != p;
    };
    reader_->flood().from(cache, first, has_p, [](Handle) { return true; });
    for (const Handle met : reader_->flood().met()) {
        const Simplex<D> s = cache.simplex(met);
        Corners<D> corners{};
        std::array<std::uint32_t, D + 1> owners{};
        for (int i = 0; i < s.finite_vertices(); ++i) {
            corners[i] = &cache.point(s.vertex[i]);
            owners[i] = owner(*corners[i], cache.vertices().id(s.vertex[i]));
        }
        each_receiver(corners, owners, s.is_ghost(),
                      [&](std::uint32_t to) { send_cached(met, to); });
        const std::uint32_t here = owner_cached(met);
        for (int facet = 0; facet <= D; ++facet) {
            bool has_own = false;
            for (int i = 0; i < s.finite_vertices(); ++i)
                has_own |= i != facet && owners[i] == shard_;
            if (!has_own) continue;
            const Handle neighbour = link_simplex(cache.cross(met, facet));
            const std::uint32_t there = owner_cached(neighbour);
            if (there != shard_) send_cached(met, there);
            if (here != shard_) send_cached(neighbour, here);
        }
    }
}

template <int D> void Exports<D>::around(const Point<D> &p, const Visit &visit) {
    if (!reader_) reader_.emplace(host_, facts_, reader_bytes);
    Cache<D> &cache = reader_->cache();
    const Handle first = reader_->simplex_around(p);
    if (first == no_handle) return;
    const Simplex<D> &found = cache.simplex(first);
    if (std::none_of(found.vertex.begin(), found.vertex.end(),
                     [&](VertexIndex v) { return v != infinite_vertex && cache.point(v) == p; }))
        return;
    to_send_.clear();
    collect_around(p, first);
    std::sort(to_send_.begin(), to_send_.end());
    to_send_.resize(
        static_cast<std::size_t>(std::unique(to_send_.begin(), to_send_.end()) - to_send_.begin()));
    for (const std::uint64_t pair : to_send_) {
        const auto v = static_cast<VertexIndex>(pair & ~std::uint32_t{0});
        abacus_vertex vertex{};
        vertex.id = vertex.vertex = cache.vertices().id(v);
        std::copy_n(cache.point(v).begin(), D, vertex.point);
        values_.all(cache.vertices(), v, of_vertex_.data());
        vertex.attributes = of_vertex_.data();
        visit(static_cast<std::uint32_t>(pair >> 32), vertex);
    }
}

/// Without simplices: each own point goes to all other shards.
template <int D> bool Exports<D>::next_waiting(std::uint32_t &to, abacus_vertex &vertex) {
    for (;;) {
        if (next_receiver_ == regions_.shards()) {
            do
                if (!waiting_.advance()) return false;
            while (regions_.owner(waiting_.point()) != shard_);
            next_receiver_ = 0;
        }
        to = next_receiver_++;
        if (to == shard_) continue;
        vertex = {};
        vertex.id = vertex.vertex = waiting_.id();
        std::copy_n(waiting_.point().begin(), D, vertex.point);
        vertex.attributes = waiting_.attributes();
        return true;
    }
}

template class Exports<2>;
template class Exports<3>;

} // namespace abacus
