// The pages of a stretch of the curve, in key order, without a cache: from the one that owns its
// first key to the one that owns its last. The current page is a copy, as in PageScan.
#pragma once

#include "host/host.hpp"
#include "mesh/page_attributes.hpp"
#include "mesh/page_format.hpp"

#include <abacus/facts.h>

#include <algorithm>
#include <cstring>

namespace abacus {

template <int D> class StretchScan {
public:
    /// Of the codes from `least` to `greatest`.
    StretchScan(const Host &host, const abacus_facts &facts, std::uint64_t least,
                std::uint64_t greatest)
        : host_(host),
          attributes_(page_attributes(facts.columns)), next_{least, 0}, last_{greatest,
                                                                              key_word_end - 1},
          is_over_(facts.census.simplices == 0 || least > greatest || least >= end_key.code) {}

    /// Goes to the next page; false after the last. Throws if it is damaged or missing.
    bool advance() {
        if (is_over_) return false;
        host_.poll();
        abacus_page page{};
        if (!host_.find(ABACUS_SIMPLEX_PAGES, next_, page)) throw_corrupted(unowned);
        ++pages_read_;
        std::memcpy(copy_, page.bytes, std::min(page.size, sizeof copy_));
        view_.read(copy_, page.size, attributes_);
        if (!(view_.lower() <= next_ && next_ < view_.upper())) throw_corrupted(unowned);
        next_ = view_.upper();
        is_over_ = !(next_ < end_key) || last_ < next_;
        return true;
    }
    const PageView<D> &page() const { return view_; }
    std::uint64_t pages_read() const { return pages_read_; }

private:
    static constexpr const char *unowned = "No page owns a part of the curve.";

    const Host &host_;
    const int attributes_;
    Key next_; // the first that the pages so far do not own
    const Key last_;
    bool is_over_;
    std::uint64_t pages_read_ = 0;
    PageView<D> view_;
    alignas(8) unsigned char copy_[ABACUS_PAGE_BYTES];
};

} // namespace abacus
