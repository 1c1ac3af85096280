#include "support/page_editor.hpp"

#include "keys/domain_of.hpp"
#include "mesh/page_writer.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>

namespace abacus::test {

PageEditor::PageEditor(const MemoryHost::Page &page, const abacus_header &mesh)
    : domain(domain_of<2>(mesh.facts.form)),
      attribute_count(static_cast<int>(mesh.facts.columns.attributes)) {
    PageView<2> view;
    view.read(reinterpret_cast<const unsigned char *>(page.words.data()), page.size,
              attribute_count);
    lower = view.lower();
    upper = view.upper();
    for (int v = 0; v < view.vertices(); ++v) {
        ids.push_back(view.id(v));
        points.push_back(view.point(v));
        attributes.emplace_back();
        for (int i = 0; i < attribute_count; ++i) attributes.back().push_back(view.attribute(v, i));
    }
    for (int i = 0; i < view.links(); ++i) {
        const int v = view.link_vertex(i);
        links.push_back({v < view.vertices() ? domain.code(points[v]) : view.foreign_code(v),
                         view.has_parts() ? view.link_part(i) : 0});
    }
    for (int s = 0; s < view.simplices(); ++s) {
        std::array<int, 3> corners;
        for (int i = 0; i < 3; ++i) {
            const int v = view.corner(s, i);
            corners[i] = v == view.vertices() ? infinity : v;
        }
        simplices.push_back(corners);
    }
}

std::vector<Simplex<2>> PageEditor::slots() const {
    struct Facet {
        Link link;
        bool odd;
    };
    std::vector<Simplex<2>> slots;
    std::map<std::array<VertexIndex, 2>, std::vector<Facet>> facets;
    for (const auto &corners : simplices) {
        Simplex<2> &slot = slots.emplace_back();
        const auto handle = static_cast<Handle>(slots.size() - 1);
        for (int i = 0; i < 3; ++i) slot.vertex[i] = static_cast<VertexIndex>(corners[i] + 1);
        slot.link.fill(absent);
        for (int i = 0; i < 3; ++i) {
            const FacetVertices<2, VertexIndex> facet(slot.vertex, i);
            facets[facet.vertex].push_back({make_link(handle, i), facet.odd});
        }
    }
    bool is_sound = true;
    std::size_t outside = 0;
    for (const auto &[vertices, sides] : facets) {
        is_sound &= sides.size() == 1 || (sides.size() == 2 && sides[0].odd != sides[1].odd);
        outside += sides.size() == 1;
        if (sides.size() != 2) continue;
        for (int i = 0; i < 2; ++i)
            slots[to_number(link_simplex(sides[i].link))].link[link_facet(sides[i].link)] =
                sides[1 - i].link;
    }
    if (!is_sound || outside != links.size())
        for (Simplex<2> &slot : slots) slot.link.fill(PageWriter<2>::untold);
    return slots;
}

void PageEditor::write(MemoryHost::Page &page) const {
    static_assert(VertexIndex{infinity + 1} == infinite_vertex);
    MemoryHost memory;
    const Host host = memory.host();
    VertexHeap<2> vertices(host, attribute_count);
    for (std::size_t v = 0; v < ids.size(); ++v) {
        std::vector<double> values = attributes[v];
        values.resize(static_cast<std::size_t>(attribute_count));
        vertices.create(points[v], domain.code(points[v]), ids[v], values.data());
    }
    PageWriter<2> writer(host);
    VertexHeap<2>::Numbering numbered(host);
    Arena<Link> border(host);
    const std::vector<Simplex<2>> slots = this->slots();
    writer.order(slots.data(), static_cast<std::uint32_t>(slots.size()), Handle{}, vertices,
                 numbered, border);
    for (std::uint32_t n = 1; n <= ids.size(); ++n) // without a simplex
        numbered.number(vertices, VertexIndex{n});
    const bool is_told = !border.empty();
    writer.expect_links(links.size());
    for (std::size_t i = 0; i < links.size(); ++i)
        writer.set_link(i, links[is_told ? link_of(static_cast<int>(link_simplex(border[i])),
                                                   link_facet(border[i]))
                                         : i]);
    const auto on_border = std::make_unique<bool[]>(numbered.size());
    std::fill_n(on_border.get(), numbered.size(), true);
    if (!writer.finish(lower, upper, vertices, numbered, on_border.get()))
        throw std::logic_error("too much for a page");
    page.assign(writer.bytes(), writer.size());
}

int PageEditor::number_of(const Point<2> &p) const {
    const auto at = std::find(points.begin(), points.end(), p);
    return at == points.end() ? -1 : static_cast<int>(at - points.begin());
}

int PageEditor::neighbour(int simplex, int i) const {
    const int a = simplices[simplex][(i + 1) % 3], b = simplices[simplex][(i + 2) % 3];
    for (int s = 0; s < static_cast<int>(simplices.size()); ++s) {
        const auto &c = simplices[s];
        if (s != simplex && std::count(c.begin(), c.end(), a) && std::count(c.begin(), c.end(), b))
            return s;
    }
    return -1;
}

int PageEditor::vertex(bool on_border) const {
    std::vector<bool> border(ids.size());
    for (int s = 0; s < static_cast<int>(simplices.size()); ++s)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (neighbour(s, i) < 0 && j != i && simplices[s][j] != infinity)
                    border[simplices[s][j]] = true;
    return static_cast<int>(std::find(border.begin(), border.end(), on_border) - border.begin());
}

int PageEditor::link_of(int simplex, int facet) const {
    int links = 0;
    for (int s = 0; s <= simplex; ++s)
        for (int i = 0; i < 3; ++i) {
            if (s == simplex && i == facet) return links;
            if (neighbour(s, i) < 0) ++links;
        }
    throw std::logic_error("no such facet");
}

} // namespace abacus::test
