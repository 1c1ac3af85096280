// Simplices as users see them. The order of the corners in memory depends on how a
// simplex came about; what is handed out does not: positive orientation, the least
// corner first (by id, then coordinates), in 3D the second least next.
#pragma once

#include "geometry/point.hpp"

#include <abacus/abacus.h>

#include <algorithm>
#include <utility>

namespace abacus {

template <int D> class SimplexWriter {
public:
    SimplexWriter(abacus_simplex &simplex, std::uint64_t code, bool ghost) : out_(simplex) {
        out_.code = code;
        out_.ghost = ghost;
    }

    void corner(int i, std::int64_t id, const Point<D> &p) {
        out_.id[i] = id;
        std::copy(p.begin(), p.end(), out_.corner[i]);
    }

    /// Even permutations only, so that the orientation stays; the point at infinity
    /// stays last.
    void finish() {
        if (out_.ghost) {
            if constexpr (D == 3) rotate(0, least(0, 3));
            return;
        }
        const int first = least(0, D + 1);
        if constexpr (D == 2) {
            rotate(0, first);
        } else {
            if (first != 0) { // two transpositions
                swap(0, first);
                swap(first == 1 ? 2 : 1, first == 3 ? 2 : 3);
            }
            rotate(1, least(1, 4));
        }
    }

private:
    bool less(int i, int j) const {
        if (out_.id[i] != out_.id[j]) return out_.id[i] < out_.id[j];
        return std::lexicographical_compare(out_.corner[i], out_.corner[i] + D, out_.corner[j],
                                            out_.corner[j] + D);
    }
    int least(int from, int to) const {
        int best = from;
        for (int i = from + 1; i < to; ++i)
            if (less(i, best)) best = i;
        return best;
    }
    void swap(int i, int j) {
        std::swap(out_.id[i], out_.id[j]);
        std::swap(out_.corner[i], out_.corner[j]);
    }
    /// Rotates the three corners from `from` on until `first` leads them.
    void rotate(int from, int first) {
        for (; first > from; --first) {
            swap(from, from + 1);
            swap(from + 1, from + 2);
        }
    }

    abacus_simplex &out_;
};

/// Order among the simplices that contain one point: by code, then ids, then corners.
template <int D> bool comes_before(const abacus_simplex &a, const abacus_simplex &b) {
    if (a.code != b.code) return a.code < b.code;
    for (int i = 0; i <= D; ++i)
        if (a.id[i] != b.id[i]) return a.id[i] < b.id[i];
    for (int i = 0; i <= D; ++i)
        if (const auto &p = a.corner[i], &q = b.corner[i]; !std::equal(p, p + D, q))
            return std::lexicographical_compare(p, p + D, q, q + D);
    return false;
}

} // namespace abacus
