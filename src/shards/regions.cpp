#include "shards/regions.hpp"

#include "geometry/ordered.hpp"

namespace abacus {

template <int D>
ShardRegions<D>::ShardRegions(const Memory &memory, const Domain<D> &domain,
                              std::span<const std::uint64_t> borders, const Box<D> &extent)
    : domain_(domain), borders_(memory), extent_(extent), nodes_(memory) {
    for (const std::uint64_t border : borders) borders_.push_back(border);
    nodes_.push_back(node_of({}, code_bits<D>));
    divide(0, {}, code_bits<D>);
}

/// Gives a mixed node its children; they are the cells of half its side.
template <int D> void ShardRegions<D>::divide(std::uint32_t node, const Cell<D> &cell, int bits) {
    if (nodes_[node].owner != mixed) return;
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = first;
    const auto child_cell = [&](int child) {
        Cell<D> lower = cell;
        for (int i = 0; i < D; ++i)
            lower[i] |= static_cast<std::uint32_t>(child >> i & 1) << (bits - 1);
        return lower;
    };
    for (int child = 0; child < children; ++child)
        nodes_.push_back(node_of(child_cell(child), bits - 1));
    for (int child = 0; child < children; ++child)
        divide(first + static_cast<std::uint32_t>(child), child_cell(child), bits - 1);
}

/// The cell has 2^bits codes on each axis. They are one stretch of the curve.
template <int D>
typename ShardRegions<D>::Node ShardRegions<D>::node_of(const Cell<D> &cell, int bits) const {
    const std::uint64_t codes = std::uint64_t{1} << (D * bits);
    const std::uint64_t least = curve_code<D>(cell) & ~(codes - 1);
    const std::uint32_t from = owner(least), to = owner(least + codes - 1);
    return {box_of(cell, bits), from == to ? from : mixed, 0};
}

template <int D> Box<D> ShardRegions<D>::box_of(const Cell<D> &cell, int bits) const {
    Box<D> box;
    for (int i = 0; i < D; ++i) {
        box.lower[i] = begin_of(i, cell[i]);
        box.upper[i] = end_of(i, cell[i] + (std::uint32_t{1} << bits) - 1);
    }
    return box;
}

/// The least coordinate of the extent in this cell or a higher one; the greatest, if none is.
template <int D> double ShardRegions<D>::begin_of(int axis, std::uint32_t cell) const {
    Point<D> p = extent_.lower;
    const auto is_below = [&](double x) {
        p[axis] = x;
        return domain_.cell(p)[axis] < cell;
    };
    // Halved in the order of all doubles, of which there may be many between 0 and any other.
    std::uint64_t least = ordered(extent_.lower[axis]), most = ordered(extent_.upper[axis]);
    while (least < most) {
        const std::uint64_t middle = least + (most - least) / 2;
        if (is_below(from_ordered(middle)))
            least = middle + 1;
        else
            most = middle;
    }
    return from_ordered(least);
}

/// The greatest coordinate of the extent in this cell or a lower one; the least, if none is.
template <int D> double ShardRegions<D>::end_of(int axis, std::uint32_t cell) const {
    Point<D> p = extent_.lower;
    const auto is_above = [&](double x) {
        p[axis] = x;
        return domain_.cell(p)[axis] > cell;
    };
    std::uint64_t least = ordered(extent_.lower[axis]), most = ordered(extent_.upper[axis]);
    while (least < most) {
        const std::uint64_t middle = least + (most - least + 1) / 2;
        if (is_above(from_ordered(middle)))
            most = middle - 1;
        else
            least = middle;
    }
    return from_ordered(least);
}

template <int D>
bool ShardRegions<D>::meets_half_space(const Corners<D> &corners, const Box<D> &box,
                                       const Box<D> &touched) {
    bool touches = false;
    for (int i = 0; i < children; ++i) {
        // The last corner of a ghost lies on the far side of its facet: so does what it conflicts
        // with.
        const Point<D> corner = box.corner(i);
        const int side = facet_side<D>(corners, D, corner);
        if (side > 0) return true;
        touches |= side == 0;
    }
    return touches && may_meet<D>(touched, box);
}

template class ShardRegions<2>;
template class ShardRegions<3>;

} // namespace abacus
