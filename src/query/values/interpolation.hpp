// Values at places between the vertices: which vertices count, and how much.
//
// Every method reduces to weights of some vertices, none of them negative, with the sum 1: a value
// is the weighted mean. So it lies between the least and the greatest value, which rounding must
// not exceed; and vertices without a weight do not count, whatever values they have or lack.
#pragma once

#include "query/values/sibson.hpp"

#include <abacus/values.h>

namespace abacus {

template <int D> class Interpolation {
public:
    explicit Interpolation(const Host &host) : sibson_(host), weights_(host), values_(host) {}
    /// As what is made by a mesh's dimension.
    Interpolation(const Host &host, const abacus_facts &) : Interpolation(host) {}

    /// Finds the weights at p; false outside.
    bool weigh(Reader<D> &reader, const abacus_interpolation &what, const Point<D> &p);
    /// Sets the values at p; false outside.
    bool values(Reader<D> &reader, const abacus_interpolation &what, const Point<D> &p,
                double *values);

    /// The result of weigh().
    const Arena<abacus_weight> &weights() const { return weights_; }

private:
    bool weigh_corners(Reader<D> &reader, const abacus_interpolation &what, const Point<D> &p);
    bool weigh_natural(Reader<D> &reader, const abacus_interpolation &what, const Point<D> &p);
    bool weigh_nearest(Reader<D> &reader, const abacus_interpolation &what, const Point<D> &p);
    /// attribute(i): the i-th of all attributes of the vertex.
    template <class Attribute>
    void add(const abacus_interpolation &what, std::int64_t id, double weight,
             Attribute attribute) {
        if (weight == 0) return;
        weights_.push_back({id, weight});
        for (std::uint32_t n = 0; n < what.attributes; ++n) values_.push_back(attribute(n));
    }

    Sibson<D> sibson_;
    Arena<abacus_weight> weights_;
    Arena<double> values_; // the requested ones, for each of those vertices
};

extern template class Interpolation<2>;
extern template class Interpolation<3>;

} // namespace abacus
