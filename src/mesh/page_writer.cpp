#include "mesh/page_writer.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

namespace {

/// Where in a slot the facets of a simplex are, but for that to its parent. Corners and slot have
/// the same orientation, and that facet is `entry` among the corners, `mirror` in the slot: this
/// is all in 2D. In 3D the place of one corner more is asked for, which is on that facet.
template <int D> class OtherFacets {
public:
    using Places = std::array<std::uint8_t, 4>;

    constexpr OtherFacets() {
        Places all{0, 1, 2, 3};
        do {
            if (!is_even(all)) continue;
            for (int entry = 0; entry <= D; ++entry) {
                Places &others = even_[entry][all[entry]][D == 2 ? 0 : all[asked_for(entry)]];
                for (int i = 0; i < D; ++i) others[i] = all[i + (i >= entry)];
            }
        } while (std::next_permutation(all.begin(), all.begin() + D + 1));
    }

    const Places &find(int entry, int mirror, WideLanes corners,
                       const std::array<VertexIndex, D + 1> &slot) const {
        unsigned place = 0;
        if constexpr (D == 3)
            for (unsigned i = 1; i <= D; ++i) place += slot[i] == corners[asked_for(entry)] ? i : 0;
        return even_[entry][mirror][place];
    }

private:
    static constexpr int asked_for(int entry) { return entry == 0; }

    Places even_[D + 1][D + 1][D == 2 ? 1 : D + 1]{};
};
template <int D> constexpr OtherFacets<D> other_facets;

} // namespace

// What comes next in a tree is as hard to foresee as a coin, so nothing is decided by a
// branch where a sum will do.
template <int D>
void PageWriter<D>::order(const Simplex<D> *slots, std::uint32_t end, Handle first,
                          Vertices &vertices, Numbering &numbered, Arena<Link> &border) {
    attributes_ = vertices.attribute_count();
    numbered.clear();
    numbered.reserve(std::size_t(end) * (D + 1) + 1);
    border.resize(std::size_t(end) * (D + 1) + 1); // here and below one more, to be overwritten
    order_.resize(end + 1);
    corners_.resize(end);
    named_.resize(std::size_t(end) * (D + 1) + 1);
    cut_.resize(std::size_t(end) * (D + 1) + 1);
    reached_.resize(end + 1);
    std::fill_n(reached_.begin(), end, 0);
    reached_[end] = 1; // what is outside is never reached

    Placed *const order = order_.data();
    std::uint8_t *const reached = reached_.data();
    WideLanes *const corners = corners_.data();
    std::uint16_t *named = named_.data();
    Link *to_border = border.data();
    std::uint32_t *cut = cut_.data(), *next_cut = cut;
    std::uint32_t count = 0, root = 0, patch_end = 0;
    patches_.clear();
    const auto number = [&](VertexIndex v) -> unsigned { // whether it is the next number
        if (v == infinite_vertex) [[unlikely]] {
            *named = none;
            return 0;
        }
        const std::size_t next = numbered.size();
        const std::uint32_t number = numbered.number_in_room(vertices, v);
        *named = static_cast<std::uint16_t>(number);
        return number == next;
    };
    for (std::uint32_t at = 0;; ++at) {
        if (at == count) [[unlikely]] {
            // Go on where trees were cut off; so patches are compact, and few remnants are left.
            while (next_cut < cut && reached[*next_cut]) ++next_cut;
            while (root < end && (reached[root] || slots[root].is_free())) ++root;
            if (at == patch_end || root == end) {
                if (at > 0)
                    patches_.push_back({static_cast<std::uint16_t>(named - named_.data()),
                                        static_cast<std::uint16_t>(numbered.size()),
                                        {},
                                        {}});
                patch_end += patch_simplices;
            }
            if (root == end) break;
            const std::uint32_t first = next_cut < cut ? *next_cut : root;
            reached[first] = 1;
            order[count++] = {first, PageView<D>::no_link, 0, 0};
        }
        const Placed placed = order[at];
        const Simplex<D> &s = slots[placed.slot];
        // Facet f among the corners, i in the slot: a child, 1, or none.
        const auto look_across = [&](int f, int i) -> unsigned {
            const Link link = s.link[i];
            const std::uint32_t inside = link_simplex(link) - first;
            const bool is_outside = inside >= end;
            const std::uint32_t slot = is_outside ? end : inside;
            const unsigned is_open = 1u - reached[slot];
            const unsigned is_child = is_open & (count < patch_end);
            reached[slot] |= static_cast<std::uint8_t>(is_child);
            *cut = slot;
            cut += is_open ^ is_child;
            order[count] = {slot, static_cast<std::uint16_t>(make_link(at, f)),
                            static_cast<std::uint8_t>(link_facet(link)), 0};
            count += is_child;
            *to_border = make_link(first + placed.slot, i);
            to_border += is_outside & (link != untold);
            return is_child;
        };
        unsigned step = 0;
        if (placed.parent == PageView<D>::no_link) [[unlikely]] {
            for (int i = 0; i <= D; ++i, ++named) {
                corners[at][i] = s.vertex[i];
                number(s.vertex[i]);
            }
            for (int i = 0; i <= D; ++i) step |= look_across(i, i) << i;
        } else {
            const VertexIndex apex = s.vertex[placed.mirror];
            const WideLanes parent = corners[link_simplex(placed.parent)];
            const WideLanes everywhere = WideLanes{} + apex;
            const int facet = link_facet(placed.parent);
            int entry = facet_back(facet);
            WideLanes child = child_across(parent, facet, everywhere);
            if (apex == infinite_vertex && facet != D) [[unlikely]] {
                entry = D;
                child = ghost_across<D>(parent, facet, everywhere);
            }
            corners[at] = child;
            step = number(apex);
            named += 1 - step;
            const auto &others = other_facets<D>.find(entry, placed.mirror, child, s.vertex);
            for (int i = 0; i < D; ++i) step |= look_across(i + (i >= entry), others[i]) << (i + 1);
        }
        order[at].step = static_cast<std::uint8_t>(step);
    }
    simplices_ = count;
    named_.resize(static_cast<std::size_t>(named - named_.data()));
    border.resize(static_cast<std::size_t>(to_border - border.data()));
    links_.resize(border.size());
}

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

/// A link is the number of a vertex with its code, mostly one on the border; after the
/// vertices come the codes that none of them has.
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
    // The place of a code, or the free one that it would have.
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
           bits_to_bytes(simplices_ * (D + 1)) +
           bits_to_bytes(named_.size() * std::bit_width(vertices_));
}

template <int D> void PageWriter<D>::write(const Key &lower, const Key &upper) {
    PageHeader header{};
    header.magic = PageHeader::expected_magic;
    header.version = PageHeader::expected_version;
    header.dimension = D;
    header.attributes = static_cast<std::uint8_t>(attributes_);
    header.simplices = static_cast<std::uint16_t>(simplices_);
    header.vertices = static_cast<std::uint16_t>(vertices_);
    header.links = static_cast<std::uint16_t>(links_.size());
    header.codes = static_cast<std::uint16_t>(foreign_.size());
    header.lower = lower;
    header.upper = upper;
    std::memcpy(page_, &header, sizeof header);
    unsigned char *at = page_ + sizeof header;
    const std::size_t patches = patches_.size() * sizeof(PagePatch<D>);
    if (patches != 0) std::memcpy(at, patches_.data(), patches); // else there may be no data()
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
    seal_page(page_, size_);
}

template class PageWriter<2>;
template class PageWriter<3>;

} // namespace abacus
