#include "query/volume/comparison.hpp"

#include <cmath>

namespace abacus {

namespace {

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
    greatest_.add(first.as_it_is(), second.as_it_is(), window, polygon_in<D>(extent));
    portions_.each(first, second, window, extent, [&](const Portion<D> &portion) { add(portion); });
}

template <int D> void Comparison<D>::add(const Portion<D> &portion) {
    const auto add = [](WideSum &sum, const ScaledNumber &number) {
        sum.add(number.value, number.exponent);
    };
    add(size_, portion.size());
    add(sum_, portion.integral());
    add(squares_, portion.integral_of_square());
    each_of_one_sign<D>(portion, [&](const Portion<D> &part) {
        ScaledNumber integral = part.integral();
        integral.value = std::fabs(integral.value);
        add(absolute_, integral);
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
    result.mean = rounded(sum_.scaled() / size);
    result.mean_absolute = rounded(absolute_.scaled() / size);
    result.rms = root(squares_.scaled() / size);
    return result;
}

template <int D>
abacus_comparison compare(const Host &host, const abacus_facts &facts,
                          const abacus_surface &surface, const OtherMesh &other) {
    const Box<D> window = box_of<D>(surface.window);
    for (const bool is_exact : {false, true}) {
        Comparison<D> comparison(is_exact);
        each_overlap<D>(host, facts, surface, other,
                        [&](const ValuedSimplex<D> &first, const ValuedSimplex<D> &second) {
                            comparison.add(first, second, window, surface.extent);
                        });
        if (comparison.is_sure()) return comparison.result();
    }
    return {}; // not reached
}

template class Comparison<2>;
template class Comparison<3>;
template abacus_comparison compare<2>(const Host &, const abacus_facts &, const abacus_surface &,
                                      const OtherMesh &);
template abacus_comparison compare<3>(const Host &, const abacus_facts &, const abacus_surface &,
                                      const OtherMesh &);

} // namespace abacus
