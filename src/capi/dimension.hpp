// One object of a template on the dimension, chosen by a mesh's header.
#pragma once

#include "host/host.hpp"

#include <abacus/facts.h>
#include <utility>
#include <variant>

namespace abacus {

template <template <int> class T> class ByDimension {
public:
    template <class... Args>
    ByDimension(const Host &host, const abacus_facts &facts, Args &&...args) {
        switch (facts.form.dimension) {
        case 2:
            any_.template emplace<1>(host, facts, std::forward<Args>(args)...);
            break;
        case 3:
            any_.template emplace<2>(host, facts, std::forward<Args>(args)...);
            break;
        default:
            throw Error(ABACUS_ERROR_ARGUMENT, "a mesh must have 2 or 3 dimensions");
        }
    }

    template <class Visit> decltype(auto) visit(Visit &&visit) {
        return any_.index() == 1 ? visit(std::get<1>(any_)) : visit(std::get<2>(any_));
    }

    template <class Visit> decltype(auto) visit(Visit &&visit) const {
        return any_.index() == 1 ? visit(std::get<1>(any_)) : visit(std::get<2>(any_));
    }

    template <int D> T<D> &get() { return std::get<D - 1>(any_); }

private:
    std::variant<std::monostate, T<2>, T<3>> any_; // empty while it is made
};

} // namespace abacus
