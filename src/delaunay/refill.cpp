#include "delaunay/refill.hpp"

#include <algorithm>
#include <string>

namespace abacus {

namespace {

constexpr std::size_t named_at_most = 10; // lines in an error

std::string in_words(const Arena<std::int64_t> &lines) {
    std::string words = lines.size() == 1 ? "line " : "lines ";
    for (std::size_t i = 0; i < std::min(lines.size(), named_at_most); ++i)
        words += (i > 0 ? ", " : "") + std::to_string(lines[i]);
    if (lines.size() > named_at_most)
        words += " and " + std::to_string(lines.size() - named_at_most) + " more";
    return words;
}

void sort_unique(Arena<std::int64_t> &lines) {
    std::sort(lines.begin(), lines.end());
    lines.resize(static_cast<std::size_t>(std::unique(lines.begin(), lines.end()) - lines.begin()));
}

} // namespace

std::size_t Refill::look_at(const Star<2> &star) {
    const Cache<2> &cache = mesh_.cache();
    spokes_.clear();
    regions_.clear();
    for (std::size_t i = 0; i < star.link().size(); ++i) {
        const Link outer = star.rim()[i].outer,
                   inner = cache.simplex(link_simplex(outer)).link[link_facet(outer)];
        regions_.push_back(cache.region(link_simplex(inner)));
        const Fixed how = cache.fixed(make_link(link_simplex(inner), (link_facet(inner) + 2) % 3));
        if (how == Fixed::no) continue;
        spokes_.push_back(i);
        kind_ = how;
    }
    return spokes_.size();
}

bool Refill::is_straight(const Star<2> &star) const {
    const Cache<2> &cache = mesh_.cache();
    if (spokes_.size() != 2) return false;
    const Point<2> &p = cache.point(star.vertex()), &a = cache.point(star.link()[spokes_[0]]),
                   &b = cache.point(star.link()[spokes_[1]]);
    return orientation(a, p, b) == 0 && !is_same_way(p, a, b);
}

void Refill::require_removable(const Star<2> &star, LineSource *lines) {
    if (spokes_.empty()) return;
    if (lines == nullptr)
        throw Error(ABACUS_ERROR_STATE, "points cannot be deleted without the lines of the mesh");
    Cache<2> &cache = mesh_.cache();
    Arena<std::int64_t> naming(cache.host());
    for (const abacus_segment_end &segment : lines->at(cache.point(star.vertex())))
        naming.push_back(segment.line);
    if (!naming.empty()) {
        sort_unique(naming);
        throw Error(ABACUS_ERROR_STATE,
                    "point " + std::to_string(cache.vertices().id(star.vertex())) +
                        " cannot be deleted: " + in_words(naming) + " of the mesh " +
                        (naming.size() == 1 ? "names it" : "name it"),
                    {}, "Remove the line with abacus_unconstrain() first.");
    }
    if (!is_straight(star)) refuse_crossing(star, *lines);
}

void Refill::refuse_crossing(const Star<2> &star, LineSource &lines) {
    Cache<2> &cache = mesh_.cache();
    const std::int64_t id = cache.vertices().id(star.vertex());
    const Point<2> p = cache.point(star.vertex());
    Arena<Point<2>> ends(cache.host()); // searching moves the link's vertices
    for (const std::size_t spoke : spokes_) ends.push_back(cache.point(star.link()[spoke]));
    Arena<std::int64_t> through(cache.host());
    LinesOver over(mesh_, lines);
    for (const Point<2> &end : ends)
        if (const auto line = over.find(p, end)) through.push_back(*line);
    sort_unique(through);
    // A line may pass through twice, as a loop does.
    if (through.empty() || spokes_.size() < 4) throw_corrupted("A fixed edge belongs to no line.");
    const bool is_one = through.size() == 1;
    throw Error(
        ABACUS_ERROR_STATE,
        "point " + std::to_string(id) + " cannot be deleted: " + in_words(through) +
            (is_one ? " of the mesh would cross itself there" : " of the mesh would cross there"),
        {},
        is_one ? "Remove the line with abacus_unconstrain() first."
               : "Remove one of the lines with abacus_unconstrain() first.");
}

void Refill::take(const Star<2> &star, std::size_t i) {
    corners_.push_back(star.link()[i]);
    beyond_.push_back(patch_.outside(star.rim()[i].outer));
}

Patch::Side Refill::fill_side(const Star<2> &star, std::size_t i, std::size_t j) {
    corners_.clear();
    beyond_.clear();
    const std::size_t size = star.link().size();
    patch_.set_region(regions_[i]);
    bool has_infinity = false;
    for (std::size_t n = i; n != j; n = (n + 1) % size) {
        take(star, n);
        has_infinity |= star.link()[n] == infinite_vertex;
    }
    corners_.push_back(star.link()[j]);
    if (!has_infinity)
        return patch_.fill_chain({corners_.data(), corners_.size()},
                                 {beyond_.data(), beyond_.size()});
    // Both edges are on the hull: a ghost closes it.
    if (corners_.size() != 3) throw_no_triangulation();
    return patch_.add({corners_[0], corners_[1], corners_[2]},
                      {beyond_[1], Patch::unknown, beyond_[0]});
}

std::size_t Refill::fill(const Star<2> &star) {
    patch_.begin();
    if (spokes_.size() == 2) {
        const Patch::Side one = fill_side(star, spokes_[0], spokes_[1]),
                          other = fill_side(star, spokes_[1], spokes_[0]);
        patch_.join(one, other, kind_);
        return patch_.finish();
    }
    patch_.set_region(*std::max_element(regions_.begin(), regions_.end())); // ghosts are in none
    corners_.clear();
    beyond_.clear();
    for (std::size_t i = 0; i < star.link().size(); ++i) take(star, i);
    const std::span<const VertexIndex> corners(corners_.data(), corners_.size());
    const std::span<const Patch::Side> beyond(beyond_.data(), beyond_.size());
    if (corners_[0] == infinite_vertex)
        patch_.fill_fan(corners, beyond);
    else
        patch_.fill_star(corners, beyond, mesh_.cache().point(star.vertex()));
    return patch_.finish();
}

} // namespace abacus
