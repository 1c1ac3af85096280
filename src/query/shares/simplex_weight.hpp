// The weight of a simplex when a mesh is cut into parts: 1, a label, or the mean of an attribute at
// its corners.
#pragma once

#include "geometry/in_words.hpp"
#include "query/pages/page_values.hpp"
#include "query/scan/simplex_labels.hpp"

#include <abacus/shares.h>

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
    /// Of a finite simplex of the page. A value that is missing counts as 0; throws if the weight
    /// is negative.
    double of(int simplex) {
        double weight = 1;
        if (cut_.weight == ABACUS_WEIGHT_LABEL)
            weight = or_zero(labels_.of_page(*page_, simplex)[cut_.column]);
        if (cut_.weight == ABACUS_WEIGHT_ATTRIBUTE) weight = mean(simplex);
        if (weight < 0) throw_negative(simplex, weight);
        return weight;
    }

private:
    static double or_zero(double value) { return std::isnan(value) ? 0 : value; }
    /// Summed in the order of the values, so that it does not depend on that of the corners.
    double mean(int simplex) const {
        std::array<double, D + 1> shares;
        for (int i = 0; i <= D; ++i)
            shares[i] = or_zero(values_.value(page_->corner(simplex, i))) / (D + 1);
        std::sort(shares.begin(), shares.end());
        double sum = 0;
        for (const double share : shares) sum += share;
        return sum;
    }
    [[noreturn]] void throw_negative(int simplex, double weight) const {
        std::array<std::int64_t, D + 1> corners;
        for (int i = 0; i <= D; ++i) corners[i] = page_->id(page_->corner(simplex, i));
        std::sort(corners.begin(), corners.end());
        std::string ids;
        for (const std::int64_t id : corners) ids += (ids.empty() ? "" : ", ") + std::to_string(id);
        throw Error(ABACUS_ERROR_ARGUMENT,
                    "the simplex (" + ids + ") has the weight " + in_words(std::array{weight}),
                    "A part would have less with it than without it.",
                    "Give weights of at least 0.");
    }

    const abacus_cut cut_;
    PageValues<D> values_;
    SimplexLabels<D> labels_;
    const PageView<D> *page_ = nullptr;
};

} // namespace abacus
