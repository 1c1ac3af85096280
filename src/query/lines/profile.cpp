#include "query/lines/profile.hpp"

#include "geometry/distance.hpp"

namespace abacus {

template <int D>
Profile<D>::Profile(Reader<D> &reader, std::uint32_t attribute, Report report,
                    const abacus_extent &extent)
    : reader_(reader), interpolation_(reader.cache().host()), report_(std::move(report)) {
    how_.method = ABACUS_LINEAR;
    how_.extent = extent;
    how_.attributes = 1;
    how_.attribute[0] = attribute;
}

template <int D>
void Profile<D>::along(std::size_t n, const std::function<Point<D>(std::size_t)> &corner) {
    for (std::size_t i = 0; i < n; ++i) {
        const Point<D> to = corner(i);
        if (i == 0)
            put_corner(to, true);
        else if (const Point<D> from = corner(i - 1); !(from == to))
            put_line(from, to);
    }
}

template <int D> void Profile<D>::put(const Row &row, double value) {
    report_(row.distance, row.place, value);
    last_ = row;
}

template <int D> void Profile<D>::put_outside(double distance, const Point<D> &place) {
    if (last_ && !last_->is_inside && last_->distance == distance) return;
    put({distance, place, false}, NAN);
}

template <int D> void Profile<D>::put_corner(const Point<D> &place, bool comes_inside) {
    double value = NAN;
    const bool is_inside = interpolation_.values(reader_, how_, place, &value);
    if (!comes_inside || !is_inside) put_outside(distance_, place);
    if (is_inside) put({distance_, place, true}, value);
}

template <int D> void Profile<D>::put_line(const Point<D> &from, const Point<D> &to) {
    const double length = distance<D>(from, to);
    // Not before the last row, which rounding might lead to.
    const auto distance_to = [&](const Crossing<D> &crossing) {
        const double along = std::min(distance<D>(from, crossing.place()), length);
        return std::max(distance_ + along, last_->distance);
    };
    std::optional<Crossing<D>> left; // where the last piece ends
    LineScan<D> scan(reader_, Line<D>::between(from, to), static_cast<int>(how_.attribute[0]),
                     how_.extent);
    scan.each([&](const LinePiece<D> &piece) {
        const Crossing<D> &in = piece.enters, &out = piece.leaves;
        if (piece.jumps) {
            put({distance_to(in), in.place(), true}, in.mean());
        } else if (!piece.follows) {
            if (left)
                put_outside(distance_to(*left), left->place());
            else if (!in.is_end)
                put_outside(distance_, from);
            if (!in.is_end) {
                put_outside(distance_to(in), in.place());
                put({distance_to(in), in.place(), true}, in.mean());
            }
        }
        if (!out.is_end) put({distance_to(out), out.place(), true}, out.mean());
        left = out;
        return true;
    });
    const bool ends_inside = left && left->is_end;
    if (!left)
        put_outside(distance_, from);
    else if (!ends_inside)
        put_outside(distance_to(*left), left->place());
    distance_ += length;
    put_corner(to, ends_inside);
}

template class Profile<2>;
template class Profile<3>;

} // namespace abacus
