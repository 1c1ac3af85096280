// The simplices of a mesh, in the order of their pages.
#pragma once

#include "keys/locational_code.hpp"
#include "query/pages/page_scan.hpp"

#include <abacus/simplex.h>

namespace abacus {

template <int D> class SimplexScan {
public:
    SimplexScan(const Host &host, const abacus_facts &facts, bool ghosts);

    /// False after the last simplex.
    bool next(abacus_simplex &simplex);

private:
    Domain<D> domain_;
    PageScan<D> pages_;
    bool ghosts_;
    bool in_page_ = false;
    int at_ = 0;
};

} // namespace abacus
