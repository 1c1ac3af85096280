// All pages of a mesh in key order, without a cache. The current page is a copy, since
// the host's bytes do not outlive its next call, and a scan may be held between calls
// of its user.
//
// No page knows its neighbours on the curve, so a page that is lost leaves no trace in the others.
// But their intervals follow one another without a gap from end to end, and the header counts
// what is in them: advance() compares both.
#pragma once

#include "host/host.hpp"
#include "mesh/page_attributes.hpp"
#include "mesh/page_format.hpp"

#include <abacus/header.h>

#include <algorithm>
#include <cstring>

namespace abacus {

template <int D> class PageScan {
public:
    PageScan(const Host &host, const abacus_header &header)
        : host_(host), attributes_(page_attributes(header)),
          left_(header.simplices + header.ghosts) {}

    /// Goes to the next page; false after the last. Throws if it is damaged or does not follow
    /// the one before, and at the end if pages are missing.
    bool advance() {
        if (!fetch()) {
            require_end();
            return false;
        }
        parse();
        follow();
        return true;
    }
    /// The same, past pages that wants(page) refuses, of which only the heads are read then.
    template <class Wants> bool advance(Wants wants) {
        while (fetch()) {
            view_.open(copy_, size_, attributes_);
            follow();
            if (!wants(view_)) continue;
            view_.read_rest();
            return true;
        }
        require_end();
        return false;
    }
    /// The halves of advance(), for callers that go on after a damaged page and compare the
    /// intervals themselves.
    bool fetch() {
        host_.poll();
        abacus_page page{};
        if (!host_.next(ABACUS_SIMPLEX_PAGES, started_ ? &key_ : nullptr, page)) return false;
        started_ = true;
        ++pages_read_;
        key_ = page.key;
        size_ = page.size;
        std::memcpy(copy_, page.bytes, std::min(size_, sizeof copy_));
        return true;
    }
    void parse() { view_.read(copy_, size_, attributes_); }
    /// Key under which the current page is stored, and its bytes.
    const Key &key() const { return key_; }
    const unsigned char *bytes() const { return copy_; }
    std::size_t size() const { return size_; }
    const PageView<D> &page() const { return view_; }
    std::uint64_t pages_read() const { return pages_read_; }

private:
    void follow() {
        if (!(view_.lower() == key_)) throw_corrupted("A page is stored under another page's key.");
        if (!(key_ == expected_))
            throw_corrupted("The pages leave out or share a part of the curve.");
        expected_ = view_.upper();
        const auto here = static_cast<std::uint64_t>(view_.simplices());
        if (here > left_) throw_corrupted(other_count);
        left_ -= here;
    }
    void require_end() const {
        if (started_ && !(expected_ == end_key))
            throw_corrupted("The last page does not reach the end of the curve.");
        if (left_ != 0) throw_corrupted(other_count);
    }

    static constexpr const char *other_count =
        "The header counts other simplices than the pages hold.";

    const Host &host_;
    int attributes_;
    std::uint64_t left_; // simplices and ghosts that the header counts beyond the current page
    Key expected_ = first_key;
    bool started_ = false;
    std::uint64_t pages_read_ = 0;
    Key key_{};
    std::size_t size_ = 0;
    PageView<D> view_;
    alignas(8) unsigned char copy_[ABACUS_PAGE_BYTES];
};

} // namespace abacus
