// A reader that finds the simplices to which labels or markers are given.
#pragma once

#include "capi/dispatch.hpp"
#include "labels/named_simplices.hpp"
#include "query/locate/reader.hpp"

#include <abacus/mesh_header.h>

namespace abacus {

template <int D> class NamedByReader final : public NamedSimplices<D> {
public:
    NamedByReader(const Host &host, const abacus_facts &facts, std::size_t cache_bytes)
        : mesh_(host, facts, cache_bytes) {}

    void describe(std::uint64_t code, const std::int64_t *ids, abacus_simplex &simplex) override {
        mesh_.describe(code, ids, simplex);
    }
    bool walk(std::uint64_t code, const std::int64_t *ids, int facet,
              abacus_simplex &simplex) override {
        return mesh_.walk(code, ids, facet, simplex);
    }

private:
    Reader<D> mesh_;
};

/// Sets what `change` has collected, labels or markers. The header stays as it is if this fails.
template <template <int> class Change>
abacus_status set_by_reader(const Host &host, ByDimension<Change> &change, std::size_t cache_bytes,
                            abacus_header &header, abacus_error *error) {
    return dispatch(change, error, [&]<int D>(Change<D> &opened) {
        abacus_header changed = header;
        NamedByReader<D> mesh(host, header, cache_bytes);
        opened.set(mesh, changed);
        header = changed;
    });
}

} // namespace abacus
