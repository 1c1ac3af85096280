// One object of a template on the dimension, chosen by a mesh's header.
#pragma once

#include "host/host.hpp"

#include <abacus/header.h>
#include <optional>
#include <utility>

namespace abacus {

template <template <int> class T> class ByDimension {
public:
    template <class... Args>
    ByDimension(const Host &host, const abacus_header &header, Args &&...args) {
        switch (header.dimension) {
        case 2:
            flat_.emplace(host, header, std::forward<Args>(args)...);
            break;
        case 3:
            solid_.emplace(host, header, std::forward<Args>(args)...);
            break;
        default:
            throw Error(ABACUS_ERROR_ARGUMENT, "a mesh has 2 or 3 dimensions");
        }
    }

    template <class Visit> decltype(auto) visit(Visit &&visit) {
        return flat_ ? visit(*flat_) : visit(*solid_);
    }

    template <class Visit> decltype(auto) visit(Visit &&visit) const {
        return flat_ ? visit(*flat_) : visit(*solid_);
    }

    template <int D> T<D> &get() {
        if constexpr (D == 2)
            return flat_.value();
        else
            return solid_.value();
    }

private:
    std::optional<T<2>> flat_;
    std::optional<T<3>> solid_;
};

} // namespace abacus
