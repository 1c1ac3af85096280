#include "change/constraining.hpp"

#include "constrain/fixing.hpp"
#include "constrain/freeing.hpp"
#include "constrain/region_cuts.hpp"
#include "constrain/restoring.hpp"

namespace abacus {

namespace {
constexpr std::uint64_t segments_at_once = 256; // between two reports
} // namespace

template <int D>
template <class Change>
std::uint64_t Constraining<D>::each(Segments &segments, Change change) {
    const std::uint64_t all = segments.size();
    std::uint64_t done = 0;
    work_.report(ABACUS_PHASE_INSERTING, 0, all);
    segments.each([&](const Segment &segment) {
        change(segment);
        if (++done % segments_at_once == 0)
            work_.report(ABACUS_PHASE_INSERTING, done - gathering_.size(), all);
    });
    return all;
}

template <int D>
void Constraining<D>::take(const std::uint64_t *records, const std::uint64_t *, std::size_t n) {
    if constexpr (D == 2) {
        Fixing fixing(work_.core->mesh);
        for (; n > 0; --n, records += segment_record_words) {
            const Segment segment = record_segment(records);
            fixing.fix(segment.a, segment.b, segment.how);
        }
    }
}

template <int D> std::uint64_t Constraining<D>::fix(Segments &segments) {
    if constexpr (D == 2) {
        if (!work_.has_simplices())
            throw Error(ABACUS_ERROR_STATE, "the points of the mesh span no triangle");
        work_.core->mesh.is_constrained = true;
        gathering_.begin(*this, segments.size(), segment_record_words);
        if (!gathering_.gathers()) {
            Fixing fixing(work_.core->mesh);
            return each(segments, [&](const Segment &s) { fixing.fix(s.a, s.b, s.how); });
        }
        std::array<std::uint64_t, segment_record_words> record;
        const std::uint64_t all = each(segments, [&](const Segment &s) {
            fill_segment(record.data(), s);
            const std::uint64_t code = work_.domain.code(s.a);
            gathering_.gather(record.data(), segment_record_words, &code, 1);
        });
        gathering_.finish();
        return all;
    } else {
        throw Error(ABACUS_ERROR_ARGUMENT, "lines need a mesh of dimension 2");
    }
}

template <int D> bool Constraining<D>::unfix(Segments &segments, abacus_region_fault &fault) {
    if constexpr (D == 2) {
        if (!work_.has_simplices()) return true;
        if (work_.lines == nullptr)
            throw Error(ABACUS_ERROR_STATE, "edges cannot be freed without the lines of the mesh");
        work_.core->mesh.is_constrained = true;
        Freeing freeing(work_.core->mesh, *work_.lines);
        bool is_sound = true;
        each(segments, [&](const Segment &s) {
            if (!is_sound) return;
            const RegionNumber ending = freeing.free(s.a, s.b);
            is_sound = ending == no_region;
            fault = region_fault(ABACUS_REGION_BORDER, ending, no_region, s.a, s.a, s.b);
        });
        return is_sound;
    } else {
        throw Error(ABACUS_ERROR_ARGUMENT, "lines need a mesh of dimension 2");
    }
}

template <int D> std::uint64_t Constraining<D>::restore(Segments &edges) {
    if constexpr (D == 2) {
        Restoring restoring(work_.core->mesh);
        return each(edges, [&](const Segment &s) { restoring.restore(s.a, s.b); });
    } else {
        throw Error(ABACUS_ERROR_ARGUMENT, "lines need a mesh of dimension 2");
    }
}

template <int D> template <class Change> void Constraining<D>::with_regions(Change change) {
    if constexpr (D == 2) {
        if (!work_.has_simplices())
            throw Error(ABACUS_ERROR_STATE, "the points of the mesh span no triangle");
        work_.core->mesh.is_constrained = true;
        change(work_.core->mesh);
    } else {
        throw Error(ABACUS_ERROR_ARGUMENT, "regions need a mesh of dimension 2");
    }
}

template <int D> void Constraining<D>::name_line(abacus_region_fault &fault) {
    if constexpr (D == 2) {
        const Point<2> a{fault.edge[0][0], fault.edge[0][1]}, b{fault.edge[1][0], fault.edge[1][1]};
        if (work_.lines == nullptr || a == b) return;
        const auto line = LinesOver(work_.core->mesh, *work_.lines).find(a, b);
        fault.has_line = line ? 1 : 0;
        fault.line = line.value_or(0);
    }
}

template <int D>
bool Constraining<D>::fill_regions(RegionParts &parts, const Regions::Report &report,
                                   abacus_region_fault &fault) {
    bool is_sound = true;
    with_regions(
        [&](auto &mesh) { is_sound = Regions(mesh, parts.memory()).fill(parts, report, fault); });
    if (is_sound)
        parts.close();
    else
        name_line(fault);
    return is_sound;
}

template <int D> void Constraining<D>::clear_regions(RegionParts &parts) {
    with_regions([&](auto &mesh) { Regions(mesh, parts.memory()).clear(parts); });
    parts.close();
}

template <int D>
bool Constraining<D>::cut_regions(Segments &segments, RegionParts &parts,
                                  abacus_region_fault &fault) {
    bool is_sound = true;
    with_regions([&](auto &mesh) {
        RegionCuts cuts(mesh, parts.memory());
        segments.each([&](const Segment &s) { cuts.add(s.a, s.b); });
        is_sound = cuts.finish(parts, fault);
    });
    if (is_sound)
        parts.close();
    else
        name_line(fault);
    return is_sound;
}

template <int D>
void Constraining<D>::regions_along(Segments &segments,
                                    const std::function<void(RegionNumber)> &visit) {
    with_regions([&](auto &mesh) {
        segments.each([&](const Segment &s) { each_region_along(mesh, s.a, s.b, visit); });
    });
}

template <int D> bool Constraining<D>::find_vertex(const Point<D> &p, std::uint64_t *record) {
    if constexpr (D == 2) {
        if (record != nullptr && work_.apart)
            throw Error(ABACUS_ERROR_STATE,
                        "attributes that are apart are not read between changes");
        Delaunay<2> &mesh = work_.core->mesh;
        const Link corner = vertex_at(mesh, p);
        if (corner != unset && record != nullptr) {
            const Simplex<2> &s = mesh.cache().simplex(link_simplex(corner));
            work_.read_vertex(s.vertex[link_facet(corner)], record);
        }
        mesh.finish(mesh.anywhere);
        return corner != unset;
    } else {
        throw Error(ABACUS_ERROR_ARGUMENT, "lines need a mesh of dimension 2");
    }
}

template class Constraining<2>;
template class Constraining<3>;

} // namespace abacus
