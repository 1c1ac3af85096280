#include "query/volume/comparison.hpp"

#include <cmath>

namespace abacus {

namespace {

template <int D> double integral(const Piece<D> &piece) { return measure(piece) * mean(piece); }

/// Of the square of a linear function.
template <int D> double integral_of_square(const Piece<D> &piece) {
    double sum = 0, squares = 0;
    for (const double value : piece.value) {
        sum += value;
        squares += value * value;
    }
    return measure(piece) * ((squares + sum * sum) / ((D + 1) * (D + 2)));
}

/// Calls visit(piece) for pieces that make up a piece, in each of which the values have one sign.
template <int D, class Visit> void each_of_one_sign(const Piece<D> &piece, Visit visit) {
    const auto [least, greatest] = std::minmax_element(piece.value.begin(), piece.value.end());
    if (*least >= 0 || *greatest <= 0) return visit(piece);
    Sides<D> turned;
    for (int i = 0; i <= D; ++i) turned[i] = -piece.value[i];
    clip<D>(piece, piece.value, visit);
    clip<D>(piece, turned, visit);
}

ScaledNumber quotient(const ScaledNumber &a, const ScaledNumber &b) {
    return {a.value / b.value, a.exponent - b.exponent};
}
double rounded(const ScaledNumber &number) { return std::ldexp(number.value, number.exponent); }
double root(ScaledNumber number) {
    if (number.exponent % 2 != 0) {
        number.value *= 2;
        --number.exponent;
    }
    return std::ldexp(std::sqrt(number.value), number.exponent / 2);
}

} // namespace

template <int D>
void Comparison<D>::add(const ValuedSimplex<D> &first, const ValuedSimplex<D> &second,
                        const Box<D> &window, const abacus_extent &extent) {
    const Polygon *polygon = nullptr;
    if constexpr (D == 2) polygon = polygon_of(extent);
    greatest_.add(first.as_it_is(), second.as_it_is(), window, polygon);
    each_common_piece(first, second, window, extent,
                      [&](const Piece<D> &piece, const NearFrame<D> &frame) { add(piece, frame); });
}

template <int D> void Comparison<D>::add(const Piece<D> &piece, const NearFrame<D> &frame) {
    const int sizes = frame.of_measures(), values = frame.of_values();
    size_.add(measure(piece), sizes);
    sum_.add(integral(piece), sizes + values);
    squares_.add(integral_of_square(piece), sizes + 2 * values);
    each_of_one_sign(piece, [&](const Piece<D> &part) {
        absolute_.add(std::fabs(integral(part)), sizes + values);
    });
}

template <int D> abacus_comparison Comparison<D>::result() const {
    abacus_comparison result{};
    result.is_any = greatest_.is_any() ? 1 : 0;
    if (result.is_any == 0) return result;
    const auto greatest = greatest_.result();
    const ScaledNumber size = size_.scaled();
    result.greatest = greatest.difference;
    std::copy(greatest.place.begin(), greatest.place.end(), result.place);
    result.mean = rounded(quotient(sum_.scaled(), size));
    result.mean_absolute = rounded(quotient(absolute_.scaled(), size));
    result.rms = root(quotient(squares_.scaled(), size));
    return result;
}

template <int D>
abacus_comparison compare(const Host &host, const abacus_facts &facts,
                          const abacus_surface &surface, const OtherMesh &other) {
    const Box<D> window = box_of<D>(surface.window);
    Comparison<D> comparison;
    each_overlap<D>(host, facts, surface, other,
                    [&](const ValuedSimplex<D> &first, const ValuedSimplex<D> &second) {
                        comparison.add(first, second, window, surface.extent);
                    });
    return comparison.result();
}

template class Comparison<2>;
template class Comparison<3>;
template abacus_comparison compare<2>(const Host &, const abacus_facts &, const abacus_surface &,
                                      const OtherMesh &);
template abacus_comparison compare<3>(const Host &, const abacus_facts &, const abacus_surface &,
                                      const OtherMesh &);

} // namespace abacus
