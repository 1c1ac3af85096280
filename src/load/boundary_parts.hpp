// Parts of a boundary that are held in memory one after the other, and what each is compared with.
//
// A boundary that does not fit would have to be compared with everything as often as it is larger
// than the memory. But facets come along the curve, so a part of them fills a small region. So the
// regions of some parts are kept, as boxes around a few facets each, and whatever meets one of them
// is put aside for that part. All is read once for many parts, and each part gets what is near it.
#pragma once

#include "geometry/box_tree.hpp"
#include "host/memory_resource.hpp"
#include "load/records.hpp"
#include "sort/record_spool.hpp"

#include <deque>
#include <memory_resource>

namespace abacus {

template <int D> class BoundaryParts {
    static constexpr std::uint64_t boxes_a_part = 256;

public:
    /// Of so many parts at most, of `facets` facets each; with spools for records of so many words.
    BoundaryParts(const Host &host, std::size_t parts, std::uint64_t facets, std::size_t simplex,
                  std::size_t boundary)
        : facets_(facets), each_(facets / boxes_a_part + 1), memory_(host), tree_(host),
          simplices_(&memory_), others_(&memory_) {
        for (std::size_t i = 0; i < parts; ++i) {
            simplices_.emplace_back(host, simplex);
            others_.emplace_back(host, boundary);
        }
    }
    /// What the spools of a part take while they are filled, and its boxes.
    static constexpr std::size_t bytes_a_part =
        std::size_t{2} * ((64 << 10) + 8192) + boxes_a_part * BoxTree<D>::bytes_per_box;

    /// Adds the next facet, by its box.
    void add(const Box<D> &facet) {
        box_.extend(facet);
        ++added_;
        if (added_ % facets_ % each_ == 0) end_box();
    }
    void finish() {
        if (added_ % facets_ % each_ != 0) end_box();
        tree_.finish();
    }
    /// Facets that there may be.
    std::uint64_t most() const { return simplices_.size() * facets_; }
    std::size_t size() const { return static_cast<std::size_t>((added_ + facets_ - 1) / facets_); }
    /// Of the i-th facet that was added.
    std::size_t part_of(std::uint64_t i) const { return static_cast<std::size_t>(i / facets_); }
    /// Calls visit(part) for each part that a box may meet.
    template <class Visit> void each_near(const Box<D> &box, Visit visit) const {
        std::size_t next = 0; // none before it is visited any more
        tree_.visit(box, [&](std::size_t i) {
            const std::size_t part = i / boxes_of_part();
            if (part >= next) visit(part);
            next = std::max(next, part + 1);
            return true;
        });
    }
    /// What has been put aside for a part.
    RecordSpool &simplices(std::size_t part) { return simplices_[part]; }
    RecordSpool &others(std::size_t part) { return others_[part]; }
    void rewind() {
        for (RecordSpool &spool : simplices_) spool.rewind();
        for (RecordSpool &spool : others_) spool.rewind();
    }
    void close() {
        for (RecordSpool &spool : simplices_) spool.close();
        for (RecordSpool &spool : others_) spool.close();
    }

private:
    std::size_t boxes_of_part() const {
        return static_cast<std::size_t>((facets_ + each_ - 1) / each_);
    }
    void end_box() {
        tree_.add(box_);
        box_ = Box<D>();
    }

    const std::uint64_t facets_, each_; // of a part, of a box
    HostMemory memory_;
    Box<D> box_;
    std::uint64_t added_ = 0;
    BoxTree<D> tree_;
    std::pmr::deque<RecordSpool> simplices_, others_;
};

} // namespace abacus
