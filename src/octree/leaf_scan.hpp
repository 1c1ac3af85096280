// All leaves of an octree, page by page along the curve, past any cache.
#pragma once

#include "host/host.hpp"
#include "octree/octant_page.hpp"

#include <abacus/header.h>

#include <cstring>

namespace abacus {

template <int D> class LeafScan {
public:
    LeafScan(const Host &host, const abacus_header &header)
        : host_(host), attributes_(static_cast<int>(header.attributes)), values_(host) {
        values_.resize(header.attributes);
    }

    /// The next leaf; false after the last. Throws Error (corrupted) unless leaves tile the domain.
    bool next() {
        while (at_ == view_leaves_)
            if (!next_page()) return false;
        leaf_ = {code_, view_.level(at_++)};
        code_ = leaf_.end();
        return true;
    }
    /// The next page; false after the last. Then next() gives its leaves first.
    bool next_page();

    const Octant<D> &leaf() const { return leaf_; }
    /// Its attributes, valid until the next leaf.
    const double *values() {
        for (int a = 0; a < attributes_; ++a) values_[a] = view_.attribute(at_ - 1, a);
        return values_.data();
    }
    /// Of the page: whether it has more leaves, its interval, and where it is stored.
    bool has_more() const { return at_ < view_leaves_; }
    std::uint64_t lower() const { return view_.lower(); }
    std::uint64_t upper() const { return view_.upper(); }
    std::uint64_t location() const { return location_; }
    std::uint64_t pages() const { return pages_; }

private:
    const Host &host_;
    int attributes_;
    OctantPageView<D> view_;
    std::uint32_t view_leaves_ = 0, at_ = 0;
    std::uint64_t location_ = 0, pages_ = 0;
    std::uint64_t upper_ = 0; // of the last page
    std::uint64_t code_ = 0;  // where the last leaf ended
    Octant<D> leaf_;
    Arena<double> values_;
    alignas(8) unsigned char copy_[ABACUS_PAGE_BYTES + 8];
};

template <int D> bool LeafScan<D>::next_page() {
    abacus_page page{};
    // The pages before may have become several by now.
    const Key before = pages_ == 0 ? first_key : predecessor({upper_, 0});
    if (upper_ == key_word_end ||
        !host_.next(ABACUS_OCTANT_PAGES, pages_ == 0 ? nullptr : &before, page)) {
        if (upper_ != key_word_end || code_ != domain_cells<D>)
            throw_octree_corrupted("Leaves do not reach the end of the curve.");
        return false;
    }
    if (page.size > ABACUS_PAGE_BYTES) throw_octree_corrupted("An octant page is too long.");
    std::memcpy(copy_, page.bytes, page.size);
    view_.read(copy_, page.size, attributes_);
    if (!(page.key == Key{view_.lower(), 0}))
        throw_octree_corrupted("A page is stored under another page's key.");
    if (view_.lower() != upper_)
        throw_octree_corrupted("Two pages own the same part of the curve, or none does.");
    if (view_.leaves() > 0 && view_.first() != code_)
        throw_octree_corrupted("A page begins where the leaves before do not end.");
    upper_ = view_.upper();
    view_leaves_ = view_.leaves();
    at_ = 0;
    location_ = page.location;
    ++pages_;
    host_.poll();
    return true;
}

} // namespace abacus
