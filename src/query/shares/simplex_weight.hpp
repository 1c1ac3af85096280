// The weight of a simplex when a mesh is cut into parts: 1, a label, or the mean of an attribute at
// its corners.
//
// Only the ratios of weights matter. So the sum of the corners stands for their mean, and it is
// given as its summands: nothing is rounded.
#pragma once

#include "geometry/exact_sum.hpp"
#include "geometry/in_words.hpp"
#include "query/pages/page_values.hpp"
#include "query/scan/simplex_labels.hpp"

#include <abacus/shares.h>

#include <span>

namespace abacus {

template <int D> class SimplexWeight {
public:
    SimplexWeight(const Host &host, const abacus_facts &facts, const abacus_cut &cut)
        : cut_(cut),
          values_(host, facts,
                  cut.weight == ABACUS_WEIGHT_ATTRIBUTE ? static_cast<int>(cut.column) : -1),
          labels_(host, facts) {}

    /// Goes to a page, which must exist until the next one.
    void enter(const PageView<D> &page) {
        page_ = &page;
        values_.enter(page);
    }
    /// Of a finite simplex of the page: doubles whose sum is its weight, valid until the next call.
    /// A value that is missing counts as 0; throws if the weight is negative, or infinite.
    std::span<const double> of(int simplex) {
        std::span<const double> terms(terms_.data(), 1);
        if (cut_.weight == ABACUS_WEIGHT_LABEL)
            terms_[0] = or_zero(labels_.of_page(*page_, simplex)[cut_.column]);
        else if (cut_.weight == ABACUS_WEIGHT_ATTRIBUTE) {
            for (int i = 0; i <= D; ++i)
                terms_[i] = or_zero(values_.value(page_->corner(simplex, i)));
            terms = terms_;
        }
        if (std::any_of(terms.begin(), terms.end(), [](double x) { return !(x >= 0) || x > most; }))
            require_weight(simplex, terms);
        return terms;
    }

private:
    static constexpr double most = std::numeric_limits<double>::max();

    static double or_zero(double value) { return std::isnan(value) ? 0 : value; }
    void require_weight(int simplex, std::span<const double> terms) const {
        ExactSum sum;
        for (const double term : terms) sum.add(term);
        const double value = sum.value(); // rounded once, so it has the sign of the sum
        if (std::any_of(terms.begin(), terms.end(), [](double x) { return std::isinf(x); }))
            refuse(simplex, value, "No part could have as much as the others.");
        if (value < 0)
            refuse(simplex, value / static_cast<double>(terms.size()),
                   "A part would have less with it than without it.");
    }
    [[noreturn]] void refuse(int simplex, double weight, const char *why) const {
        std::array<std::int64_t, D + 1> corners;
        for (int i = 0; i <= D; ++i) corners[i] = page_->id(page_->corner(simplex, i));
        std::sort(corners.begin(), corners.end());
        std::string ids;
        for (const std::int64_t id : corners) ids += (ids.empty() ? "" : ", ") + std::to_string(id);
        throw Error(ABACUS_ERROR_ARGUMENT,
                    "the simplex (" + ids + ") has the weight " + in_words(std::array{weight}), why,
                    "Give finite weights of at least 0.");
    }

    const abacus_cut cut_;
    PageValues<D> values_;
    SimplexLabels<D> labels_;
    const PageView<D> *page_ = nullptr;
    std::array<double, D + 1> terms_{1};
};

} // namespace abacus
