// Verification of a stored octree: every page decodes and has the checksum of its bytes, the
// intervals partition the curve, leaves tile the domain and are no finer than may be, and the
// header counts them.
#pragma once

#include "host/host.hpp"
#include "host/memory_resource.hpp"
#include "octree/octant_page.hpp"

#include <abacus/read.h>

#include <cstdio>
#include <memory_resource>
#include <vector>

namespace abacus {

template <int D> class OctreeCheck {
public:
    /// Verifies at once; keeps at most `limit` faults.
    OctreeCheck(const Host &host, const abacus_header &header, std::size_t, std::size_t limit)
        : host_(host), header_(header), limit_(limit), memory_(host), faults_(&memory_) {
        check_pages();
    }

    /// False after the last fault.
    bool next(abacus_fault &fault) {
        if (at_ == faults_.size()) return false;
        fault = faults_[at_++];
        return true;
    }

private:
    void check_pages();
    void check_leaves();
    void fault(const char *kind, const char *message) {
        if (faults_.size() >= limit_) return;
        abacus_fault fault{key_, kind, {}};
        std::snprintf(fault.message, sizeof fault.message, "%s", message);
        faults_.push_back(fault);
    }

    const Host &host_;
    const abacus_header &header_;
    const std::size_t limit_;
    HostMemory memory_;
    std::pmr::vector<abacus_fault> faults_;
    std::size_t at_ = 0;
    OctantPageView<D> view_;
    Key key_{}; // of the current page
    std::uint64_t leaves_ = 0;
    std::uint64_t upper_ = 0; // of the page before
    std::uint64_t end_ = 0;   // where its last leaf ends
    bool is_known_ = true;    // ... unless it could not be read
};

template <int D> void OctreeCheck<D>::check_pages() {
    std::uint64_t pages = 0;
    abacus_page page{};
    for (bool found = host_.next(ABACUS_OCTANT_PAGES, nullptr, page); found;
         found = host_.next(ABACUS_OCTANT_PAGES, &key_, page)) {
        key_ = page.key;
        try {
            view_.read(page.bytes, page.size, static_cast<int>(header_.attributes));
            check_leaves();
        } catch (const Error &error) {
            if (error.kind != ABACUS_ERROR_CORRUPTED) throw;
            fault("page", error.detail.c_str());
            is_known_ = false;
        }
        if (++pages % 64 == 0) host_.progress({ABACUS_PHASE_CHECKING, pages, 0, pages, 0, 0});
        host_.poll();
    }
    if (!is_known_) return;
    if (upper_ != key_word_end) fault("interval", "Pages do not reach the end of the curve.");
    if (end_ != domain_cells<D>) fault("leaf", "Leaves do not reach the end of the domain.");
    if (faults_.empty() && leaves_ != header_.leaves)
        fault("count", "The header counts other leaves than there are.");
}

template <int D> void OctreeCheck<D>::check_leaves() {
    if (!(key_ == Key{view_.lower(), 0}))
        fault("interval", "A page is stored under another page's key.");
    if (is_known_ && view_.lower() != upper_)
        fault("interval", "Two pages own the same part of the curve, or none does.");
    if (is_known_ && view_.leaves() > 0 && view_.first() != end_)
        fault("leaf", "A page begins where the leaves before do not end.");
    upper_ = view_.upper();
    if (view_.leaves() > 0) end_ = view_.first();
    for (std::uint32_t i = 0; i < view_.leaves(); ++i) {
        end_ += cells_at<D>(view_.level(i));
        if (view_.level(i) > static_cast<int>(header_.levels))
            fault("leaf", "A leaf is finer than leaves of this octree may be.");
    }
    leaves_ += view_.leaves();
    is_known_ = is_known_ || view_.leaves() > 0;
}

} // namespace abacus
