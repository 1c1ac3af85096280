// One object of a template on the dimension, chosen by a mesh's header.
#pragma once

#include "host/host.hpp"

#include <optional>
#include <utility>

namespace abacus {

template <template <int> class T> class ByDimension {
public:
    template <class... Args>
    ByDimension(const Host &host, const abacus_header &header, Args &&...args) {
        if (header.dimension != 2)
            throw Error(ABACUS_ERROR_ARGUMENT, "this version of Abacus has meshes of dimension 2");
        flat_.emplace(host, header, std::forward<Args>(args)...);
    }

    template <class Visit> decltype(auto) visit(Visit &&visit) { return visit(*flat_); }

private:
    std::optional<T<2>> flat_;
};

} // namespace abacus
