#include "geometry/cell_shape.hpp"

#include "geometry/distance.hpp"

#include <cmath>

namespace abacus {

template <int D> void CellShape<D>::begin(const Point<D> &vertex) {
    vertex_ = vertex;
    neighbours_.clear();
    corners_.clear();
    faces_.clear();
}

// ---- The window -------------------------------------------------------------------------

template <> void CellShape<2>::fill(const Box<2> &window) {
    window_ = window;
    const auto &[lower, upper] = window;
    add_face(no_label);
    add_corner(lower, side_label(2));
    add_corner({upper[0], lower[1]}, side_label(1));
    add_corner(upper, side_label(3));
    add_corner({lower[0], upper[1]}, side_label(0));
}

template <> void CellShape<3>::fill(const Box<3> &window) {
    window_ = window;
    // Around the upper side of an axis: for each corner, the ends of the next two axes. `beyond`
    // has the side across the edge to the next corner. The lower side goes the other way.
    constexpr int ends[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
        const int beyond[4] = {2 * c, 2 * b + 1, 2 * c + 1, 2 * b};
        const bool is_upper = side % 2 == 1;
        add_face(side_label(side));
        for (int i = 0; i < 4; ++i) {
            const int at = is_upper ? i : 3 - i;
            Point<3> corner;
            corner[axis] = side_value(window, side);
            corner[b] = side_value(window, 2 * b + ends[at][0]);
            corner[c] = side_value(window, 2 * c + ends[at][1]);
            add_corner(corner, side_label(beyond[is_upper ? i : (at + 3) % 4]));
        }
    }
}

// ---- Cuts -------------------------------------------------------------------------------

template <int D> bool CellShape<D>::keeps(const Point<D> &at, const Point<D> &neighbour) const {
    double along = 0, size = 0;
    for (int i = 0; i < D; ++i) {
        const double edge = neighbour[i] - vertex_[i];
        const double part = (at[i] - vertex_[i] - edge / 2) * edge;
        along += part;
        size += std::fabs(part);
    }
    if (size > 1e-250 && size < 1e250) [[likely]]
        return along <= 0;
    return compare_distance<D>(at, vertex_, neighbour) <= 0; // products underflow, or overflow
}

template <int D>
Point<D> CellShape<D>::crossing(int face, int edge, int cut, const Corner &inside,
                                const Corner &outside) const {
    Equidistant<D> meeting;
    meeting.add(vertex_);
    const auto add = [&](int label) {
        if (label >= 0)
            meeting.add(neighbours_[static_cast<std::size_t>(label)]);
        else
            meeting.add_side(-1 - label, side_value(window_, -1 - label));
    };
    if (D == 3) add(face);
    add(edge);
    add(cut);
    Point<D> at = meeting.place(Rounding::whenever).value_or(outside.at);
    for (int i = 0; i < D; ++i)
        at[i] = std::clamp(at[i], std::min(inside.at[i], outside.at[i]),
                           std::max(inside.at[i], outside.at[i]));
    return at;
}

template <int D> void CellShape<D>::cut_face(const Face &face, int neighbour) {
    const Point<D> &beyond = neighbours_[static_cast<std::size_t>(neighbour)];
    const std::size_t size = face.end - face.begin, first_entry = entries_.size();
    int left = no_label; // the edge where the walk left the half-space, until it enters it again
    int left_first = no_label;
    add_cut_face(face.label);
    for (std::size_t i = 0; i < size; ++i) {
        const Corner &from = corners_[face.begin + i];
        const Corner &to = corners_[face.begin + (i + 1) % size];
        const bool is_in = keeps(from.at, beyond), is_next_in = keeps(to.at, beyond);
        if (is_in) add_cut_corner(from);
        if (is_in == is_next_in) continue;
        const Corner &inside = is_in ? from : to, &outside = is_in ? to : from;
        const Point<D> at = crossing(face.label, from.next, neighbour, inside, outside);
        add_cut_corner({at, is_in ? neighbour : from.next});
        if (is_in) {
            left = from.next;
        } else {
            if (left == no_label) left_first = static_cast<int>(entries_.size());
            entries_.push_back({face.label, from.next, left, at});
            left = no_label;
        }
    }
    // The walk entered before it first left: the ring begins outside.
    if (left_first != no_label) entries_[static_cast<std::size_t>(left_first)].left = left;
    if (cut_faces_.back().begin == cut_faces_.back().end) cut_faces_.pop_back();
    if (D == 2) entries_.resize(first_entry);
}

template <int D> void CellShape<D>::close(int neighbour) {
    while (!entries_.empty()) {
        add_cut_face(neighbour);
        Entry at = entries_.back();
        entries_.pop_back();
        for (bool is_found = true; is_found;) {
            add_cut_corner({at.at, at.face});
            is_found = false;
            for (std::size_t i = 0; i < entries_.size() && !is_found; ++i) {
                if (entries_[i].face != at.left || entries_[i].entered != at.face) continue;
                is_found = true;
                at = entries_[i];
                entries_[i] = entries_.back();
                entries_.pop_back();
            }
        }
    }
}

template <int D> void CellShape<D>::take_cut() {
    corners_.resize(cut_corners_.size());
    std::copy(cut_corners_.begin(), cut_corners_.end(), corners_.begin());
    faces_.resize(cut_faces_.size());
    std::copy(cut_faces_.begin(), cut_faces_.end(), faces_.begin());
}

template <int D> void CellShape<D>::cut(int neighbour) {
    cut_corners_.clear();
    cut_faces_.clear();
    entries_.clear();
    for (const Face &face : faces_) cut_face(face, neighbour);
    close(neighbour);
    take_cut();
}

template <int D> void CellShape<D>::tidy() {
    cut_corners_.clear();
    cut_faces_.clear();
    for (const Face &face : faces_) {
        const std::size_t size = face.end - face.begin;
        std::size_t first = 0; // of the remaining corners
        add_cut_face(face.label);
        for (std::size_t i = 0; i < size; ++i) {
            const Corner &corner = corners_[face.begin + i];
            if (corner.at == corners_[face.begin + (i + 1) % size].at) continue;
            add_cut_corner(corner);
        }
        Face &left = cut_faces_.back();
        if (left.end - left.begin < 3) {
            cut_corners_.resize(left.begin);
            cut_faces_.pop_back();
            continue;
        }
        for (std::size_t i = left.begin; i < left.end; ++i)
            if (lexicographically_less<D>(cut_corners_[i].at, cut_corners_[left.begin + first].at))
                first = i - left.begin;
        Corner *const ring = cut_corners_.data() + left.begin;
        std::rotate(ring, ring + first, cut_corners_.data() + left.end);
    }
    take_cut();
    // One or two remaining faces enclose nothing.
    if (D == 3 && faces_.size() < 4) faces_.clear();
}

// ---- Measures ---------------------------------------------------------------------------

namespace {

/// For each axis, where powers of two are divided out so that products neither underflow nor
/// overflow, the exponent; 0 for ordinary coordinates.
template <int D> class Exponents {
public:
    template <class Corners>
    Exponents(const Corners &corners, std::size_t begin, std::size_t end, Point<D> largest = {}) {
        for (std::size_t i = begin; i < end; ++i)
            for (int axis = 0; axis < D; ++axis)
                largest[axis] = std::max(std::fabs(largest[axis]), std::fabs(corners[i].at[axis]));
        for (int axis = 0; axis < D; ++axis) {
            const double size = std::fabs(largest[axis]);
            if (size != 0 && !(size > 1e-70 && size < 1e70)) of_[axis] = std::ilogb(size) + 1;
        }
    }
    Point<D> minus(const Point<D> &a, const Point<D> &b) const {
        Point<D> difference;
        for (int i = 0; i < D; ++i)
            difference[i] =
                of_[i] == 0 ? a[i] - b[i] : std::scalbn(a[i], -of_[i]) - std::scalbn(b[i], -of_[i]);
        return difference;
    }
    /// What a product of differences along all axes, or all but one, really is.
    double undo(double product, int without = -1) const {
        int sum = 0;
        for (int i = 0; i < D; ++i) sum += i == without ? 0 : of_[i];
        return sum == 0 ? product : std::scalbn(product, sum);
    }

private:
    std::array<int, D> of_{};
};

double cross(const Point<2> &a, const Point<2> &b) { return a[0] * b[1] - a[1] * b[0]; }
Point<3> cross(const Point<3> &a, const Point<3> &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Twice the area of a ring: a number in the plane, a vector normal to it in space.
template <int D, class Corners>
auto turned(const Corners &corners, std::size_t begin, std::size_t end,
            const Exponents<D> &exponents) {
    decltype(cross(Point<D>{}, Point<D>{})) sum{};
    for (std::size_t i = begin + 1; i + 1 < end; ++i) {
        const auto part = cross(exponents.minus(corners[i].at, corners[begin].at),
                                exponents.minus(corners[i + 1].at, corners[begin].at));
        if constexpr (D == 2)
            sum += part;
        else
            for (int axis = 0; axis < 3; ++axis) sum[axis] += part[axis];
    }
    return sum;
}

} // namespace

template <int D> double CellShape<D>::area(const Face &face) const {
    const Exponents<D> exponents(corners_, face.begin, face.end);
    const auto across = turned<D>(corners_, face.begin, face.end, exponents);
    if constexpr (D == 2)
        return exponents.undo(across / 2);
    else
        return length(Point<3>{exponents.undo(across[0], 0), exponents.undo(across[1], 1),
                               exponents.undo(across[2], 2)}) /
               2;
}

template <int D> double CellShape<D>::content() const {
    double sum = 0;
    if constexpr (D == 2) {
        for (const Face &face : faces_) sum += area(face);
        return sum;
    } else {
        const Exponents<3> exponents(corners_, 0, corners_.size(), vertex_);
        for (const Face &face : faces_) {
            const Point<3> across = turned<3>(corners_, face.begin, face.end, exponents);
            const Point<3> to = exponents.minus(corners_[face.begin].at, vertex_);
            sum += (to[0] * across[0] + to[1] * across[1] + to[2] * across[2]) / 6;
        }
        return exponents.undo(sum);
    }
}

template class CellShape<2>;
template class CellShape<3>;

} // namespace abacus
