// The pages of a shard's mesh with simplices whose circumspheres may meet the regions of other
// shards, found without reading the others.
//
// Let a region's cell be given. The simplices whose closed circumballs contain a place are
// connected across facets, and so are, since balls are closed and their number is finite, those
// whose balls meet the cell, which is connected: if they fell apart, so would its places. Ghosts
// count, with their half-spaces. So one of them leads to all: the simplex around any place of the
// cell, or a ghost that sees it. Balls are rounded outwards, so more may be reached, never less.
//
// A simplex with a corner that another shard owns is one of them.
#pragma once

#include "query/pages/page_flood.hpp"
#include "query/pages/page_scan.hpp"
#include "shards/regions.hpp"

#include <optional>

namespace abacus {

template <int D> class BorderPages {
public:
    BorderPages(const Host &host, const abacus_facts &facts, const ShardRegions<D> &regions,
                std::uint32_t shard);

    /// Goes to the next page; false after the last.
    bool advance();
    const PageView<D> &page() const { return flood_ ? flood_->page() : whole_->page(); }
    /// Whether this simplex of the page is one of those looked for.
    bool is_near(int simplex) const { return near_[static_cast<std::size_t>(simplex)]; }

private:
    /// Whether its ball may meet another shard's region.
    bool meets_others(int simplex) const;

    const ShardRegions<D> &regions_;
    const std::uint32_t shard_;
    std::optional<PageFlood<D>> flood_;
    std::optional<PageScan<D>> whole_; // of a mesh in which no flood gets everywhere
    Arena<bool> near_;                 // of the page's simplices
};

extern template class BorderPages<2>;
extern template class BorderPages<3>;

} // namespace abacus
