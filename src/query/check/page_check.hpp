// Checks what has to hold for a page by itself, and counts what is in all pages checked.
#pragma once

#include "blocks/fault_list.hpp"
#include "keys/locational_code.hpp"
#include "mesh/page_format.hpp"

namespace abacus {

template <int D> class PageCheck {
public:
    PageCheck(const Domain<D> &domain, FaultList &faults) : domain_(domain), faults_(faults) {}

    /// Decodes the page that is stored under faults.at; false if it cannot be decoded.
    bool read(const unsigned char *bytes, std::size_t size, int attributes);
    /// Checks the contents of the page that was read, whose bytes are still there.
    void check();
    const PageView<D> &page() const { return page_; }

    struct Counts {
        std::uint64_t simplices = 0, ghosts = 0;
        std::uint64_t flat = 0;     ///< of the simplices, in doubles (geometry/flatness.hpp)
        std::uint64_t fixed = 0;    ///< facets that are fixed, on each side
        std::uint64_t soft = 0;     ///< soft ones among them
        std::uint64_t vertices = 0; ///< of all pages: a vertex on several pages counts for each

        Counts &operator+=(const Counts &more) {
            simplices += more.simplices;
            ghosts += more.ghosts;
            flat += more.flat;
            fixed += more.fixed;
            soft += more.soft;
            vertices += more.vertices;
            return *this;
        }
    };
    const Counts &counts() const { return counts_; }

private:
    void check_simplices();
    void check_box(int patch);

    const Domain<D> domain_;
    FaultList &faults_;
    PageView<D> page_;
    Counts counts_;
};

extern template class PageCheck<2>;
extern template class PageCheck<3>;

} // namespace abacus
