#include "mesh/page_writer.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

template <int D>
bool PageWriter<D>::finish(const Key &lower, const Key &upper, const Vertices &vertices,
                           const Numbering &numbered, const bool *on_border) {
    vertices_ = numbered.size();
    size_ = 0;
    if (vertices_ > page_vertices<D> || simplices_ > block_slots<D>) return false;
    gather(vertices, numbered);
    bound_patches();
    code_links(vertices, numbered, on_border);
    size_ = planned_size();
    if (size_ > ABACUS_PAGE_BYTES) return false;
    write(lower, upper);
    return true;
}

/// Fills the columns of the vertices.
template <int D> void PageWriter<D>::gather(const Vertices &vertices, const Numbering &numbered) {
    const auto columns = static_cast<std::size_t>(1 + D + attributes_);
    columns_.resize(vertices_ * columns);
    plans_.resize(columns);
    for (std::size_t n = 0; n < vertices_; ++n) {
        const VertexIndex v = numbered[n];
        std::uint64_t *word = columns_.data() + n;
        for (const double x : vertices.point(v)) {
            *word = ordered(x);
            word += vertices_;
        }
        *word = static_cast<std::uint64_t>(vertices.id(v));
        const double *const values = vertices.attributes(v);
        for (int i = 0; i < attributes_; ++i) *(word += vertices_) = ordered(values[i]);
    }
    for (std::size_t i = 0; i < columns; ++i)
        plans_[i] = {columns_.data() + i * vertices_, vertices_};
}

template <int D>
void PageWriter<D>::gather_fixed(const Simplex<D> *slots, const FixedFacets<D> *fixed) {
    unsigned all = 0;
    for (std::size_t s = 0; s < simplices_; ++s) all |= fixed[order_[s].slot].bits();
    if (all == 0) return;
    fixed_width_ = FixedFacets<D>::width * (FixedFacets<D>::from_bits(all).any_soft() ? 2 : 1);
    for (std::size_t s = 0; s < simplices_; ++s) {
        const Simplex<D> &simplex = slots[order_[s].slot];
        FixedFacets<D> facets;
        for (int i = 0; i <= D; ++i)
            for (int k = 0; k <= D; ++k)
                if (corners_[s][i] == to_number(simplex.vertex[k]))
                    facets.set(i, fixed[order_[s].slot][k]);
        fixed_.push_back(static_cast<std::uint8_t>(facets.bits()));
    }
}

template <int D> void PageWriter<D>::gather_regions(const FixedFacets<D> *fixed) {
    bool is_any = false;
    regions_.resize(simplices_);
    for (std::size_t s = 0; s < simplices_; ++s) {
        regions_[s] = fixed[order_[s].slot].region();
        is_any = is_any || regions_[s] != no_region;
    }
    if (is_any)
        regions_plan_ = {regions_.data(), simplices_};
    else
        regions_.clear();
}

template <int D> void PageWriter<D>::bound_patches() {
    prefixes_.resize(vertices_);
    for (std::size_t axis = 0; axis < D; ++axis) {
        const std::uint64_t *const words = columns_.data() + axis * vertices_;
        const ColumnPlan plan = plans_[axis];
        for (std::size_t v = 0; v < vertices_; ++v) prefixes_[v] = plan.prefix(words[v]);
        std::size_t v = 0, n = 0;
        for (PagePatch<D> &patch : patches_) {
            Column::Prefix least = std::numeric_limits<Column::Prefix>::max(), greatest = -1;
            const auto add = [&](std::size_t vertex) {
                least = std::min(least, prefixes_[vertex]);
                greatest = std::max(greatest, prefixes_[vertex]);
            };
            for (; v < patch.fresh_end; ++v) add(v);
            for (; n < patch.named_end; ++n)
                if (named_[n] != none) add(named_[n]);
            patch.least[axis] = least;
            patch.greatest[axis] = greatest;
        }
    }
}

/// Codes each link as the number of a vertex with its code, mostly one on the border. After the
/// vertices come the codes that no vertex has.
template <int D>
void PageWriter<D>::code_links(const Vertices &vertices, const Numbering &numbered,
                               const bool *on_border) {
    foreign_.clear();
    parts_.resize(links_.size());
    link_vertices_.resize(links_.size());
    if (links_.empty()) {
        foreign_plan_ = parts_plan_ = {};
        return;
    }
    codes_.clear();
    coded_.clear();
    for (std::size_t n = 0; n < vertices_; ++n) {
        if (!on_border[n]) continue;
        codes_.push_back(vertices[numbered[n]].code);
        coded_.push_back(static_cast<std::uint16_t>(n));
    }
    const std::size_t size = std::bit_ceil(2 * (codes_.size() + links_.size()));
    const int shift = 64 - std::countr_zero(size);
    index_.resize(size);
    std::fill(index_.begin(), index_.end(), none);
    // The slot of a code, or the free one that it would have.
    const auto place = [&](std::uint64_t code) -> std::uint16_t & {
        std::size_t at = code * 0x9e3779b97f4a7c15ull >> shift;
        while (index_[at] != none && codes_[index_[at]] != code) at = (at + 1) & (size - 1);
        return index_[at];
    };
    for (std::size_t i = 0; i < codes_.size(); ++i)
        place(codes_[i]) = static_cast<std::uint16_t>(i);
    for (std::size_t i = 0; i < links_.size(); ++i) {
        const Key &link = links_[i];
        parts_[i] = link.part;
        std::uint16_t &known = place(link.code);
        if (known == none) {
            known = static_cast<std::uint16_t>(codes_.size());
            codes_.push_back(link.code);
            coded_.push_back(static_cast<std::uint16_t>(vertices_ + foreign_.size()));
            foreign_.push_back(link.code);
        }
        link_vertices_[i] = coded_[known];
    }
    foreign_plan_ = {foreign_.data(), foreign_.size()};
    parts_plan_ = {parts_.data(), parts_.size()};
}

template <int D> std::size_t PageWriter<D>::planned_size() const {
    std::size_t size = sizeof(PageHeader) + patches_.size() * sizeof(PagePatch<D>) + checksum_bytes;
    for (const ColumnPlan &plan : plans_) size += plan.size();
    return size + foreign_plan_.size() + parts_plan_.size() +
           bits_to_bytes(links_.size() * std::bit_width(vertices_ + foreign_.size())) +
           bits_to_bytes(simplices_ * (D + 1)) + bits_to_bytes(fixed_.size() * fixed_width_) +
           (regions_.empty() ? 0 : regions_plan_.size()) +
           bits_to_bytes(named_.size() * std::bit_width(vertices_));
}

template <int D> void PageWriter<D>::write(const Key &lower, const Key &upper) {
    PageHeader header{};
    header.magic = PageHeader::expected_magic;
    header.version = PageHeader::expected_version;
    header.dimension = D;
    header.attributes = static_cast<std::uint8_t>(attributes_);
    header.lined =
        static_cast<std::uint8_t>((fixed_.empty() ? 0 : fixed_width_ / FixedFacets<D>::width) |
                                  (regions_.empty() ? 0u : PageHeader::has_regions));
    header.simplices = static_cast<std::uint16_t>(simplices_);
    header.vertices = static_cast<std::uint16_t>(vertices_);
    header.links = static_cast<std::uint16_t>(links_.size());
    header.codes = static_cast<std::uint16_t>(foreign_.size());
    header.lower = lower;
    header.upper = upper;
    std::memcpy(page_, &header, sizeof header);
    unsigned char *at = page_ + sizeof header;
    const std::size_t patches = patches_.size() * sizeof(PagePatch<D>);
    if (patches != 0) std::memcpy(at, patches_.data(), patches); // otherwise data() may be null
    at += patches;
    for (const ColumnPlan &plan : plans_) at = plan.write_head(at);
    at = foreign_plan_.write_head(at);
    at = parts_plan_.write_head(at);
    const auto put = [&](const auto &values, int width) {
        BitWriter bits(at);
        for (const auto value : values) bits.put(value, static_cast<unsigned>(width));
        at = bits.close();
    };
    BitWriter steps(at);
    for (std::size_t s = 0; s < simplices_; ++s) steps.put(order_[s].step, D + 1);
    at = steps.close();
    for (std::uint16_t &number : named_) // the point at infinity comes after the vertices
        number = std::min(number, static_cast<std::uint16_t>(vertices_));
    put(named_, std::bit_width(vertices_));
    for (std::size_t i = 0; i < plans_.size(); ++i)
        at = plans_[i].write_deltas(columns_.data() + i * vertices_, at);
    at = foreign_plan_.write_deltas(foreign_.data(), at);
    at = parts_plan_.write_deltas(parts_.data(), at);
    put(link_vertices_, std::bit_width(vertices_ + foreign_.size()));
    put(fixed_, fixed_width_);
    if (!regions_.empty())
        regions_plan_.write_deltas(regions_.data(), regions_plan_.write_head(at));
    seal_page(page_, size_);
}

template class PageWriter<2>;
template class PageWriter<3>;

} // namespace abacus
