// Which attributes share a page: see attribute_page.hpp.
#pragma once

#include <abacus/facts.h>

namespace abacus {

/// The attributes of a mesh in groups that are as even as possible, none wider than `widest`.
class AttributeGroups {
public:
    static constexpr unsigned widest = 32;

    constexpr explicit AttributeGroups(unsigned attributes)
        : attributes_(attributes), count_((attributes + widest - 1) / widest),
          width_(count_ == 0 ? 0 : (attributes + count_ - 1) / count_) {}

    constexpr unsigned attributes() const { return attributes_; }
    constexpr unsigned count() const { return count_; }
    constexpr unsigned first(unsigned group) const { return group * width_; }
    constexpr unsigned columns(unsigned group) const {
        const unsigned left = attributes_ - first(group);
        return left < width_ ? left : width_;
    }
    constexpr unsigned group_of(unsigned attribute) const { return attribute / width_; }

private:
    unsigned attributes_, count_, width_;
};

/// No group is empty.
static_assert([] {
    for (unsigned attributes = 1; attributes <= ABACUS_MAX_NAMES; ++attributes) {
        const AttributeGroups groups(attributes);
        if (groups.first(groups.count() - 1) >= attributes) return false;
    }
    return true;
}());

} // namespace abacus
