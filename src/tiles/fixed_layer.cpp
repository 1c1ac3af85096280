#include "tiles/fixed_layer.hpp"

#include "query/pages/area.hpp"
#include "tiles/in_tile.hpp"
#include "tiles/tile_lines.hpp"

#include <algorithm>

namespace abacus {

namespace {

struct LineKind {
    std::int64_t line;
    bool is_hard;
    auto operator<=>(const LineKind &) const = default;
};

} // namespace

Png fixed_layer(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
                const abacus_extent &extent, std::span<const abacus_tile_edge> edges) {
    const TileWindow window(tile, facts);
    Arena<LineKind> lines(host); // numbered, since a level is a double
    for (const abacus_tile_edge &edge : edges) lines.push_back({edge.line, edge.is_hard != 0});
    std::sort(lines.begin(), lines.end());
    lines.resize(static_cast<std::size_t>(std::unique(lines.begin(), lines.end()) - lines.begin()));
    Arena<abacus_tile_edge> sorted(host);
    for (const abacus_tile_edge &edge : edges) sorted.push_back(edge);
    std::sort(sorted.begin(), sorted.end(), [](const auto &a, const auto &b) {
        return std::lexicographical_compare(a.ends, a.ends + 4, b.ends, b.ends + 4);
    });
    TileLines segments(host);
    for (const abacus_tile_edge &edge : sorted) {
        const auto *const line =
            std::lower_bound(lines.begin(), lines.end(), LineKind{edge.line, edge.is_hard != 0});
        const Point<2> from{edge.ends[0], edge.ends[1]}, to{edge.ends[2], edge.ends[3]};
        const auto add = [&](const Point<2> &a, const Point<2> &b) {
            segments.add(static_cast<double>(line - lines.begin()), in_tile(window, a),
                         in_tile(window, b));
        };
        if (const Polygon *polygon = polygon_of(extent))
            polygon->cut(from, to, [&](const Polygon::Stretch &s) { add(s.first, s.last); });
        else
            add(from, to);
    }
    VectorLayer layer(host, "fixed", {"kind", "line"});
    segments.put_into(layer, [&](VectorLayer &l, double level) {
        const auto &[line, is_hard] = lines[static_cast<std::size_t>(level)];
        l.tag_word(0, is_hard ? 0 : 1, is_hard ? "hard" : "soft");
        l.tag_id(1, line);
    });
    TileBuffer bytes(host);
    {
        TileWriter writer(bytes);
        layer.write(host, writer);
    }
    return as_png(host, bytes);
}

} // namespace abacus
