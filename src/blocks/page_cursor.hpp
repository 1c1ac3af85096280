// All pages of a kind in the order of their keys, past any cache. The current page is a copy, since
// the host's bytes do not outlive its next call, and a scan may be held between calls of its user.
//
// No page knows its neighbours on the curve, so a page that is lost leaves no trace in the others.
// But their intervals follow one another without a gap from end to end: follow() and require_end()
// compare them.
#pragma once

#include "host/host.hpp"
#include "keys/key.hpp"

#include <algorithm>
#include <cstring>

namespace abacus {

class PageCursor {
public:
    /// `whole` is what the pages are of, for messages.
    PageCursor(const Host &host, abacus_page_kind kind, const char *whole)
        : host_(host), kind_(kind), whole_(whole) {}

    /// The next page; false after the last.
    bool fetch() {
        host_.poll();
        abacus_page page{};
        if (!host_.next(kind_, started_ ? &last_ : nullptr, page)) return false;
        started_ = true;
        ++pages_read_;
        bytes_read_ += page.size;
        last_ = key_ = page.key;
        size_ = page.size;
        location_ = page.location;
        std::memcpy(copy_, page.bytes, std::min(size_, sizeof copy_));
        return true;
    }
    /// Throws Error (corrupted) unless the current page, which tells its interval, is stored under
    /// the lower end and follows the page before.
    void follow(const Key &lower, const Key &upper) {
        if (!(lower == key_)) refuse("A page is stored under another page's key.");
        if (!(key_ == expected_)) refuse("The pages leave out or share a part of the curve.");
        expected_ = upper;
    }
    /// The same unless the last page reaches the end of the curve.
    void require_end() const {
        if (started_ && !(expected_ == end_key))
            refuse("The last page does not reach the end of the curve.");
    }
    /// The current page has become several: goes on behind its interval.
    void pass_interval() { last_ = predecessor(expected_); }

    /// Key under which the current page is stored, its bytes, and where it is.
    const Key &key() const { return key_; }
    const unsigned char *bytes() const { return copy_; }
    std::size_t size() const { return size_; }
    std::uint64_t location() const { return location_; }
    std::uint64_t pages_read() const { return pages_read_; }
    std::uint64_t bytes_read() const { return bytes_read_; }

private:
    [[noreturn]] void refuse(const char *detail) const { throw_corrupted(detail, whole_); }

    const Host &host_;
    abacus_page_kind kind_;
    const char *whole_;
    Key expected_ = first_key;
    bool started_ = false;
    std::uint64_t pages_read_ = 0, bytes_read_ = 0, location_ = 0;
    Key key_{}, last_{}; // the next page is behind the latter
    std::size_t size_ = 0;
    alignas(8) unsigned char copy_[ABACUS_PAGE_BYTES];
};

} // namespace abacus
