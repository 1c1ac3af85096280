#include "query/scan/vertex_scan.hpp"

#include "keys/domain_of.hpp"
#include "query/pages/page_scan.hpp"

namespace abacus {
namespace {

template <int D> void fill(abacus_vertex &vertex, const std::uint64_t *record) {
    const Point<D> p = record_point<D>(record);
    vertex = {};
    vertex.id = record_id(record);
    std::copy(p.begin(), p.end(), vertex.point);
    vertex.attributes = record_attributes<D>(record);
}

} // namespace

template <int D>
VertexScan<D>::VertexScan(const Host &host, const abacus_facts &facts, std::size_t cache_bytes)
    : attributes_(facts.columns.attributes), listed_(abacus_lists_vertices(facts.standing)),
      mesh_(host, facts, cache_bytes), own_(mesh_.cache()),
      page_(facts.census.vertices > 0 ? first_key : end_key), records_(host),
      vertices_left_(facts.census.vertices),
      repeated_(host, domain_of<D>(facts.form), facts.columns.attributes),
      repeated_left_(facts.census.duplicates),
      waiting_(host,
               listed_ ? static_cast<unsigned>(page_attributes(facts.columns))
                       : facts.columns.attributes,
               listed_ ? 0 : facts.census.inserted, facts.census.staged) {}

template <int D> void VertexScan<D>::collect() {
    Cache<D> &cache = mesh_.cache();
    cache.trim();
    page_ = own_.collect(page_);
    records_.clear();
    at_ = 0;
    std::array<double, ABACUS_MAX_ATTRIBUTES> values;
    for (const VertexIndex v : own_.list()) {
        mesh_.vertex_values().all(cache.vertices(), v, values.data());
        fill_record<D>(records_.extend(record_words(D, attributes_)), cache.vertices().id(v),
                       cache.point(v), values.data(), attributes_);
    }
}

template <int D> bool VertexScan<D>::next_vertex(abacus_vertex &vertex) {
    while (at_ == records_.size()) {
        if (!(page_ < end_key)) {
            if (vertices_left_ != 0) throw_corrupted(other_vertex_count);
            return false;
        }
        collect();
    }
    if (vertices_left_ == 0) throw_corrupted(other_vertex_count);
    --vertices_left_;
    fill<D>(vertex, records_.data() + at_);
    at_ += record_words(D, attributes_);
    vertex.vertex = vertex.id;
    return true;
}

template <int D> bool VertexScan<D>::next_repeated(abacus_vertex &vertex) {
    // After its end, each further call would search the table again, once for each waiting point.
    if (!more_repeated_) return false;
    more_repeated_ = repeated_.advance();
    // Nothing else would show that some of its pages are lost.
    if (more_repeated_ != (repeated_left_ > 0))
        throw_corrupted("The header counts more or fewer repeated points than there are.");
    if (!more_repeated_) return false;
    --repeated_left_;
    fill<D>(vertex, repeated_.record());
    const auto found = mesh_.vertex_at(record_point<D>(repeated_.record()));
    if (!found) throw_corrupted("A repeated point is not a vertex of the mesh.");
    vertex.vertex = *found;
    return true;
}

template <int D> bool VertexScan<D>::next_waiting(abacus_vertex &vertex) {
    if (!waiting_.advance()) return false;
    fill<D>(vertex, waiting_.record());
    vertex.waits = 1;
    vertex.sequence = waiting_.sequence();
    return true;
}

template <int D> bool VertexScan<D>::next_listed(abacus_vertex &vertex) {
    if (!waiting_.advance()) return false;
    fill<D>(vertex, waiting_.record());
    vertex.vertex = vertex.id;
    if (mesh_.vertex_values().are_elsewhere()) {
        records_.resize(attributes_);
        auto *const values = reinterpret_cast<double *>(records_.data());
        mesh_.vertex_values().all_of(vertex.id, waiting_.point(), values);
        vertex.attributes = values;
    }
    return true;
}

template <int D> bool VertexScan<D>::next(abacus_vertex &vertex) {
    if (listed_) return next_listed(vertex);
    return next_vertex(vertex) || next_repeated(vertex) || next_waiting(vertex);
}

template class VertexScan<2>;
template class VertexScan<3>;

} // namespace abacus
