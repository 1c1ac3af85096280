// The facets with markers, each once, by marker and along the curve.
//
// Both simplices beside a facet have its marker. So all are sorted, and of two equal ones one is
// left out. Memory is that of the sort; the mesh is asked only for the ids of the corners.
#pragma once

#include "query/reader.hpp"
#include "sort/record_sort.hpp"

#include <abacus/ask.h>
#include <optional>

namespace abacus {

template <int D> class MarkedFacets {
public:
    /// Those with this marker, or all if there is none.
    MarkedFacets(const Host &host, const abacus_header &header, std::optional<double> marker,
                 std::size_t memory, std::size_t cache_bytes);

    /// False after the last.
    bool next(abacus_facet &facet);

private:
    static constexpr std::size_t key_words = 3 + D * D; // marker, key, coordinates

    void read(const Host &host, const abacus_header &header, std::optional<double> marker);

    Reader<D> mesh_;
    RecordSort sort_;
    std::array<std::uint64_t, key_words> last_{};
    bool is_first_ = true;
};

extern template class MarkedFacets<2>;
extern template class MarkedFacets<3>;

} // namespace abacus
