#include "change/deleting.hpp"

#include "change/intake.hpp"
#include "change/outlet.hpp"
#include "traverse/own_vertices.hpp"

namespace abacus {

template <int D> std::uint64_t Deleting<D>::remove(Stage<D> &stage, bool exactly) {
    std::uint64_t taken = 0;
    if (work_.has_simplices() || work_.has_waiting()) {
        Outlet outlet(*this, stage, exactly);
        stage.emit(outlet, *work_.facts, true);
        taken = outlet.taken();
    }
    if (rest_) triangulate_rest();
    return taken;
}

template <int D> std::uint64_t Deleting<D>::clear() {
    abacus_census &census = work_.facts->census;
    if (census.lines > 0)
        throw Error(ABACUS_ERROR_STATE, "points cannot all be removed: lines of the mesh name some",
                    {}, "Remove the lines with abacus_unconstrain() first.");
    const std::uint64_t points =
        census.vertices + census.duplicates + (census.staged - census.inserted);
    work_.repeated->forget();
    work_.erase_pages(ABACUS_STAGED_PAGES);
    work_.erase_pages(ABACUS_REPEATED_PAGES);
    census.inserted = census.staged;
    work_.forget_simplices();
    return points;
}

template <int D> std::uint64_t Deleting<D>::erase(const Point<D> &p, Leaving &leaving) {
    if (rest_ && rest_->has_left_out(p)) return 0;
    RepeatedPoints<D> &repeated = *work_.repeated;
    const bool is_repeated = work_.facts->census.duplicates > 0 && repeated.contains(p);
    if (!is_repeated) return erase_vertex(p, &leaving);
    leaving.begin();
    const auto more = work_.core->removal.offer(p, leaving);
    if (!more) throw_corrupted("A repeated point equals no vertex of the mesh.");
    if (*more) repeated.offer(p, leaving);
    leaving.decide();
    const std::uint64_t taken = repeated.take(p, leaving);
    work_.count_repeated_taken(taken);
    return taken + (leaving.has_first() ? pass_on(p) : 0);
}

template <int D> std::uint64_t Deleting<D>::pass_on(const Point<D> &p) {
    std::uint64_t &duplicates = work_.facts->census.duplicates;
    const std::uint64_t *next = duplicates > 0 ? work_.repeated->take_first(p) : nullptr;
    if (next == nullptr) return erase_vertex(p);
    work_.rename(p, next);
    --duplicates;
    return 1;
}

template <int D> std::uint64_t Deleting<D>::erase_vertex(const Point<D> &p, Leaving *want) {
    Removal<D> &removal = work_.core->removal;
    if (rest_) {
        if (!removal.finds(p, want)) return 0;
        rest_->leave_out(p);
        return 1;
    }
    switch (removal.remove(p, want)) {
    case Removed::no_such_vertex:
        return 0;
    case Removed::removed:
        --work_.facts->census.vertices;
        if (work_.apart) work_.apart->drop(p, work_.domain.code(p));
        break;
    case Removed::collapses:
        collapse();
        break;
    }
    return 1;
}

template <int D> void Deleting<D>::collapse() {
    // Of equal points the vertex comes first, as it did.
    VertexPageWriter pages(work_.host, D, work_.attributes, work_.facts->census.staged);
    AnyRecord<D> record;
    work_.core->removal.each_neighbour([&](VertexIndex v) {
        work_.read_vertex(v, record.data());
        pages.add(record.data());
    });
    make_repeated_wait(pages);
    work_.forget_simplices();
}

template <int D> void Deleting<D>::make_repeated_wait(VertexPageWriter &pages) {
    work_.repeated->flush();
    RepeatedReader<D> repeated(work_.host, work_.domain, work_.attributes, true);
    while (repeated.advance()) pages.add(repeated.record());
    work_.repeated->forget();
    pages.finish();
    work_.facts->census.staged = pages.next();
    work_.facts->census.duplicates = 0;
}

template <int D> void Deleting<D>::triangulate_rest() {
    abacus_census &census = work_.facts->census;
    AnyRecord<D> record;
    each_vertex(work_.core->cache, [&](VertexIndex v) {
        work_.read_vertex(v, record.data());
        rest_->add(record.data());
    });
    const std::uint64_t repeated = census.duplicates, vertices = census.vertices;
    work_.forget_simplices();
    census.duplicates = repeated; // their vertices come again, and their pages stay
    Intake<D> intake(inserting_, vertices);
    rest_->emit(intake);
    rest_.reset();
    inserting_.insert_waiting(0); // if they had to be staged after all
    if (work_.has_simplices() || repeated == 0) return;
    VertexPageWriter pages(work_.host, D, work_.attributes, census.staged);
    make_repeated_wait(pages);
}

template class Deleting<2>;
template class Deleting<3>;

} // namespace abacus
