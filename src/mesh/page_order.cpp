// The order of a page's simplices: trees, breadth first across facets, in patches of a few dozen
// (mesh/page_format.hpp). The same tour numbers the vertices and lists the border.
//
// The next step in a tree is as hard to predict as a coin toss, so no branch decides where a sum
// will do: the next value may overwrite the one written, and a cursor moves on by 0 or 1. The whole
// tour is compiled inline, so that its cursors stay in registers.
#include "mesh/page_writer.hpp"

#include <algorithm>

namespace abacus {

namespace {

/// Where in a slot the facets of a simplex are, except the facet to its parent. Corners and slot
/// have the same orientation, and that facet is `entry` among the corners, `mirror` in the slot. In
/// 2D this is enough. In 3D the place of one more corner is needed, which is on that facet.
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
            for (unsigned i = 1; i <= D; ++i)
                place += to_number(slot[i]) == corners[asked_for(entry)] ? i : 0;
        return even_[entry][mirror][place];
    }

private:
    static constexpr int asked_for(int entry) { return entry == 0; }

    Places even_[D + 1][D + 1][D == 2 ? 1 : D + 1]{};
};
template <int D> constexpr OtherFacets<D> other_facets;

} // namespace

/// A tour through the slots of a block. The arrays have room for one more element than there may
/// be, which is overwritten.
template <int D> class PageWriter<D>::Tour {
public:
    [[gnu::always_inline]] Tour(PageWriter &page, const Simplex<D> *slots, std::uint32_t end,
                                Handle first, Vertices &vertices, Numbering &numbered,
                                Arena<Link> &border)
        : slots_(slots), end_(end), first_(first), vertices_(vertices), numbered_(numbered),
          patches_(page.patches_), order_(page.order_.data()), corners_(page.corners_.data()),
          reached_(page.reached_.data()), named_(page.named_.data()), to_border_(border.data()),
          cut_(page.cut_.data()), next_cut_(cut_) {}

    /// Returns how many simplices there are.
    [[gnu::always_inline]] inline std::uint32_t run() {
        for (std::uint32_t at = 0;; ++at) {
            if (at == count_ && !begin_tree(at)) [[unlikely]]
                return count_;
            const Placed placed = order_[at];
            const bool is_root = placed.parent == PageView<D>::no_link;
            const unsigned step = is_root ? place_root(at, placed) : place_child(at, placed);
            order_[at].step = static_cast<std::uint8_t>(step);
        }
    }
    // Where the lists end.
    const std::uint16_t *named_end() const { return named_; }
    const Link *border_end() const { return to_border_; }

private:
    /// Begins a tree at the next simplex that no tree has reached; false if there is none. It
    /// prefers simplices where trees were cut off: so patches are compact, and few remnants are
    /// left.
    [[gnu::always_inline]] inline bool begin_tree(std::uint32_t at) {
        while (next_cut_ < cut_ && reached_[*next_cut_]) ++next_cut_;
        while (root_ < end_ && (reached_[root_] || slots_[root_].is_free())) ++root_;
        const bool is_last = root_ == end_;
        if (at == patch_end_ || is_last) {
            if (at > 0) end_patch();
            patch_end_ += patch_simplices;
        }
        if (is_last) return false;
        const std::uint32_t first = next_cut_ < cut_ ? *next_cut_ : root_;
        reached_[first] = 1;
        order_[count_++] = {first, PageView<D>::no_link, 0, 0};
        return true;
    }
    [[gnu::always_inline]] inline void end_patch() {
        patches_.push_back({static_cast<std::uint16_t>(named_ - named_begin_),
                            static_cast<std::uint16_t>(numbered_.size()),
                            {},
                            {}});
    }
    /// Names a vertex; returns whether it has the next number, so that its name can be omitted.
    [[gnu::always_inline]] inline unsigned number(VertexIndex v) {
        if (v == infinite_vertex) [[unlikely]] {
            *named_ = none;
            return 0;
        }
        const std::size_t next = numbered_.size();
        const std::uint32_t number = numbered_.number_in_room(vertices_, v);
        *named_ = static_cast<std::uint16_t>(number);
        return number == next;
    }
    /// Looks across facet f among the corners, i in the slot; returns 1 if a child lies there, else
    /// 0.
    [[gnu::always_inline]] inline unsigned look_across(std::uint32_t at, std::uint32_t slot, int f,
                                                       int i) {
        const Link link = slots_[slot].link[i];
        const std::uint32_t inside = link_simplex(link) - first_;
        const bool is_outside = inside >= end_;
        const std::uint32_t other = is_outside ? end_ : inside;
        const unsigned is_open = 1u - reached_[other];
        const unsigned is_child = is_open & (count_ < patch_end_);
        reached_[other] |= static_cast<std::uint8_t>(is_child);
        *cut_ = other;
        cut_ += is_open ^ is_child;
        order_[count_] = {other, page_link(at, f), static_cast<std::uint8_t>(link_facet(link)), 0};
        count_ += is_child;
        *to_border_ = make_link(first_ + slot, i);
        to_border_ += is_outside & (link != untold);
        return is_child;
    }
    /// Each returns the simplex's step.
    [[gnu::always_inline]] inline unsigned place_root(std::uint32_t at, const Placed &placed) {
        const Simplex<D> &s = slots_[placed.slot];
        for (int i = 0; i <= D; ++i, ++named_) {
            corners_[at][i] = to_number(s.vertex[i]);
            number(s.vertex[i]);
        }
        unsigned step = 0;
        for (int i = 0; i <= D; ++i) step |= look_across(at, placed.slot, i, i) << i;
        return step;
    }
    [[gnu::always_inline]] inline unsigned place_child(std::uint32_t at, const Placed &placed) {
        const Simplex<D> &s = slots_[placed.slot];
        const VertexIndex apex = s.vertex[placed.mirror];
        const WideLanes parent = corners_[page_simplex(placed.parent)];
        const WideLanes everywhere = WideLanes{} + to_number(apex);
        const int facet = page_facet(placed.parent);
        int entry = facet_back(facet);
        WideLanes child = child_across(parent, facet, everywhere);
        if (apex == infinite_vertex && facet != D) [[unlikely]] {
            entry = D;
            child = ghost_across<D>(parent, facet, everywhere);
        }
        corners_[at] = child;
        unsigned step = number(apex);
        named_ += 1 - step;
        const auto &others = other_facets<D>.find(entry, placed.mirror, child, s.vertex);
        for (int i = 0; i < D; ++i)
            step |= look_across(at, placed.slot, i + (i >= entry), others[i]) << (i + 1);
        return step;
    }

    const Simplex<D> *const slots_;
    const std::uint32_t end_;
    const Handle first_;
    Vertices &vertices_;
    Numbering &numbered_;
    Arena<PagePatch<D>> &patches_;
    Placed *const order_;
    WideLanes *const corners_;
    std::uint8_t *const reached_;
    std::uint16_t *named_;
    std::uint16_t *const named_begin_ = named_;
    Link *to_border_;
    std::uint32_t *cut_, *next_cut_;
    std::uint32_t count_ = 0, root_ = 0, patch_end_ = 0;
};

template <int D>
void PageWriter<D>::order(const Simplex<D> *slots, std::uint32_t end, Handle first,
                          Vertices &vertices, Numbering &numbered, Arena<Link> &border,
                          const FixedFacets<D> *fixed) {
    const std::size_t facets = std::size_t(end) * (D + 1);
    attributes_ = vertices.attribute_count();
    numbered.clear();
    numbered.reserve(facets + 1);
    border.resize(facets + 1);
    order_.resize(std::size_t(end) + 1);
    corners_.resize(end);
    named_.resize(facets + 1);
    cut_.resize(facets + 1);
    reached_.resize(std::size_t(end) + 1);
    std::fill_n(reached_.begin(), end, 0);
    reached_[end] = 1; // outside counts as reached
    patches_.clear();

    Tour tour(*this, slots, end, first, vertices, numbered, border);
    simplices_ = tour.run();
    named_.resize(static_cast<std::size_t>(tour.named_end() - named_.data()));
    border.resize(static_cast<std::size_t>(tour.border_end() - border.data()));
    links_.resize(border.size());
    fixed_.clear();
    regions_.clear();
    if (fixed == nullptr) return;
    gather_fixed(slots, fixed);
    gather_regions(fixed);
}

} // namespace abacus
