#include "query/volume/comparison.hpp"

#include <cmath>

namespace abacus {

namespace {

double integral(const Piece<2> &piece) { return measure(piece) * mean(piece); }

/// Of the square of a linear function.
double integral_of_square(const Piece<2> &piece) {
    double sum = 0, squares = 0;
    for (const double value : piece.value) {
        sum += value;
        squares += value * value;
    }
    return measure(piece) * ((squares + sum * sum) / 12);
}

/// Calls visit(piece) for pieces that make up a piece, in each of which the values have one sign.
template <class Visit> void each_of_one_sign(const Piece<2> &piece, Visit visit) {
    const auto [least, greatest] = std::minmax_element(piece.value.begin(), piece.value.end());
    if (*least >= 0 || *greatest <= 0) return visit(piece);
    Sides<2> turned;
    for (int i = 0; i < 3; ++i) turned[i] = -piece.value[i];
    clip<2>(piece, piece.value, visit);
    clip<2>(piece, turned, visit);
}

/// Whether a triangle's orientation is certain in doubles.
bool is_wide(const ValuedSimplex<2> &triangle) {
    const auto seen = [&](int i) { return triangle.seen_from_first(triangle.corner[i]); };
    return signed_area(seen(1), seen(2)).is_sure();
}

} // namespace

void Comparison::look_at(double difference, const Point<2> &seen, const Point<2> &origin) {
    if (is_any_ && std::fabs(difference) < std::fabs(greatest_)) return;
    Point<2> place;
    for (int axis = 0; axis < 2; ++axis) place[axis] = origin[axis] + seen[axis];
    const bool is_greater = !is_any_ || std::fabs(difference) > std::fabs(greatest_);
    if (!is_greater && !lexicographically_less<2>(place, place_) &&
        !(place == place_ && difference > greatest_))
        return;
    is_any_ = true;
    greatest_ = difference;
    place_ = place;
}

void Comparison::add(const Piece<2> &piece, const Point<2> &origin, bool has_sure_values) {
    const double size = measure(piece);
    if (!(size > 0)) return;
    size_.add(size);
    sum_.add(integral(piece));
    squares_.add(integral_of_square(piece));
    each_of_one_sign(piece,
                     [&](const Piece<2> &part) { absolute_.add(std::fabs(integral(part))); });
    for (int i = 0; i < 3 && has_sure_values; ++i) look_at(piece.value[i], piece.corner[i], origin);
}

abacus_comparison Comparison::result() const {
    abacus_comparison result{};
    result.is_any = is_any_ ? 1 : 0;
    if (!is_any_) return result;
    const double size = size_.value();
    result.greatest = greatest_;
    std::copy(place_.begin(), place_.end(), result.place);
    result.mean = sum_.value() / size;
    result.mean_absolute = absolute_.value() / size;
    result.rms = std::sqrt(squares_.value() / size);
    return result;
}

abacus_comparison compare(const Host &host, const abacus_facts &facts,
                          const abacus_surface &surface, const OtherMesh &other) {
    const Box<2> window = box_of<2>(surface.window);
    Comparison comparison;
    each_overlap(host, facts, surface, other,
                 [&](const ValuedSimplex<2> &first, const ValuedSimplex<2> &second) {
                     const bool is_sure = is_wide(first) && is_wide(second);
                     each_common_piece(first, second, window, surface.extent,
                                       [&](const Piece<2> &piece, const Point<2> &origin) {
                                           comparison.add(piece, origin, is_sure);
                                       });
                 });
    return comparison.result();
}

} // namespace abacus
