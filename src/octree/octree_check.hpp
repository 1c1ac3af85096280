// Verification of a stored octree: every page decodes and has the checksum of its bytes, the
// intervals partition the curve, leaves tile the domain and are no finer than may be, and the
// header counts them.
#pragma once

#include "blocks/fault_list.hpp"
#include "blocks/page_cursor.hpp"
#include "octree/octant_page.hpp"

namespace abacus {

template <int D> class OctreeCheck {
public:
    /// Verifies at once; keeps at most `limit` faults.
    OctreeCheck(const Host &host, const abacus_facts &facts, std::size_t limit)
        : host_(host), facts_(facts), faults_(host, limit) {
        check_pages();
    }

    /// False after the last fault.
    bool next(abacus_fault &fault) { return faults_.next(fault); }

private:
    void check_pages();
    void check_leaves();

    const Host &host_;
    const abacus_facts &facts_;
    FaultList faults_;
    OctantPageView<D> view_;
    std::uint64_t leaves_ = 0;
    std::uint64_t upper_ = 0; // of the page before
    std::uint64_t end_ = 0;   // where its last leaf ends
    bool is_known_ = true;    // ... unless it could not be read
};

template <int D> void OctreeCheck<D>::check_pages() {
    PageCursor pages(host_, ABACUS_OCTANT_PAGES, "octree");
    while (pages.fetch()) {
        faults_.at = pages.key();
        bool is_read = false; // the list of faults may be full, so its length does not tell
        faults_.run("page", [&] {
            view_.read(pages.bytes(), pages.size(), static_cast<int>(facts_.columns.attributes));
            is_read = true;
        });
        if (is_read)
            check_leaves();
        else
            is_known_ = false;
        const std::uint64_t n = pages.pages_read();
        if (n % 64 == 0) host_.progress({ABACUS_PHASE_CHECKING, n, 0, n, 0, 0});
    }
    if (!is_known_) return;
    if (upper_ != key_word_end) faults_.add("interval", "Pages do not reach the end of the curve.");
    if (end_ != domain_cells<D>) faults_.add("leaf", "Leaves do not reach the end of the domain.");
    if (faults_.size() == 0 && leaves_ != facts_.census.leaves)
        faults_.add("count", "The header counts more or fewer leaves than there are.");
}

template <int D> void OctreeCheck<D>::check_leaves() {
    if (!(faults_.at == Key{view_.lower(), 0}))
        faults_.add("interval", "A page is stored under another page's key.");
    if (is_known_ && view_.lower() != upper_)
        faults_.add("interval", "Two pages own the same part of the curve, or none does.");
    if (is_known_ && view_.leaves() > 0 && view_.first() != end_)
        faults_.add("leaf", "A page does not begin where the leaves before it end.");
    upper_ = view_.upper();
    if (view_.leaves() > 0) end_ = view_.first();
    for (std::uint32_t i = 0; i < view_.leaves(); ++i) {
        end_ += cells_at<D>(view_.level(i));
        if (view_.level(i) > static_cast<int>(facts_.form.levels))
            faults_.add("leaf", "A leaf is finer than leaves of this octree may be.");
    }
    leaves_ += view_.leaves();
    is_known_ = is_known_ || view_.leaves() > 0;
}

} // namespace abacus
