// All pages of a mesh in key order, without a cache. The page at hand is a copy:
// the host's bytes do not outlive its next call, and a scan may be held between
// calls of its user.
#pragma once

#include "cache/page_format.hpp"
#include "host/host.hpp"

#include <optional>

namespace abacus {

template <int D> class PageScan {
public:
    PageScan(const Host &host, unsigned attributes) : host_(host), attributes_(attributes) {}

    /// Goes to the next page; false after the last. Throws if it is damaged.
    bool advance() {
        host_.poll();
        abacus_page page{};
        if (!host_.next(started_ ? &key_ : nullptr, page)) return false;
        started_ = true;
        key_ = page.key;
        if (page.size > sizeof copy_) throw_corrupted("A simplex page has an impossible size.");
        std::memcpy(copy_, page.bytes, page.size);
        view_.emplace(PageView<D>::parse(copy_, page.size, static_cast<int>(attributes_)));
        return true;
    }
    /// Key under which the page at hand is stored.
    const Key &key() const { return key_; }
    const PageView<D> &page() const { return *view_; }

private:
    const Host &host_;
    unsigned attributes_;
    bool started_ = false;
    Key key_{};
    std::optional<PageView<D>> view_;
    alignas(8) unsigned char copy_[ABACUS_PAGE_BYTES];
};

} // namespace abacus
