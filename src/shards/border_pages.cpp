#include "shards/border_pages.hpp"

#include "query/locate/reader.hpp"
#include "query/pages/page_simplex.hpp"

namespace abacus {

namespace {

/// The size of the cache for the walks to the regions.
constexpr std::size_t walk_bytes = std::size_t{1} << 20;

template <int D> Corners<D> corners_of_any(const PageView<D> &page, int simplex) {
    Corners<D> corners{};
    for (int i = 0; i < D + !page.is_ghost(simplex); ++i)
        corners[i] = &page.point(page.corner(simplex, i));
    return corners;
}

} // namespace

template <int D>
BorderPages<D>::BorderPages(const Host &host, const abacus_facts &facts,
                            const ShardRegions<D> &regions, std::uint32_t shard)
    : regions_(regions), shard_(shard), near_(host) {
    if (abacus_floods_pages(facts.standing) == 0) {
        whole_.emplace(host, facts);
        return;
    }
    flood_.emplace(host, facts);
    Reader<D> reader(host, facts, walk_bytes);
    regions.each_box([&](const Box<D> &box, std::uint32_t owner) {
        if (owner == shard || !box.contains(box.lower)) return;
        if (const auto around = reader.page_around(box.lower)) flood_->reach(around->page);
    });
}

template <int D> bool BorderPages<D>::advance() {
    if (flood_ ? !flood_->advance() : !whole_->advance()) return false;
    near_.resize(static_cast<std::size_t>(page().simplices()));
    for (int s = 0; s < page().simplices(); ++s)
        near_[static_cast<std::size_t>(s)] = meets_others(s);
    if (flood_) flood_->spread([this](int simplex, int) { return is_near(simplex); });
    return true;
}

template <int D> bool BorderPages<D>::meets_others(int simplex) const {
    bool meets = false;
    regions_.each_met(corners_of_any(page(), simplex), page().is_ghost(simplex),
                      [&](std::uint32_t met) { meets |= met != shard_; });
    return meets;
}

template class BorderPages<2>;
template class BorderPages<3>;

} // namespace abacus
