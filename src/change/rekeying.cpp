#include "change/rekeying.hpp"

#include "blocks/counters.hpp"
#include "change/crowding.hpp"
#include "change/intake.hpp"
#include "keys/domain_of.hpp"
#include "points/vertex_reader.hpp"
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

template <int D> bool Rekeying<D>::has_outgrown_domain(std::uint64_t coming) const {
    const abacus_census &census = work_.facts->census;
    const std::uint64_t waiting = census.staged - census.inserted;
    return abacus::has_outgrown_domain(census.outside,
                                       census.vertices + census.duplicates + waiting + coming);
}

template <int D> bool Rekeying<D>::change_domain(const Spread<D> &coming, std::size_t memory) {
    abacus_facts shape = *work_.facts;
    // There are no vertices either: the points go where there is no mesh yet.
    shape.form.has_domain = 0;
    shape.census.vertices = 0;
    Stage<D> points(work_.host, shape, memory);
    Corners corners;
    const bool is_mesh = work_.has_simplices();
    if (is_mesh) take_apart(points, corners);

    bool is_better;
    const Box<D> box = best_box(coming, points, is_mesh ? &corners : nullptr, is_better);
    work_.facts->census.outside = 0;
    if (!is_better) {
        points.drop();
        return false;
    }
    if (is_mesh) take_repeated(points);
    start_over(box, memory);
    if (!is_mesh) return true;

    set_domain(shape, box);
    std::array<const std::uint64_t *, D + 1> records;
    for (int i = 0; i <= D; ++i) records[i] = corners[i].data();
    inserting_.start(records);
    Intake<D> intake(inserting_, points.points());
    points.emit(intake, shape);
    return true;
}

template <int D>
Box<D> Rekeying<D>::best_box(const Spread<D> &coming, const Stage<D> &points,
                             const Corners *corners, bool &is_better) const {
    const abacus_facts &facts = *work_.facts;
    Spread<D> spread(work_.host);
    spread.add(coming);
    spread.add(points.spread());
    if (corners != nullptr)
        for (const AnyRecord<D> &corner : *corners) spread.add(record_point<D>(corner.data()));
    VertexReader<D> waiting(work_.host, work_.attributes, facts.census.inserted,
                            facts.census.staged);
    while (waiting.advance()) spread.add(waiting.point());

    const Box<D> old = domain_box<D>(facts.form); // it may have been given for what comes
    Box<D> box = spread.box();
    box.extend(old);
    box = spread.choose(box);
    widen(box);
    is_better = spread.is_better(box, old);
    return box;
}

template <int D> void Rekeying<D>::start_over(const Box<D> &box, std::size_t memory) {
    set_domain(*work_.facts, box);
    work_.forget_simplices();
    const Domain<D> before = std::exchange(work_.domain, domain_of<D>(work_.facts->form));
    labels_.rekey(before, memory);
    if (work_.apart) {
        work_.counters() += work_.apart->take_counters();
        work_.apart.emplace(work_.host, work_.domain,
                            work_.attributes); // where it was: others know it
    }
    work_.repeated.emplace(work_.host, work_.domain, work_.attributes);
}

/// Copies all vertices to a stage, but for the corners of one simplex, from which the next
/// triangulation can begin.
template <int D> void Rekeying<D>::take_apart(Stage<D> &points, Corners &corners) {
    take_corners(corners);
    Cache<D> &cache = work_.core->cache;
    AnyRecord<D> record;
    OwnVertices<D> own(cache);
    for (Key page = first_key; page < end_key;) {
        cache.trim();
        page = own.collect(page);
        for (const VertexIndex v : own.list()) {
            const auto is_at = [&](const AnyRecord<D> &corner) {
                return record_point<D>(corner.data()) == cache.point(v);
            };
            if (std::any_of(corners.begin(), corners.end(), is_at)) continue;
            work_.read_vertex(v, record.data());
            points.add(record.data(), 1);
        }
    }
}

template <int D> void Rekeying<D>::take_corners(Corners &corners) {
    Cache<D> &cache = work_.core->cache;
    Handle simplex = no_handle;
    for (Key page = first_key; simplex == no_handle && page < end_key;) {
        cache.trim();
        page = cache.visit(page, [&](Handle h) {
            if (!cache.simplex(h).is_ghost()) simplex = h;
        });
    }
    if (simplex == no_handle) throw_corrupted("A mesh with vertices has no simplices.");
    for (int i = 0; i <= D; ++i)
        work_.read_vertex(cache.simplex(simplex).vertex[i], corners[i].data());
}

/// Moves the points equal to vertices to a stage that has these already.
template <int D> void Rekeying<D>::take_repeated(Stage<D> &points) {
    work_.repeated->flush();
    RepeatedReader<D> repeated(work_.host, work_.domain, work_.attributes, true);
    while (repeated.advance()) points.add(repeated.record(), 1);
}

template class Rekeying<2>;
template class Rekeying<3>;

} // namespace abacus
