// The boxes of the pages of a mesh, in memory, to find the pages around a point.
//
// They are needed where walking does not lead to a point, in a mesh with holes or several pieces,
// and made when this first happens, in one pass over all pages. There is one box per page, about
// 0.2 bytes per simplex; if that exceeds the bound, one box for every two, four, ... pages.
#pragma once

#include "geometry/box_tree.hpp"
#include "query/pages/page_scan.hpp"

#include <functional>

namespace abacus {

template <int D> class PageBoxes {
public:
    /// `visit`, unless it is empty, gets each page, so that no other pass is needed.
    PageBoxes(const Host &host, const abacus_facts &facts, std::size_t bytes,
              const std::function<void(const PageView<D> &)> &visit = {});

    /// Calls visit(from, to) for intervals of keys, which end at pages; no page outside them has p
    /// in its box. Stops when it returns false.
    template <class Visit> void around(const Point<D> &p, Visit visit) const {
        meeting({p, p}, visit);
    }
    /// The same for pages whose boxes meet a box.
    template <class Visit> void meeting(const Box<D> &box, Visit visit) const {
        tree_.visit(box, [&](std::size_t i) {
            return visit(keys_[i], i + 1 < keys_.size() ? keys_[i + 1] : end_key);
        });
    }
    /// The number of boxes, and where the pages of a box begin; those of the last end with the
    /// curve.
    std::size_t size() const { return keys_.size(); }
    Key begin(std::size_t i) const { return i < keys_.size() ? keys_[i] : end_key; }
    /// Which box the page that owns the key belongs to.
    std::size_t of(const Key &key) const {
        const auto *const above = std::partition_point(
            keys_.begin(), keys_.end(), [&key](const Key &begin) { return begin <= key; });
        return static_cast<std::size_t>(above - keys_.begin()) - (above != keys_.begin() ? 1 : 0);
    }
    /// Calls visit(number) for the boxes that meet a box, in order, until it returns false; returns
    /// whether it did not.
    template <class Visit> bool numbers(const Box<D> &box, Visit visit) const {
        return tree_.visit(box, visit);
    }
    /// The box around all of them.
    Box<D> around_all() const { return tree_.around_all(); }
    /// Calls visit(from, to, rank) for all such intervals in the order of rank(box), until it
    /// returns false, as in BoxTree::visit_by_rank().
    template <class Rank, class Visit>
    void by_rank(std::pmr::memory_resource &memory, Rank rank, Visit visit) const {
        tree_.visit_by_rank(memory, rank, [&](std::size_t i, double rank_of_box) {
            return visit(keys_[i], i + 1 < keys_.size() ? keys_[i + 1] : end_key, rank_of_box);
        });
    }

private:
    void halve();

    Arena<Key> keys_; // of the first page of each box
    Arena<Box<D>> boxes_;
    BoxTree<D> tree_;
};

extern template class PageBoxes<2>;
extern template class PageBoxes<3>;

} // namespace abacus
