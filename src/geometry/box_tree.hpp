// Boxes found by where they are: a packed R-tree in flat arrays.
//
// Boxes come in the order of a space-filling curve, so that neighbours in the list are
// neighbours in space. Each node is the box of `fan` consecutive ones below it, and no
// pointers are needed (Kamel and Faloutsos, "On Packing R-trees", 1993).
#pragma once

#include "geometry/box.hpp"
#include "host/arena.hpp"

#include <algorithm>
#include <memory_resource>
#include <vector>

namespace abacus {

template <int D> class BoxTree {
public:
    static constexpr std::size_t fan = 8;
    /// Memory for a box and its share of the nodes above, bytes.
    static constexpr std::size_t bytes_per_box = sizeof(Box<D>) * fan / (fan - 1) + 1;

    explicit BoxTree(const Memory &memory) : boxes_(memory) {}

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
    /// The box around all of them; empty without any.
    Box<D> around_all() const { return size_ == 0 ? Box<D>() : boxes_[begin_[levels_ - 1]]; }

    /// Calls visit(number) for each box that meets `box`, in order, until it returns
    /// false; returns whether it did not.
    template <class Visit> bool visit(const Box<D> &box, Visit visit) const {
        return size_ == 0 || visit_node(levels_ - 1, 0, box, visit);
    }

    /// Calls visit(number, rank) for the boxes in the order of rank(box), until that returns false;
    /// no box may have a lower rank than a box around it. Keeps what it has not come to in
    /// `memory`.
    template <class Rank, class Visit>
    void visit_by_rank(std::pmr::memory_resource &memory, Rank rank, Visit visit) const {
        struct Open {
            double rank;
            int level;
            std::size_t i;
            bool operator<(const Open &other) const { return other.rank < rank; }
        };
        std::pmr::vector<Open> open(&memory); // a heap
        const auto add = [&](int level, std::size_t i) {
            open.push_back({rank(boxes_[begin_[level] + i]), level, i});
            std::push_heap(open.begin(), open.end());
        };
        if (size_ > 0) add(levels_ - 1, 0);
        while (!open.empty()) {
            std::pop_heap(open.begin(), open.end());
            const Open next = open.back();
            open.pop_back();
            if (next.level == 0) {
                if (!visit(next.i, next.rank)) return;
                continue;
            }
            const std::size_t end = std::min((next.i + 1) * fan, boxes_at(next.level - 1));
            for (std::size_t k = next.i * fan; k < end; ++k) add(next.level - 1, k);
        }
    }

private:
    /// Nodes of a level below the last.
    std::size_t boxes_at(int level) const { return begin_[level + 1] - begin_[level]; }

    template <class Visit>
    bool visit_node(int level, std::size_t i, const Box<D> &box, Visit &visit) const {
        if (!boxes_[begin_[level] + i].meets(box)) return true;
        if (level == 0) return visit(i);
        for (std::size_t k = i * fan; k < std::min((i + 1) * fan, boxes_at(level - 1)); ++k)
            if (!visit_node(level - 1, k, box, visit)) return false;
        return true;
    }

    Arena<Box<D>> boxes_; // those added, then each level of nodes
    std::size_t size_ = 0;
    std::size_t begin_[24]; // of each level in boxes_
    int levels_ = 0;
};

} // namespace abacus
