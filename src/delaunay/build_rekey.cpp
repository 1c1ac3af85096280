// Another domain for a mesh that has outgrown its own.
//
// The domain is that of the first points, or a given one. Points outside have the codes of its
// border. The mesh is right all the same, but neighbours in space are far apart on the curve,
// and pages are found slowly. A few such points do no harm, and a domain around one far point
// would harm all others. But a mesh may begin in one corner and grow, tile by tile or row by
// row. Or it begins with one point far away. Then all others have the same code, and only parts
// tell their simplices apart, no longer in the order of the curve.
//
// So the header counts the points that came from outside, and those that came where so many
// simplices have one code that they fill pages. When they are many, the points of the mesh are
// copied to a stage, which knows where they are (spread.hpp). If another domain serves them far
// better, the mesh is built again along its curve, as if all points had come at once. That domain
// leaves room for more points. So a growing mesh is built again only when it is a few times as
// wide, and all rebuilds together cost no more than a second build. If no domain is better, as
// where points crowd at places too far apart for any scale, the count begins anew. So the cost of
// each look is spread over as many points as led to it.
//
// Deleted points and meshes built in batches are not counted. For these a look into a few pages
// answers when somebody asks (crowding.hpp).
#include "delaunay/build.hpp"

#include "blocks/counters.hpp"
#include "delaunay/intake.hpp"
#include "keys/domain_of.hpp"
#include "traverse/own_vertices.hpp"

#include <algorithm>
#include <utility>

namespace abacus {

namespace {

constexpr double room = 1.5; // on either side of the box, of its greatest extent

template <int D> void widen(Box<D> &box) {
    double extent = 0;
    for (int i = 0; i < D; ++i) extent = std::max(extent, box.upper[i] - box.lower[i]);
    if (!(extent < 1e290)) return;
    for (int i = 0; i < D; ++i) {
        box.lower[i] -= room * extent;
        box.upper[i] += room * extent;
    }
}

} // namespace

template <int D> bool Build<D>::has_outgrown_domain(std::uint64_t coming) const {
    const std::uint64_t waiting = facts_->census.staged - facts_->census.inserted;
    const std::uint64_t points =
        facts_->census.vertices + facts_->census.duplicates + waiting + coming;
    return abacus::has_outgrown_domain(facts_->census.outside, points);
}

template <int D> void Build<D>::count_crowded() {
    if (core_->mesh.is_crowded()) ++facts_->census.outside;
}

template <int D> bool Build<D>::change_domain(const Spread<D> &coming, std::size_t memory) {
    abacus_facts shape = *facts_;
    // There are no vertices either: the points go where there is no mesh yet.
    shape.form.has_domain = 0;
    shape.census.vertices = 0;
    Stage<D> points(host_, shape, memory);
    std::array<Record, D + 1> corners;
    const bool is_mesh = has_simplices();
    if (is_mesh) take_apart(points, corners);

    Spread<D> spread(host_);
    spread.add(coming);
    spread.add(points.spread());
    if (is_mesh)
        for (const Record &corner : corners) spread.add(record_point<D>(corner.data()));
    VertexReader<D> waiting(host_, attributes_, facts_->census.inserted, facts_->census.staged);
    while (waiting.advance()) spread.add(waiting.point());

    const Box<D> old = domain_box<D>(facts_->form); // it may have been given for what comes
    Box<D> box = spread.box();
    box.extend(old);
    box = spread.choose(box);
    widen(box);
    facts_->census.outside = 0;
    if (!spread.is_better(box, old)) {
        points.drop();
        return false;
    }

    if (is_mesh) take_repeated(points);
    set_domain(*facts_, box);
    forget_simplices();
    const Domain<D> before = std::exchange(domain_, domain_of<D>(facts_->form));
    rekey_labels(before, memory);
    if (apart_) {
        core_->cache.counters += apart_->take_counters();
        apart_.emplace(host_, domain_, attributes_); // where it was: others know it
    }
    repeated_.emplace(host_, domain_, attributes_);
    if (!is_mesh) return true;

    set_domain(shape, box);
    std::array<VertexIndex, D + 1> vertices;
    for (int i = 0; i <= D; ++i) vertices[i] = create(corners[i].data());
    start(vertices);
    Intake intake(*this, points.points());
    points.emit(intake, shape);
    return true;
}

/// Copies all vertices to a stage, but for the corners of one simplex, from which the next
/// triangulation can begin.
template <int D> void Build<D>::take_apart(Stage<D> &points, std::array<Record, D + 1> &corners) {
    Cache<D> &cache = core_->cache;
    Record record;
    Handle simplex = no_handle;
    for (Key page = first_key; simplex == no_handle && page < end_key;) {
        cache.trim();
        page = cache.visit(page, [&](Handle h) {
            if (!cache.simplex(h).is_ghost()) simplex = h;
        });
    }
    if (simplex == no_handle) throw_corrupted("A mesh with vertices has no simplices.");
    for (int i = 0; i <= D; ++i) read_vertex(cache.simplex(simplex).vertex[i], corners[i].data());

    OwnVertices<D> own(cache);
    for (Key page = first_key; page < end_key;) {
        cache.trim();
        page = own.collect(page);
        for (const VertexIndex v : own.list()) {
            const auto is_at = [&](const Record &corner) {
                return record_point<D>(corner.data()) == cache.point(v);
            };
            if (std::any_of(corners.begin(), corners.end(), is_at)) continue;
            read_vertex(v, record.data());
            points.add(record.data(), 1);
        }
    }
}

/// Moves the points equal to vertices to a stage that has these already.
template <int D> void Build<D>::take_repeated(Stage<D> &points) {
    repeated_->flush();
    RepeatedReader<D> repeated(host_, domain_, attributes_, true);
    while (repeated.advance()) points.add(repeated.record(), 1);
}

template void Build<2>::count_crowded();
template void Build<3>::count_crowded();
template bool Build<2>::has_outgrown_domain(std::uint64_t) const;
template bool Build<3>::has_outgrown_domain(std::uint64_t) const;
template bool Build<2>::change_domain(const Spread<2> &, std::size_t);
template bool Build<3>::change_domain(const Spread<3> &, std::size_t);

} // namespace abacus
