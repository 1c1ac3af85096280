#include "constrain/region_cuts.hpp"

namespace abacus {

namespace {

Faces::Access access_to(Delaunay<2> &mesh) {
    return {[&mesh](const Point<2> &p) {
                const Link corner = vertex_at(mesh, p);
                if (corner == unset) throw_corrupted("A fixed edge ends where no vertex is.");
                return corner;
            },
            [&mesh] { mesh.finish(mesh.anywhere); }};
}

} // namespace

RegionCuts::RegionCuts(Delaunay<2> &mesh, std::size_t memory)
    : mesh_(mesh), cache_(mesh.cache()), regions_(mesh, memory), flood_(mesh),
      faces_(cache_, access_to(mesh)), of_edges_(cache_.host()), seeded_(cache_.host()) {}

void RegionCuts::add(const Point<2> &a, const Point<2> &b) {
    if (are_many_) return;
    each_edge_on(mesh_, a, b, [&](Link edge) {
        const RegionNumber region = cache_.region(link_simplex(edge));
        are_many_ = are_many_ || faces_.size() >= 2 * most_edges;
        if (region == no_region || cache_.region(right_of(cache_, edge)) != region || are_many_)
            return;
        const auto &vertex = cache_.simplex(link_simplex(edge)).vertex;
        const Point<2> from = cache_.point(vertex[(link_facet(edge) + 1) % 3]),
                       to = cache_.point(vertex[(link_facet(edge) + 2) % 3]);
        faces_.add({from, to});
        faces_.add({to, from});
        of_edges_.push_back(region);
    });
}

bool RegionCuts::finish(RegionParts &parts, abacus_region_fault &fault) {
    if (are_many_) return renew(parts, fault);
    std::sort(of_edges_.begin(), of_edges_.end());
    faces_.sort();
    Found found = find_seeds(parts, fault);
    if (found == Found::sound) found = clear_cut_off();
    return found == Found::too_much ? renew(parts, fault) : found == Found::sound;
}

RegionCuts::Found RegionCuts::find_seeds(RegionParts &parts, abacus_region_fault &fault) {
    Found found = Found::sound;
    parts.each([](RegionNumber, const Point<2> &, const Point<2> &) {},
               [&](RegionNumber region, const Point<2> &p) {
                   if (found != Found::sound ||
                       !std::binary_search(of_edges_.begin(), of_edges_.end(), region))
                       return;
                   const Handle h = regions_.at_seed(region, p, fault);
                   if (h == no_handle) {
                       found = Found::fault;
                       return;
                   }
                   seeded_.push_back({region, face(faces_.name(h))});
                   mesh_.finish(mesh_.anywhere);
                   if (seeded_.size() > most_seeds || faces_.steps() > most_steps)
                       found = Found::too_much;
               });
    return found;
}

template <class Visit> void RegionCuts::each_seeded(Visit visit) {
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        const Faces::Edge edge = faces_[i];
        const RegionNumber region =
            cache_.region(link_simplex(RegionFlood::left_of(mesh_, edge.from, edge.to)));
        mesh_.finish(mesh_.anywhere);
        // It was taken out from another edge, or is an outline's.
        if (std::none_of(seeded_.begin(), seeded_.end(),
                         [&](const Seeded &seed) { return seed.region == region; }))
            continue;
        if (!visit(edge, Seeded{region, face(faces_.name(edge))})) return;
    }
}

RegionCuts::Found RegionCuts::clear_cut_off() {
    // All faces are known before the first triangle changes: finding regions anew begins with whole
    // ones.
    each_seeded([&](const Faces::Edge &, const Seeded &) { return faces_.steps() <= most_steps; });
    if (faces_.steps() > most_steps) return Found::too_much;
    each_seeded([&](const Faces::Edge &edge, const Seeded &here) {
        if (std::find(seeded_.begin(), seeded_.end(), here) != seeded_.end()) return true;
        abacus_region_fault none;
        flood_.begin(RegionFlood::Rule::face, here.region);
        flood_.take(link_simplex(RegionFlood::left_of(mesh_, edge.from, edge.to)));
        flood_.run(none);
        return true;
    });
    return Found::sound;
}

bool RegionCuts::renew(RegionParts &parts, abacus_region_fault &fault) {
    regions_.clear(parts);
    return regions_.fill(
        parts, [](RegionNumber, const Box<2> &) {}, fault); // boxes stay around them
}

} // namespace abacus
