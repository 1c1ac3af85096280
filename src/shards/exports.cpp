#include "shards/exports.hpp"

#include "keys/domain_of.hpp"
#include "query/pages/page_simplex.hpp"
#include "shards/given_box.hpp"

#include <string>

namespace abacus {

template <int D>
Exports<D>::Exports(const Host &host, const abacus_facts &facts,
                    std::span<const std::uint64_t> borders, std::uint32_t shard,
                    const abacus_box &extent)
    : shard_(shard), extent_(given_box<D>(extent)),
      regions_(host, domain_of<D>(facts.form), borders, extent_),
      attributes_(facts.columns.attributes), has_simplices_(facts.census.simplices > 0),
      pages_(host, facts),
      waiting_(host, facts.columns.attributes, facts.census.inserted, facts.census.staged),
      next_receiver_(regions_.shards()), values_(host, facts), of_vertex_(host), owners_(host),
      to_send_(host) {
    of_vertex_.resize(attributes_);
}

template <int D> bool Exports<D>::next(std::uint32_t &to, abacus_vertex &vertex) {
    if (!has_simplices_) return next_waiting(to, vertex);
    while (at_ == to_send_.size()) {
        if (!pages_.advance()) return false;
        collect();
    }
    const std::uint64_t pair = to_send_[at_++];
    const int v = static_cast<int>(pair & ~std::uint32_t{0});
    const PageView<D> &page = pages_.page();
    to = static_cast<std::uint32_t>(pair >> 32);
    vertex = {};
    vertex.id = vertex.vertex = page.id(v);
    std::copy_n(page.point(v).begin(), D, vertex.point);
    values_.all(page, v, of_vertex_.data());
    vertex.attributes = of_vertex_.data();
    return true;
}

/// Finds what the page's simplices say, each vertex once for a shard.
template <int D> void Exports<D>::collect() {
    const PageView<D> &page = pages_.page();
    owners_.resize(static_cast<std::size_t>(page.vertices()));
    for (int v = 0; v < page.vertices(); ++v) {
        if (!extent_.contains(page.point(v)))
            throw Error(ABACUS_ERROR_ARGUMENT, "a point lies outside the extent of all points",
                        "Its id is " + std::to_string(page.id(v)) + ".", {});
        owners_[static_cast<std::size_t>(v)] = regions_.owner(page.point(v));
    }
    to_send_.clear();
    at_ = 0;
    for (int simplex = 0; simplex < page.simplices(); ++simplex) collect(simplex);
    std::sort(to_send_.begin(), to_send_.end());
    to_send_.resize(
        static_cast<std::size_t>(std::unique(to_send_.begin(), to_send_.end()) - to_send_.begin()));
}

template <int D> void Exports<D>::collect(int simplex) {
    const PageView<D> &page = pages_.page();
    const bool is_ghost = page.is_ghost(simplex);
    Corners<D> corners{};
    bool has_own = false;
    for (int i = 0; i < D + !is_ghost; ++i) {
        const int v = page.corner(simplex, i);
        corners[i] = &page.point(v);
        const std::uint32_t owner = owners_[static_cast<std::size_t>(v)];
        has_own |= owner == shard_;
        if (owner != shard_) send(simplex, owner);
    }
    if (!has_own) return;
    std::uint32_t last = shard_; // that got them; regions come in stretches
    regions_.each_met(corners, is_ghost, [&](std::uint32_t met) {
        if (met == shard_ || met == last) return;
        send(simplex, last = met);
    });
}

/// All corners but those that the receiver owns.
template <int D> void Exports<D>::send(int simplex, std::uint32_t to) {
    const PageView<D> &page = pages_.page();
    for (int i = 0; i < D + !page.is_ghost(simplex); ++i) {
        const auto v = static_cast<std::uint32_t>(page.corner(simplex, i));
        if (owners_[v] != to) to_send_.push_back(std::uint64_t{to} << 32 | v);
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
