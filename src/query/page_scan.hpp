// All pages of a mesh in key order, without a cache. The page at hand is a copy:
// the host's bytes do not outlive its next call, and a scan may be held between
// calls of its user.
#pragma once

#include "host/host.hpp"
#include "mesh/page_format.hpp"

#include <algorithm>
#include <cstring>

namespace abacus {

template <int D> class PageScan {
public:
    PageScan(const Host &host, unsigned attributes) : host_(host), attributes_(attributes) {}

    /// Goes to the next page; false after the last. Throws if it is damaged.
    bool advance() {
        if (!fetch()) return false;
        parse();
        return true;
    }
    /// The halves of advance(), for who wants to go on after a damaged page.
    bool fetch() {
        host_.poll();
        abacus_page page{};
        if (!host_.next(ABACUS_SIMPLEX_PAGES, started_ ? &key_ : nullptr, page)) return false;
        started_ = true;
        key_ = page.key;
        size_ = page.size;
        std::memcpy(copy_, page.bytes, std::min(size_, sizeof copy_));
        return true;
    }
    void parse() { view_.read(copy_, size_, static_cast<int>(attributes_)); }
    /// The same whatever the checksum is; false if that is wrong.
    bool parse_unsealed() {
        view_.read(copy_, size_, static_cast<int>(attributes_), PageView<D>::Checksum::ignore);
        return page_is_sealed(copy_, size_);
    }
    /// Key under which the page at hand is stored.
    const Key &key() const { return key_; }
    const PageView<D> &page() const { return view_; }

private:
    const Host &host_;
    unsigned attributes_;
    bool started_ = false;
    Key key_{};
    std::size_t size_ = 0;
    PageView<D> view_;
    alignas(8) unsigned char copy_[ABACUS_PAGE_BYTES];
};

} // namespace abacus
