#include "labels/labelling.hpp"

#include "attributes/rewriting.hpp"
#include "blocks/counters.hpp"
#include "keys/domain_of.hpp"

namespace abacus {

template <int D>
Labelling<D>::Labelling(const Host &host, const abacus_facts &, unsigned known,
                        std::span<const std::uint32_t> labels, std::size_t memory)
    : host_(host), known_(known), labels_(host), some_(host), all_(host),
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

/// The simplex that owns the row.
template <int D>
Owner<D, D + 1> Labelling<D>::owner(NamedSimplices<D> &mesh, const std::uint64_t *record) {
    std::array<std::int64_t, D + 1> ids;
    std::memcpy(ids.data(), record + 2, sizeof ids);
    abacus_simplex simplex;
    mesh.describe(record[0], ids.data(), simplex);
    std::array<Point<D>, D + 1> points;
    for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, points[i].begin());
    return owner_of<D, D + 1>(points);
}

/// Sets the labels of a row; removes the row if all its labels are NULL.
template <int D>
void Labelling<D>::set_row(AttributePages<D, D + 1> &pages, const Owner<D, D + 1> &simplex,
                           std::uint64_t code, std::uint64_t &labelled) {
    const auto is_empty = [](const Arena<double> &values) {
        return std::all_of(values.begin(), values.end(), [](double x) { return std::isnan(x); });
    };
    const bool takes_away = is_empty(some_);
    if (pages.set(simplex, code, {labels_.data(), labels_.size()}, some_.data())) {
        if (!takes_away) return;
        pages.get(simplex, code, all_.data());
        if (!is_empty(all_)) return;
        pages.erase(simplex, code);
        if (labelled-- == 0) throw_corrupted("The header counts too few labels.");
    } else if (!takes_away) {
        std::fill(all_.begin(), all_.end(), null_value);
        for (std::size_t i = 0; i < labels_.size(); ++i) all_[labels_[i]] = some_[i];
        pages.put(simplex, code, all_.data());
        ++labelled;
    }
}

template <int D> void Labelling<D>::set(NamedSimplices<D> &mesh, abacus_header &header) {
    sort_.finish();
    const Domain<D> domain = domain_of<D>(header.facts.form);
    if (header.facts.census.labelled > 0 && known_ < header.facts.columns.labels)
        header.counters +=
            widen_attributes<D, D + 1>(host_, domain, known_, header.facts.columns.labels - known_);
    AttributePages<D, D + 1> pages(host_, domain, header.facts.columns.labels);
    all_.resize(header.facts.columns.labels);
    some_.resize(labels_.size());
    while (const std::uint64_t *record = sort_.next()) {
        const Owner<D, D + 1> simplex = owner(mesh, record);
        std::memcpy(some_.data(), record + 1 + name_words, some_.size() * sizeof(double));
        set_row(pages, simplex, record[0], header.facts.census.labelled);
    }
    pages.flush();
    sort_.close();
    header.counters += pages.take_counters();
}

template class Labelling<2>;
template class Labelling<3>;

} // namespace abacus
