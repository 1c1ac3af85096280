// Attributes of vertices for queries, wherever they are: in the simplex pages, or in pages of their
// own, which are read when the first attribute is needed; or values of a step in place of them.
#pragma once

#include "attributes/attribute_reader.hpp"
#include "keys/domain_of.hpp"
#include "mesh/page_format.hpp"
#include "mesh/vertex_heap.hpp"
#include "query/pages/values_by_id.hpp"

#include <optional>

namespace abacus {

template <int D> class VertexValues {
public:
    static constexpr std::size_t default_bytes = std::size_t{2} << 20;

    /// Attributes that are elsewhere are kept in about so many bytes.
    VertexValues(const Host &host, const abacus_facts &facts, std::size_t bytes = default_bytes)
        : attributes_(facts.columns.attributes) {
        if (facts.columns.by_id != 0)
            by_id_.emplace(host, attributes_, facts.census.vertices, bytes);
        else if (facts.columns.apart != 0)
            apart_.emplace(host, domain_of<D>(facts.form), facts.columns.attributes, bytes);
    }

    unsigned count() const { return attributes_; }
    /// Whether they are elsewhere than in the simplex pages.
    bool are_elsewhere() const { return apart_ || by_id_; }

    /// An attribute of a page's vertex, whose point has been read.
    double value(const PageView<D> &page, int vertex, int attribute) const {
        return value(page, vertex, by_id_ ? page.id(vertex) : 0, attribute);
    }
    /// The same with its id, where the page's bytes may be gone once the first value has been read.
    double value(const PageView<D> &page, int vertex, std::int64_t id, int attribute) const {
        if (by_id_) return by_id_->find(id)[attribute];
        if (apart_) return apart_->value(page.point(vertex), static_cast<unsigned>(attribute));
        return page.attribute(vertex, attribute);
    }
    /// The same for a cached vertex.
    double value(const VertexHeap<D> &heap, VertexIndex v, int attribute) const {
        if (by_id_) return by_id_->find(heap.id(v))[attribute];
        if (apart_) return apart_->value(heap.point(v), static_cast<unsigned>(attribute));
        return heap.attributes(v)[attribute];
    }
    /// All attributes.
    void all(const PageView<D> &page, int vertex, double *values) const {
        if (are_elsewhere()) return all_of(page.id(vertex), page.point(vertex), values);
        for (unsigned i = 0; i < attributes_; ++i)
            *values++ = page.attribute(vertex, static_cast<int>(i));
    }
    void all(const VertexHeap<D> &heap, VertexIndex v, double *values) const {
        if (are_elsewhere()) return all_of(heap.id(v), heap.point(v), values);
        std::copy_n(heap.attributes(v), attributes_, values);
    }
    /// All attributes of the vertex with this id at p, if they are elsewhere.
    void all_of(std::int64_t id, const Point<D> &p, double *values) const {
        if (by_id_)
            std::copy_n(by_id_->find(id), attributes_, values);
        else
            apart_->values(p, values);
    }

    /// Whether an attribute of a page's vertices may be from `least` to `greatest`; true if one is.
    /// The page shows this without reading its vertices; a page without attributes cannot tell.
    bool may_have(const PageView<D> &page, int attribute, double least, double greatest) const {
        return are_elsewhere() || page.may_have_attribute(attribute, least, greatest);
    }

private:
    const unsigned attributes_;
    // Caches: they change no answer.
    mutable std::optional<AttributeReader<D>> apart_;
    mutable std::optional<ValuesById> by_id_;
};

} // namespace abacus
