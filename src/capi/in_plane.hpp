// What the C interface has for meshes of dimension 2 alone.
#pragma once

#include "capi/dimension.hpp"
#include "capi/guard.hpp"

namespace abacus {

/// Calls call(object) for an object of dimension 2; its result is that of the interface. `what`
/// needs that dimension.
template <template <int> class T, class Call>
abacus_status in_plane(ByDimension<T> &object, const char *what, abacus_error *error, Call call) {
    return guard(error, [&] {
        return object.visit([&]<int D>(T<D> &opened) -> abacus_status {
            if constexpr (D == 2)
                return call(opened);
            else
                throw Error(ABACUS_ERROR_ARGUMENT,
                            std::string(what) + " need a mesh of dimension 2");
        });
    });
}

} // namespace abacus
