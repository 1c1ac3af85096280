// Attributes of vertices for queries, wherever the mesh keeps them: in the simplex pages, or in
// pages of their own, which are read when the first attribute is needed.
#pragma once

#include "attributes/attribute_reader.hpp"
#include "keys/domain_of.hpp"
#include "mesh/page_format.hpp"
#include "mesh/vertex_heap.hpp"

#include <optional>

namespace abacus {

template <int D> class VertexValues {
public:
    static constexpr std::size_t default_bytes = std::size_t{2} << 20;

    /// Attributes that are apart are kept in about so many bytes.
    VertexValues(const Host &host, const abacus_facts &facts, std::size_t bytes = default_bytes)
        : attributes_(facts.columns.attributes) {
        if (facts.columns.apart != 0)
            apart_.emplace(host, domain_of<D>(facts.form), facts.columns.attributes, bytes);
    }

    unsigned count() const { return attributes_; }
    bool are_apart() const { return apart_.has_value(); }

    /// An attribute of a page's vertex, whose point has been read.
    double value(const PageView<D> &page, int vertex, int attribute) const {
        if (apart_) return apart_->value(page.point(vertex), static_cast<unsigned>(attribute));
        return page.attribute(vertex, attribute);
    }
    /// The same for a cached vertex.
    double value(const VertexHeap<D> &heap, VertexIndex v, int attribute) const {
        if (apart_) return apart_->value(heap.point(v), static_cast<unsigned>(attribute));
        return heap.attributes(v)[attribute];
    }
    /// All attributes.
    void all(const PageView<D> &page, int vertex, double *values) const {
        if (apart_) return apart_->values(page.point(vertex), values);
        for (unsigned i = 0; i < attributes_; ++i)
            *values++ = page.attribute(vertex, static_cast<int>(i));
    }
    void all(const VertexHeap<D> &heap, VertexIndex v, double *values) const {
        if (apart_) return apart_->values(heap.point(v), values);
        std::copy_n(heap.attributes(v), attributes_, values);
    }
    /// All attributes of the vertex at p, in a mesh that has them apart.
    void all_at(const Point<D> &p, double *values) const { apart_->values(p, values); }

    /// Whether an attribute of a page's vertices may be from `least` to `greatest`; true if one is.
    /// The page shows this without reading its vertices; a page without attributes cannot tell.
    bool may_have(const PageView<D> &page, int attribute, double least, double greatest) const {
        return apart_ || page.may_have_attribute(attribute, least, greatest);
    }

private:
    const unsigned attributes_;
    mutable std::optional<AttributeReader<D>> apart_; // a cache: it changes no answer
};

} // namespace abacus
