// The question for the value of an attribute at each of many places.
#pragma once

#include "query/places/question.hpp"

#include <cmath>

namespace abacus {

/// The value at the place with id i goes to values[i]; NaN if there is none.
template <int D> class PlaceValue final : public Question<D> {
public:
    PlaceValue(const abacus_interpolation &how, double *values) : how_(how), values_(values) {}

    std::size_t words() const override { return 1; }
    bool is_quick() const override { return how_.method == ABACUS_LINEAR; }
    void answer(Answerer<D> &by, const Point<D> &p, Tape &tape) const override {
        double value;
        const bool has_value = by.interpolation.values(by.reader, how_, p, &value);
        tape.put(has_value ? value : NAN);
    }
    void tell(std::int64_t id, Tape::Player &answers) const override {
        values_[id] = answers.take<double>();
    }

private:
    const abacus_interpolation &how_;
    double *const values_;
};

} // namespace abacus
