#include "octree/octree_interpolation.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {
namespace {

double between(double a, double b, double share) { return a == b ? a : std::lerp(a, b, share); }

} // namespace

template <int D> bool OctreeInterpolation<D>::values(const Point<D> &place, double *values) {
    const Handle h = reader_.locate(place);
    if (h == no_handle) return false;
    const Octant<D> leaf = reader_.cache().octant(h);
    if (!(leaf_ == leaf)) {
        keys_.clear();
        values_.clear();
        leaf_ = leaf;
    }
    const auto [lower, upper] = reader_.grid().box(leaf);
    Share share;
    for (int i = 0; i < D; ++i)
        share[i] = lower[i] < upper[i]
                       ? std::min((place[i] - lower[i]) / (upper[i] - lower[i]), 1.0)
                       : 0.0;
    inside(leaf, share, values);
    return true;
}

// Corners without a share are ignored: they need not have values.
template <int D>
void OctreeInterpolation<D>::inside(const Octant<D> &leaf, const Share &share, double *values) {
    std::array<std::size_t, corners> nodes{};
    std::array<bool, corners> counts;
    for (int c = 0; c < corners; ++c) {
        counts[c] = true;
        for (int i = 0; i < D; ++i) counts[c] &= share[i] != ((c >> i & 1) != 0 ? 0 : 1);
        if (counts[c]) nodes[c] = node(corner(leaf, c));
    }
    for (std::uint32_t a = 0; a < count_; ++a) {
        std::array<double, corners> at;
        for (int c = 0; c < corners; ++c) at[c] = counts[c] ? values_[nodes[c] * count_ + a] : NAN;
        for (int i = D - 1; i >= 0; --i)
            for (int c = 0; c < 1 << i; ++c) {
                const double below = at[c], above = at[c + (1 << i)];
                at[c] = share[i] == 0   ? below
                        : share[i] == 1 ? above
                                        : between(below, above, share[i]);
            }
        values[a] = at[0];
    }
}

template <int D> std::size_t OctreeInterpolation<D>::node(const GridPoint<D> &point) {
    const NodeKey key = node_key<D>(point);
    const auto known = std::find(keys_.begin(), keys_.end(), key);
    if (known != keys_.end()) return static_cast<std::size_t>(known - keys_.begin());
    std::array<double, ABACUS_MAX_ATTRIBUTES> values;
    if (const auto larger = look_around(point, values.data())) {
        const Cell<D> at = larger->cell();
        Share share;
        for (int i = 0; i < D; ++i)
            share[i] = static_cast<double>(point[i] - at[i]) / static_cast<double>(larger->edge());
        inside(*larger, share, values.data());
    }
    keys_.push_back(key);
    std::copy_n(values.begin(), count_, values_.extend(count_));
    return keys_.size() - 1;
}

template <int D>
std::optional<Octant<D>> OctreeInterpolation<D>::look_around(const GridPoint<D> &point,
                                                             double *values) {
    std::optional<Octant<D>> largest;
    const double share = 1.0 / static_cast<double>(orthants<D>(point));
    std::fill_n(values, count_, 0.0);
    for (int orthant = 0; orthant < corners; ++orthant) {
        const auto cell = cell_around<D>(point, orthant);
        if (!cell) continue;
        const Handle h = reader_.find(*cell);
        const Octant<D> leaf = reader_.cache().octant(h);
        const Cell<D> at = leaf.cell();
        bool is_corner = true;
        for (int i = 0; i < D; ++i)
            is_corner &= point[i] == at[i] || point[i] == at[i] + leaf.edge();
        if (!is_corner && (!largest || leaf.level < largest->level)) largest = leaf;
        for (std::uint32_t a = 0; a < count_; ++a)
            values[a] += reader_.cache().values(h)[attributes_[a]] * share;
    }
    return largest;
}

template class OctreeInterpolation<2>;
template class OctreeInterpolation<3>;

} // namespace abacus
