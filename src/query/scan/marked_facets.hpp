// The facets with markers, each once, by marker and along the curve.
//
// Both simplices beside a facet have its marker. So all are sorted, and one of each equal pair is
// left out. The two sides of a fault are facets at one place, distinguished by the ids of their
// corners: where vertices share their places these come from the simplex. The memory needed is that
// of the sort; the mesh is read only for the ids of the corners.
#pragma once

#include "query/locate/reader.hpp"
#include "sort/record_sort.hpp"

#include <abacus/labels.h>
#include <optional>

namespace abacus {

template <int D> class MarkedFacets {
public:
    /// Those with this marker, or all if there is none.
    MarkedFacets(const Host &host, const abacus_facts &facts, std::optional<double> marker,
                 std::size_t memory, std::size_t cache_bytes);

    /// False after the last.
    bool next(abacus_facet &facet);

private:
    static constexpr std::size_t facet_words = 3 + D * D;     // marker, key, coordinates
    static constexpr std::size_t key_words = facet_words + D; // the opposite corner
    using Ids = std::array<std::int64_t, D>;

    /// The ids of the corners of a record's facet, in their order.
    Ids ids_of(const std::uint64_t *record);
    Ids ids_beside(const std::uint64_t *record);
    void read(const Host &host, const abacus_facts &facts, std::optional<double> marker);

    const bool is_split_;
    Reader<D> mesh_;
    RecordSort sort_;
    std::array<std::uint64_t, facet_words> last_{};
    Ids last_ids_{};
    bool is_first_ = true;
};

extern template class MarkedFacets<2>;
extern template class MarkedFacets<3>;

} // namespace abacus
