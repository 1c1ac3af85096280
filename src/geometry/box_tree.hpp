// Boxes found by where they are: a packed R-tree in flat arrays.
//
// Boxes come in the order of a space-filling curve, so that neighbours in the list are
// neighbours in space. Each node is the box of `fan` consecutive ones below it, and no
// pointers are needed (Kamel and Faloutsos, "On Packing R-trees", 1993).
#pragma once

#include "geometry/box.hpp"
#include "host/arena.hpp"

#include <algorithm>

namespace abacus {

template <int D> class BoxTree {
public:
    static constexpr std::size_t fan = 8;
    /// Memory for a box and its share of the nodes above, bytes.
    static constexpr std::size_t bytes_per_box = sizeof(Box<D>) * fan / (fan - 1) + 1;

    explicit BoxTree(const Host &host) : boxes_(host) {}

    void clear() {
        boxes_.clear();
        size_ = 0;
        levels_ = 0;
    }
    void add(const Box<D> &box) { boxes_.push_back(box); }
    /// After the last add(): makes the nodes.
    void finish() {
        size_ = boxes_.size();
        levels_ = 0;
        for (std::size_t begin = 0, end = size_;;) {
            begin_[levels_++] = begin;
            if (end - begin <= 1) break;
            for (std::size_t i = begin; i < end; i += fan) {
                Box<D> node = boxes_[i];
                for (std::size_t k = i + 1; k < std::min(i + fan, end); ++k) node.extend(boxes_[k]);
                boxes_.push_back(node);
            }
            begin = end;
            end = boxes_.size();
        }
    }
    std::size_t size() const { return size_; }

    /// Calls visit(number) for each box that meets `box`, in order, until it returns
    /// false; returns whether it did not.
    template <class Visit> bool visit(const Box<D> &box, Visit visit) const {
        return size_ == 0 || visit_node(levels_ - 1, 0, box, visit);
    }

private:
    template <class Visit>
    bool visit_node(int level, std::size_t i, const Box<D> &box, Visit &visit) const {
        if (!boxes_[begin_[level] + i].meets(box)) return true;
        if (level == 0) return visit(i);
        const std::size_t below = begin_[level] - begin_[level - 1];
        for (std::size_t k = i * fan; k < std::min((i + 1) * fan, below); ++k)
            if (!visit_node(level - 1, k, box, visit)) return false;
        return true;
    }

    Arena<Box<D>> boxes_; // those added, then each level of nodes
    std::size_t size_ = 0;
    std::size_t begin_[24]; // of each level in boxes_
    int levels_ = 0;
};

} // namespace abacus
