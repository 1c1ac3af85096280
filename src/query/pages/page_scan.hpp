// All pages of a mesh in key order, without a cache.
//
// The header has the counts of what is in the pages: advance() compares these, too
// (blocks/page_cursor.hpp).
#pragma once

#include "blocks/page_cursor.hpp"
#include "mesh/page_attributes.hpp"
#include "mesh/page_format.hpp"

#include <abacus/facts.h>

namespace abacus {

inline constexpr const char *other_vertex_count =
    "The header counts more or fewer vertices than the pages hold.";

template <int D> class PageScan {
public:
    PageScan(const Host &host, const abacus_facts &facts)
        : cursor_(host, ABACUS_SIMPLEX_PAGES, "mesh"), attributes_(page_attributes(facts.columns)),
          left_(facts.census.simplices + facts.census.ghosts) {}

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
    /// The same, but skips pages that wants(page) refuses; only the heads of these are read.
    template <class Wants> bool advance(Wants wants) {
        while (fetch()) {
            view_.open(bytes(), size(), attributes_);
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
    bool fetch() { return cursor_.fetch(); }
    void parse() { view_.read(bytes(), size(), attributes_); }
    /// Key under which the current page is stored, and its bytes.
    const Key &key() const { return cursor_.key(); }
    const unsigned char *bytes() const { return cursor_.bytes(); }
    std::size_t size() const { return cursor_.size(); }
    const PageView<D> &page() const { return view_; }
    std::uint64_t pages_read() const { return cursor_.pages_read(); }

private:
    void follow() {
        cursor_.follow(view_.lower(), view_.upper());
        const auto here = static_cast<std::uint64_t>(view_.simplices());
        if (here > left_) throw_corrupted(other_count);
        left_ -= here;
    }
    void require_end() const {
        cursor_.require_end();
        if (left_ != 0) throw_corrupted(other_count);
    }

    static constexpr const char *other_count =
        "The header counts more or fewer simplices than the pages hold.";

    PageCursor cursor_;
    int attributes_;
    std::uint64_t left_; // simplices and ghosts that the header counts beyond the current page
    PageView<D> view_;
};

} // namespace abacus
