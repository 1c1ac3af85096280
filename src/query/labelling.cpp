#include "query/labelling.hpp"

#include "attributes/rewriting.hpp"
#include "blocks/counters.hpp"
#include "keys/domain_of.hpp"

namespace abacus {

template <int D>
Labelling<D>::Labelling(const Host &host, const abacus_header &header, unsigned known,
                        std::span<const std::uint32_t> labels, std::size_t memory,
                        std::size_t cache_bytes)
    : host_(host), header_(header), known_(known), cache_bytes_(cache_bytes), labels_(host),
      sort_(host, 1 + name_words + labels.size(), 2, memory) {
    for (const std::uint32_t label : labels) labels_.push_back(label);
}

template <int D> void Labelling<D>::add(const std::uint64_t *rows, std::size_t count) {
    const std::size_t words = name_words + labels_.size();
    for (std::size_t i = 0; i < count; ++i, rows += words) {
        std::uint64_t *record = sort_.add();
        record[0] = rows[0];
        record[1] = sort_.size();
        std::copy(rows + 1, rows + words, record + 2);
    }
}

/// Whose row it is.
template <int D> Owner<D, D + 1> Labelling<D>::owner(Reader<D> &mesh, const std::uint64_t *record) {
    std::array<std::int64_t, D + 1> ids;
    std::memcpy(ids.data(), record + 2, sizeof ids);
    abacus_simplex simplex;
    mesh.describe(record[0], ids.data(), simplex);
    std::array<Point<D>, D + 1> points;
    for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, points[i].begin());
    return owner_of<D, D + 1>(points);
}

template <int D> void Labelling<D>::set(abacus_header &header) {
    sort_.finish();
    const Domain<D> domain = domain_of<D>(header);
    if (header.labelled > 0 && known_ < header.labels)
        header.counters +=
            widen_attributes<D, D + 1>(host_, domain, known_, header.labels - known_);
    Reader<D> mesh(host_, header_, cache_bytes_);
    AttributePages<D, D + 1> pages(host_, domain, header.labels);
    Arena<double> all(host_), some(host_);
    all.resize(header.labels);
    some.resize(labels_.size());
    while (const std::uint64_t *record = sort_.next()) {
        const Owner<D, D + 1> simplex = owner(mesh, record);
        const std::uint64_t code = record[0];
        std::memcpy(some.data(), record + 1 + name_words, some.size() * sizeof(double));
        if (pages.set(simplex, code, {labels_.data(), labels_.size()}, some.data())) continue;
        std::fill(all.begin(), all.end(), null_value);
        for (std::size_t i = 0; i < labels_.size(); ++i) all[labels_[i]] = some[i];
        pages.put(simplex, code, all.data());
        ++header.labelled;
    }
    pages.flush();
    sort_.close();
    header.counters += pages.take_counters();
}

template class Labelling<2>;
template class Labelling<3>;

} // namespace abacus
