#include "support/page_editor.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace abacus::test {

PageEditor::PageEditor(const MemoryHost::Page &page) {
    const auto *bytes = reinterpret_cast<const unsigned char *>(page.words.data());
    std::memcpy(&header, bytes, sizeof header);
    const auto view = PageView<2>::parse(bytes, page.size, header.attributes);
    for (int i = 0; i < 4; ++i) box[i] = view.box(i);
    for (int v = 0; v < view.vertices(); ++v) {
        ids.push_back(view.id(v));
        points.push_back(view.point(v));
        attributes.emplace_back(view.attributes(v), view.attributes(v) + header.attributes);
    }
    for (int i = 0; i < view.links(); ++i) {
        const Key link = view.link(i);
        links.push_back({link.code, view.has_parts() ? link.part : 0});
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

void PageEditor::write(MemoryHost::Page &page, bool keep_box) const {
    PageHeader h = header;
    h.simplices = static_cast<std::uint16_t>(simplices.size());
    h.vertices = static_cast<std::uint16_t>(ids.size());
    h.links = static_cast<std::uint16_t>(links.size());
    h.flags = ids.size() > 255 ? PageHeader::wide : 0;
    for (const Key &link : links)
        if (link.part != 0) h.flags |= PageHeader::long_links;
    constexpr double most = std::numeric_limits<double>::infinity();
    std::array<double, 4> bounds{most, most, -most, -most};
    for (const Point<2> &p : points)
        for (int i = 0; i < 2; ++i) {
            bounds[i] = std::min(bounds[i], p[i]);
            bounds[2 + i] = std::max(bounds[2 + i], p[i]);
        }
    if (keep_box) bounds = box;

    std::vector<unsigned char> bytes;
    const auto put = [&](const auto &value) {
        const auto *from = reinterpret_cast<const unsigned char *>(&value);
        bytes.insert(bytes.end(), from, from + sizeof value);
    };
    put(h);
    put(bounds);
    for (const std::int64_t id : ids) put(id);
    for (const Point<2> &p : points) put(p);
    for (const auto &values : attributes)
        for (const double value : values) put(value);
    for (const Key &link : links) put(link.code);
    if (h.flags & PageHeader::long_links)
        for (const Key &link : links) put(link.part);
    for (const auto &corners : simplices)
        for (const int corner : corners) {
            const int number = corner == infinity ? h.vertices : corner;
            if (h.flags & PageHeader::wide)
                put(static_cast<std::uint16_t>(number));
            else
                put(static_cast<std::uint8_t>(number));
        }
    page.assign(bytes.data(), bytes.size());
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
