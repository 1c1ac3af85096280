// Which stretches of the curve have been stored, as the codes of the simplex pages tell that were.
//
// A page that has lost a simplex or got one is stored again, or what it owned is stored with
// another page's. So to find out what a change has done to the mesh, look at these stretches
// alone.
#pragma once

#include "host/arena.hpp"
#include "host/pages.hpp"

namespace abacus {

class StoredPages final : public PageWatch {
public:
    /// Codes, both ends included.
    struct Stretch {
        std::uint64_t least, greatest;
    };

    explicit StoredPages(const Memory &memory) : stretches_(memory) {}

    void stored(abacus_page_kind kind, const abacus_page &page) override;
    /// All of them, ascending; no two share a code. Valid until a page is stored.
    const Arena<Stretch> &stretches();
    void clear() {
        stretches_.clear();
        merged_ = 0;
    }

private:
    void merge();

    Arena<Stretch> stretches_;
    std::size_t merged_ = 0; // as many were left
};

} // namespace abacus
