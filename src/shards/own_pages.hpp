// What a shard has of the mesh of all shards, as pages: the simplices whose codes it owns.
//
// A shard's mesh also has simplices that others own. They lie in pages outside its stretch of the
// curve, but for those across its ends. So pages inside are as they are stored, and one at an end
// is made again of the simplices that belong to the shard.
//
// Invariants
//   1. The pages of all shards, one after the other, partition the curve: those of a shard begin
//      with its stretch and end with it. A shard whose mesh has no simplices has one empty page.
//   2. Where a neighbour lies with another shard, the link is its key, which the shard knows: it
//      has all simplices across facets of its own (exports.hpp). No part is needed: a part of 0
//      stands for any.
#pragma once

#include "keys/domain_of.hpp"
#include "mesh/cache.hpp"
#include "query/pages/page_simplex.hpp"
#include "shards/made_pages.hpp"

namespace abacus {

template <int D> class OwnPages {
public:
    /// Codes from `first` to `last`; none if last < first.
    OwnPages(const Host &host, const abacus_facts &facts, std::uint64_t first, std::uint64_t last);
    OwnPages(const OwnPages &) = delete;
    OwnPages &operator=(const OwnPages &) = delete;

    /// Begins with the page that owns the key, which lies in the stretch.
    void seek(const Key &key);
    /// The next page, without a location; false after the last. Valid until the next call.
    bool next(abacus_page &page);
    /// Where the stretch ends.
    const Key &end() const { return end_; }

    /// How many simplices and ghosts the shard owns. Reads the pages outside its stretch.
    void count(std::uint64_t &simplices, std::uint64_t &ghosts);

private:
    /// A simplex of the page at an end, that stays.
    struct Kept {
        Key key;
        std::uint16_t simplex;
    };

    void open(const Key &key, abacus_page &page);
    /// Makes pages of the page's simplices that have keys in [lower, upper).
    void cut(const Key &lower, const Key &upper);
    void make(const Key &lower, const Key &upper, std::size_t begin, std::size_t end);
    /// Where to cut if one page is not enough.
    std::size_t middle(std::size_t begin, std::size_t end) const;
    std::uint64_t part(int simplex) const;
    Key beyond(int simplex, int facet) const;

    const Host &host_;
    const abacus_facts facts_;
    const Domain<D> domain_;
    const int attributes_;
    const Key begin_, end_;
    Key next_;
    MadePages made_;
    const Host making_; // the same host; pages that are made stay in made_
    Cache<D> maker_;
    PageView<D> view_;
    InnerLinks<D> links_;
    Arena<Simplex<D>> slots_;
    Arena<Link> border_;
    Arena<bool> on_border_;
    Arena<Key> outside_; // beyond each facet of the border, facets of a simplex together
    Arena<Kept> kept_;
    Arena<std::uint64_t> records_; // vertices
    Arena<LooseSimplex<D>> loose_;
};

extern template class OwnPages<2>;
extern template class OwnPages<3>;

} // namespace abacus
