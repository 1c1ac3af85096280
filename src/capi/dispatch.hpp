// A call of the interface that does something with an object of whatever dimension.
#pragma once

#include "capi/dimension.hpp"
#include "capi/guard.hpp"

namespace abacus {

template <template <int> class T, class Call>
abacus_status dispatch(ByDimension<T> &object, abacus_error *error, Call &&call) noexcept {
    return guard(error, [&] {
        object.visit(call);
        return ABACUS_OK;
    });
}

} // namespace abacus
