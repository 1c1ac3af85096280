#include "query/numbering.hpp"

#include "keys/domain_of.hpp"
#include "mesh/bit_column.hpp"
#include "query/page_simplex.hpp"
#include "sort/pacer.hpp"

#include <array>
#include <bit>

namespace abacus {

namespace {

/// A vertex as one page names it: its code, its coordinates in their order, the place of the name
/// (which page, which of its vertices), and what else is kept of it.
template <int D> struct NameLayout {
    static constexpr std::size_t coordinates = 1;
    static constexpr std::size_t key = 1 + D; // what tells a vertex from others
    static constexpr std::size_t place = key;
    static constexpr std::size_t rest = place + 1;

    static bool is_same(const std::uint64_t *a, const std::uint64_t *b) {
        return std::equal(a, a + key, b);
    }
};

constexpr std::uint64_t place_of(std::uint64_t page, int vertex) {
    return page << 16 | static_cast<std::uint64_t>(vertex);
}

constexpr const char *other_count = "The header counts other vertices than the pages hold.";

/// Adds the names of all vertices of all pages. fill(rest, page, vertex) adds the rest.
template <int D, class Fill>
void sort_names(const Host &host, const abacus_header &header, RecordSort &names, Fill fill) {
    using Layout = NameLayout<D>;
    const Domain<D> domain = domain_of<D>(header);
    PageScan<D> pages(host, header);
    Pacer pacer(host);
    std::uint64_t seen = 0; // simplices
    pacer.begin(ABACUS_PHASE_SCANNING, header.simplices + header.ghosts);
    for (std::uint64_t number = 1; pages.advance(); ++number) {
        const PageView<D> &page = pages.page();
        pacer.reached(seen += static_cast<std::uint64_t>(page.simplices()));
        for (int v = 0; v < page.vertices(); ++v) {
            const Point<D> &p = page.point(v);
            std::uint64_t *name = names.add();
            name[0] = domain.code(p);
            for (int axis = 0; axis < D; ++axis)
                name[Layout::coordinates + axis] = ordered(p[axis]);
            name[Layout::place] = place_of(number, v);
            fill(name + Layout::rest, page, v);
        }
    }
    names.finish();
}

} // namespace

// The key takes the place in: of equal names the same one comes first whatever the memory.
template <int D>
NumberedVertices<D>::NumberedVertices(const Host &host, const abacus_header &header,
                                      std::size_t memory)
    : named_(host, NameLayout<D>::rest + 1 + header.attributes, NameLayout<D>::key + 1, memory),
      left_(header.vertices), current_(host) {
    const int attributes = static_cast<int>(header.attributes);
    sort_names<D>(host, header, named_,
                  [attributes](std::uint64_t *rest, const PageView<D> &page, int v) {
                      *rest++ = static_cast<std::uint64_t>(page.id(v));
                      for (int i = 0; i < attributes; ++i)
                          *rest++ = std::bit_cast<std::uint64_t>(page.attribute(v, i));
                  });
    current_.resize(NameLayout<D>::rest + 1 + header.attributes);
    ahead_ = named_.next();
}

template <int D> bool NumberedVertices<D>::next(abacus_vertex &vertex) {
    using Layout = NameLayout<D>;
    if ((ahead_ == nullptr) != (left_ == 0)) throw_corrupted(other_count);
    if (ahead_ == nullptr) {
        named_.close();
        return false;
    }
    --left_;
    std::copy_n(ahead_, current_.size(), current_.data());
    do ahead_ = named_.next();
    while (ahead_ != nullptr && Layout::is_same(ahead_, current_.data()));

    vertex = {};
    for (int axis = 0; axis < D; ++axis)
        vertex.point[axis] = from_ordered(current_[Layout::coordinates + axis]);
    vertex.id = vertex.vertex = static_cast<std::int64_t>(current_[Layout::rest]);
    vertex.attributes = reinterpret_cast<const double *>(current_.data() + Layout::rest + 1);
    return true;
}

template <int D>
NumberedSimplices<D>::NumberedSimplices(const Host &host, const abacus_header &header,
                                        std::size_t memory)
    : host_(host), header_(header), places_(host, 2, 1, memory / 2), pages_(host, header),
      numbers_(host) {
    number(memory / 2);
}

template <int D> void NumberedSimplices<D>::number(std::size_t memory) {
    using Layout = NameLayout<D>;
    RecordSort names(host_, Layout::rest, Layout::key, memory);
    sort_names<D>(host_, header_, names, [](std::uint64_t *, const PageView<D> &, int) {});
    std::array<std::uint64_t, Layout::key> current{};
    std::uint64_t count = 0;
    while (const std::uint64_t *name = names.next()) {
        if (count == 0 || !Layout::is_same(name, current.data())) {
            ++count;
            std::copy_n(name, Layout::key, current.data());
        }
        std::uint64_t *place = places_.add();
        place[0] = name[Layout::place];
        place[1] = count - 1;
    }
    if (count != header_.vertices) throw_corrupted(other_count);
    names.close();
    places_.finish();
}

template <int D> void NumberedSimplices<D>::enter_page() {
    ++page_;
    at_ = 0;
    numbers_.resize(static_cast<std::size_t>(pages_.page().vertices()));
    for (std::size_t v = 0; v < numbers_.size(); ++v) {
        const std::uint64_t *place = places_.next();
        if (place == nullptr || place[0] != place_of(page_, static_cast<int>(v)))
            throw_corrupted("A page has other vertices than when it was read before.");
        numbers_[v] = place[1];
    }
}

template <int D> bool NumberedSimplices<D>::next(abacus_simplex &simplex, std::uint64_t *numbers) {
    const Domain<D> domain = domain_of<D>(header_);
    for (;;) {
        const PageView<D> &page = pages_.page();
        while (page_ > 0 && at_ < page.simplices()) {
            const int s = at_++;
            if (page.is_ghost(s)) continue;
            const auto &order = describe(page, s, domain, simplex);
            for (int i = 0; i <= D; ++i) numbers[i] = numbers_[page.corner(s, order[i])];
            return true;
        }
        if (!pages_.advance()) {
            places_.close();
            return false;
        }
        enter_page();
    }
}

template class NumberedVertices<2>;
template class NumberedVertices<3>;
template class NumberedSimplices<2>;
template class NumberedSimplices<3>;

} // namespace abacus
