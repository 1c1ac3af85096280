// All leaves of an octree, page by page along the curve, past any cache.
#pragma once

#include "blocks/page_cursor.hpp"
#include "host/arena.hpp"
#include "octree/octant_page.hpp"

#include <abacus/facts.h>

namespace abacus {

template <int D> class LeafScan {
public:
    LeafScan(const Host &host, const abacus_facts &facts)
        : cursor_(host, ABACUS_OCTANT_PAGES, "octree"),
          attributes_(static_cast<int>(facts.columns.attributes)), values_(host) {
        values_.resize(facts.columns.attributes);
    }

    /// The next leaf; false after the last. Throws Error (corrupted) unless leaves tile the domain.
    bool next() {
        while (!has_more())
            if (!next_page()) return false;
        leaf_ = {code_, view_.level(at_++)};
        code_ = leaf_.end();
        return true;
    }
    /// The next page; false after the last. Then next() gives its leaves first.
    bool next_page();
    /// The page has become several: the next one is behind all of them.
    void pass_page() { cursor_.pass_interval(); }

    const Octant<D> &leaf() const { return leaf_; }
    /// Its attributes, valid until they are asked for again.
    const double *values() {
        for (int a = 0; a < attributes_; ++a) values_[a] = view_.attribute(at_ - 1, a);
        return values_.data();
    }
    /// Of the page: whether it has more leaves, its interval, and where it is stored.
    bool has_more() const { return at_ < leaves_; }
    std::uint64_t lower() const { return view_.lower(); }
    std::uint64_t upper() const { return view_.upper(); }
    std::uint64_t location() const { return cursor_.location(); }
    /// Pages so far, and their bytes.
    std::uint64_t pages() const { return cursor_.pages_read(); }
    std::uint64_t bytes() const { return cursor_.bytes_read(); }

private:
    PageCursor cursor_;
    int attributes_;
    OctantPageView<D> view_;
    std::uint32_t leaves_ = 0, at_ = 0; // of the page
    std::uint64_t code_ = 0;            // where the last leaf ended
    Octant<D> leaf_;
    Arena<double> values_;
};

template <int D> bool LeafScan<D>::next_page() {
    if (!cursor_.fetch()) {
        cursor_.require_end();
        if (code_ != domain_cells<D>)
            throw_octree_corrupted("Leaves do not reach the end of the domain.");
        return false;
    }
    view_.read(cursor_.bytes(), cursor_.size(), attributes_);
    cursor_.follow({view_.lower(), 0}, {view_.upper(), 0});
    if (view_.leaves() > 0 && view_.first() != code_)
        throw_octree_corrupted("A page does not begin where the leaves before it end.");
    leaves_ = view_.leaves();
    at_ = 0;
    return true;
}

} // namespace abacus
