#include "support/page_editor.hpp"

#include "cache/domain_of.hpp"
#include "cache/page_writer.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace abacus::test {

PageEditor::PageEditor(const MemoryHost::Page &page, const abacus_header &mesh)
    : domain(domain_of<2>(mesh)), attribute_count(static_cast<int>(mesh.attributes)) {
    PageView<2> view;
    view.read(reinterpret_cast<const unsigned char *>(page.words.data()), page.size,
              attribute_count);
    lower = view.lower();
    upper = view.upper();
    for (int v = 0; v < view.vertices(); ++v) {
        ids.push_back(view.id(v));
        points.push_back(view.point(v));
        attributes.emplace_back();
        for (int i = 0; i < attribute_count; ++i)
            attributes.back().push_back(view.attribute(v, i));
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

std::vector<Link> PageEditor::across_facets(const std::vector<std::uint32_t> &corners) const {
    struct Facet {
        Link link;
        bool odd;
    };
    std::map<std::array<std::uint32_t, 2>, std::vector<Facet>> facets;
    for (std::size_t s = 0; s < simplices.size(); ++s)
        for (int i = 0; i < 3; ++i) {
            const FacetVertices<2, std::uint32_t> facet(&corners[3 * s], i);
            facets[facet.vertex].push_back({make_link(static_cast<Handle>(s), i), facet.odd});
        }
    std::vector<Link> across(corners.size(), PageWriter<2>::untold);
    const auto at = [&](Link link) -> Link & {
        return across[3 * link_simplex(link) + static_cast<std::size_t>(link_facet(link))];
    };
    bool is_sound = true;
    for (const auto &[vertices, sides] : facets) {
        is_sound &= sides.size() == 1 || (sides.size() == 2 && sides[0].odd != sides[1].odd);
        if (sides.size() != 2) continue;
        at(sides[0].link) = sides[1].link;
        at(sides[1].link) = sides[0].link;
    }
    std::size_t outside = 0;
    for (Link &link : across)
        if (link == PageWriter<2>::untold) link = PageWriter<2>::outside(outside++);
    if (!is_sound || outside != links.size())
        std::fill(across.begin(), across.end(), PageWriter<2>::untold);
    return across;
}

void PageEditor::write(MemoryHost::Page &page) const {
    MemoryHost memory;
    const Host host = memory.host();
    PageWriter<2> writer(host);
    std::vector<std::uint32_t> corners;
    for (const auto &simplex : simplices)
        for (const int corner : simplex)
            corners.push_back(corner == infinity ? PageWriter<2>::at_infinity
                                                 : static_cast<std::uint32_t>(corner));
    const std::vector<Link> across = across_facets(corners);
    writer.order(corners.data(), across.data(), simplices.size(), ids.size(), ids.size(),
                 links.size(), attribute_count);
    for (std::size_t v = 0; v < ids.size(); ++v) {
        std::vector<double> values = attributes[v];
        values.resize(static_cast<std::size_t>(attribute_count));
        writer.set_vertex(v, ids[v], points[v], domain.code(points[v]), values.data());
    }
    for (std::size_t i = 0; i < links.size(); ++i) writer.set_link(i, links[i]);
    if (!writer.finish(lower, upper)) throw std::logic_error("too much for a page");
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
