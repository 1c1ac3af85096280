#include "cache/page_writer.hpp"

#include <numeric>

namespace abacus {

namespace {

/// Where in `added` each corner is. Both have the same orientation, so the first corner
/// tells in 2D, the first two in 3D.
template <int D>
const std::array<std::uint8_t, 4> &arrangement(const std::uint32_t *added,
                                               const std::uint32_t *corner) {
    static constexpr std::array<std::array<std::uint8_t, 4>, 3> rotations{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};
    static constexpr std::array<std::array<std::uint8_t, 4>, 16> even = [] {
        std::array<std::array<std::uint8_t, 4>, 16> table{};
        for (unsigned a = 0; a < 4; ++a)
            for (unsigned b = 0; b < 4; ++b) {
                if (a == b) continue;
                const unsigned rest = 0xfu & ~(1u << a | 1u << b);
                unsigned c = static_cast<unsigned>(std::countr_zero(rest)), d = 6 - a - b - c;
                const unsigned inversions = (a > b) + (a > c) + (a > d) + (b > c) + (b > d);
                if (inversions % 2 == 1) std::swap(c, d); // c < d before
                table[4 * a + b] = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b),
                                    static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(d)};
            }
        return table;
    }();
    const auto place = [&](std::uint32_t vertex) {
        unsigned at = 0;
        for (unsigned i = 1; i <= D; ++i) at += added[i] == vertex ? i : 0;
        return at;
    };
    if constexpr (D == 2) return rotations[place(corner[0])];
    else return even[4 * place(corner[0]) + place(corner[1])];
}

} // namespace

// What comes next in a tree is as hard to foresee as a coin, so nothing is decided by a
// branch where a sum will do.
template <int D>
void PageWriter<D>::order(const std::uint32_t *corners, const Link *across, std::size_t simplices,
                          std::size_t vertices, std::size_t shared, std::size_t links,
                          int attributes) {
    simplices_ = simplices;
    vertices_ = vertices;
    shared_ = shared;
    attributes_ = attributes;
    links_.resize(links);
    codes_.resize(shared);
    columns_.resize(vertices * static_cast<std::size_t>(1 + D + attributes));
    const auto n = static_cast<std::uint32_t>(simplices);
    order_.resize(n + 1); // one more, to be overwritten
    written_.resize(n * (D + 1));
    reached_.resize(n + 1);
    std::fill_n(reached_.begin(), n, 0);
    reached_[n] = 1; // what is outside is never reached
    numbers_.resize(1 + vertices);
    std::fill(numbers_.begin(), numbers_.end(), none);
    numbers_[0] = static_cast<std::uint16_t>(vertices);
    named_.resize(n * (D + 1) + 1);
    link_order_.resize(links + 1);

    Placed *const order = order_.data();
    std::uint8_t *const reached = reached_.data();
    std::uint32_t *const written = written_.data();
    std::uint16_t *const numbers = numbers_.data(), *named = named_.data();
    std::uint32_t *link_order = link_order_.data();
    std::uint32_t count = 0, root = 0;
    unsigned fresh = 0; // next number
    const auto number = [&](std::uint32_t vertex) -> unsigned {
        // at_infinity has the first.
        const unsigned old = numbers[vertex + 1], is_new = old == none;
        const unsigned number = old + (fresh - old) * is_new;
        numbers[vertex + 1] = *named = static_cast<std::uint16_t>(number);
        fresh += is_new;
        return is_new;
    };
    for (std::uint32_t at = 0; at < n; ++at) {
        if (at == count) [[unlikely]] {
            while (reached[root]) ++root;
            reached[root] = 1;
            order[count++] = {root, PageView<D>::no_link, 0, 0};
        }
        const Placed placed = order[at];
        const std::uint32_t *const added = corners + placed.simplex * (D + 1);
        std::uint32_t *const corner = written + at * (D + 1);
        int entry = D + 1;
        unsigned step = 0;
        if (placed.parent == PageView<D>::no_link) [[unlikely]] {
            for (int i = 0; i <= D; ++i, ++named) {
                corner[i] = added[i];
                number(added[i]);
            }
        } else {
            const std::uint32_t apex = added[placed.mirror];
            step = number(apex);
            named += 1 - step;
            entry = child_across<D>(written + link_simplex(placed.parent) * (D + 1),
                                    link_facet(placed.parent), apex, at_infinity, corner);
        }
        const Link *const beyond = across + placed.simplex * (D + 1);
        const auto &arranged = arrangement<D>(added, corner);
        unsigned children = 0;
        for (int f = 0; f <= D; ++f) { // the parent has been reached
            const Link link = beyond[arranged[f]];
            const unsigned is_outside = link >> 31;
            const std::uint32_t simplex = is_outside ? n : link_simplex(link);
            const unsigned is_child = 1u - reached[simplex];
            reached[simplex] = 1;
            order[count] = {simplex, static_cast<std::uint16_t>(make_link(at, f)),
                            static_cast<std::uint8_t>(link_facet(link)), 0};
            count += is_child;
            children |= is_child << f;
            *link_order = link & ~absent;
            link_order += is_outside & (link != untold);
        }
        const unsigned before = (1u << entry) - 1; // of a root: all
        const unsigned bits = (children & before) | (children >> 1 & ~before);
        order[at].step = static_cast<std::uint8_t>(entry > D ? bits : step | bits << 1);
    }
    named_.resize(static_cast<std::size_t>(named - named_.data()));
    for (std::uint32_t v = 1; v <= vertices; ++v) // without simplices: refused by readers
        if (numbers[v] == none) numbers[v] = static_cast<std::uint16_t>(fresh++);
    // Links of untold facets.
    const bool are_untold = link_order == link_order_.data();
    link_order_.resize(links);
    if (are_untold) std::iota(link_order_.begin(), link_order_.end(), 0u);
}

template <int D> bool PageWriter<D>::finish(const Key &lower, const Key &upper) {
    size_ = ABACUS_PAGE_BYTES + 1;
    if (vertices_ > page_vertices<D> || simplices_ > block_slots<D>) return false;
    code_links();
    plan_columns();
    size_ = planned_size();
    if (size_ > ABACUS_PAGE_BYTES) return false;
    write(lower, upper);
    return true;
}

template <int D> void PageWriter<D>::code_links() {
    foreign_.clear();
    parts_.resize(links_.size());
    link_vertices_.resize(links_.size());
    if (links_.empty()) {
        foreign_plan_ = parts_plan_ = {};
        return;
    }
    // The first half of what is numbered are the vertices, the second the foreign codes.
    const std::size_t size = std::bit_ceil(2 * (shared_ + links_.size()));
    const int shift = 64 - std::countr_zero(size);
    index_.resize(size);
    std::fill(index_.begin(), index_.end(), none);
    for (std::uint32_t v = 0; v < shared_; ++v) {
        std::size_t at = codes_[v] * 0x9e3779b97f4a7c15ull >> shift;
        while (index_[at] != none && codes_[index_[at]] != codes_[v]) at = (at + 1) & (size - 1);
        index_[at] = static_cast<std::uint16_t>(v);
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
        const Key &link = links_[link_order_[i]];
        parts_[i] = link.part;
        std::size_t at = link.code * 0x9e3779b97f4a7c15ull >> shift;
        for (;; at = (at + 1) & (size - 1)) {
            const std::uint16_t known = index_[at];
            if (known == none) {
                index_[at] = static_cast<std::uint16_t>(vertices_ + foreign_.size());
                foreign_.push_back(link.code);
                break;
            }
            const std::uint64_t code =
                known < vertices_ ? codes_[known] : foreign_[known - vertices_];
            if (code == link.code) break;
        }
        link_vertices_[i] = index_[at] < vertices_ ? numbers_[1 + index_[at]] : index_[at];
    }
    foreign_plan_ = {foreign_.data(), foreign_.size()};
    parts_plan_ = {parts_.data(), parts_.size()};
}

template <int D> void PageWriter<D>::plan_columns() {
    plans_.resize(static_cast<std::size_t>(1 + D + attributes_));
    for (std::size_t i = 0; i < plans_.size(); ++i)
        plans_[i] = {columns_.data() + i * vertices_, vertices_};
}

template <int D> std::size_t PageWriter<D>::planned_size() const {
    std::size_t size = sizeof(PageHeader) + checksum_bytes;
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
    for (std::size_t i = 0; i < plans_.size(); ++i)
        at = plans_[i].write(columns_.data() + i * vertices_, at);
    at = foreign_plan_.write(foreign_.data(), at);
    at = parts_plan_.write(parts_.data(), at);
    const auto put = [&](const auto &values, int width) {
        BitWriter bits(at);
        for (const auto value : values) bits.put(value, static_cast<unsigned>(width));
        at = bits.close();
    };
    put(link_vertices_, std::bit_width(vertices_ + foreign_.size()));
    BitWriter steps(at);
    for (std::size_t s = 0; s < simplices_; ++s) steps.put(order_[s].step, D + 1);
    at = steps.close();
    put(named_, std::bit_width(vertices_));
    seal_page(page_, size_);
}

template class PageWriter<2>;
template class PageWriter<3>;

} // namespace abacus
