// Fixed edges behind the C interface.
#include "capi/build.hpp"
#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/in_plane.hpp"
#include "capi/mesh.hpp"
#include "capi/segments.hpp"
#include "query/locate/edges_along.hpp"

#include <abacus/constrain.h>

abacus_status abacus_segments_open(const abacus_host *host, const abacus_facts *facts,
                                   size_t memory, abacus_segments **segments, abacus_error *error) {
    return abacus::guard(error, [&] {
        *segments = abacus::create_handle<abacus_segments>(host, *facts, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_segments_add(abacus_segments *segments, const abacus_segment *added,
                                  size_t count, abacus_error *error) {
    using abacus::Fixed;
    return abacus::guard(error, [&] {
        for (size_t i = 0; i < count; ++i)
            segments->segments.add(added[i].ends[0],
                                   added[i].is_soft != 0 ? Fixed::soft : Fixed::hard);
        return ABACUS_OK;
    });
}

abacus_status abacus_segments_end(abacus_segments *segments, abacus_error *error) {
    return abacus::guard(error, [&] {
        segments->segments.close();
        return ABACUS_OK;
    });
}

void abacus_segments_close(abacus_segments *segments) { abacus::destroy_handle(segments); }

abacus_status abacus_build_lines(abacus_build *build, abacus_segments_at at, void *context,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        build->lines.emplace(at, context);
        build->build.visit([&](auto &opened) { opened.set_lines(&*build->lines); });
        return ABACUS_OK;
    });
}

abacus_status abacus_build_fix(abacus_build *build, abacus_segments *segments,
                               abacus_header *header, abacus_error *error) {
    return abacus::run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
        opened.fix(segments->segments, changed);
    });
}

abacus_status abacus_build_unfix(abacus_build *build, abacus_segments *segments,
                                 abacus_header *header, abacus_region_fault *fault,
                                 abacus_error *error) {
    return abacus::run_sound_change(build, header, error,
                                    [&](auto &opened, abacus_header &changed) {
                                        return opened.unfix(segments->segments, *fault, changed);
                                    });
}

abacus_status abacus_build_restore(abacus_build *build, abacus_segments *edges,
                                   abacus_header *header, abacus_error *error) {
    return abacus::run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
        opened.restore(edges->segments, changed);
    });
}

abacus_status abacus_build_vertex_at(abacus_build *build, const double place[2], uint64_t *record,
                                     abacus_error *error) {
    return abacus::in_plane(build->build, "lines", error, [&](abacus::Build<2> &opened) {
        return opened.find_vertex(abacus::finite_point<2>(place), record) ? ABACUS_OK : ABACUS_END;
    });
}

abacus_status abacus_edges_along(abacus_mesh *mesh, const double a[2], const double b[2],
                                 abacus_along_report report, void *context, int *is_whole,
                                 abacus_error *error) {
    using namespace abacus;
    return in_plane(mesh->reader, "lines", error, [&](Reader<2> &reader) {
        const auto tell = [&](VertexIndex from, VertexIndex to, Fixed how) {
            const VertexHeap<2> &vertices = reader.cache().vertices();
            const std::int64_t ids[2] = {vertices.id(from), vertices.id(to)};
            const Point<2> &p = vertices.point(from), &q = vertices.point(to);
            const double ends[2][2] = {{p[0], p[1]}, {q[0], q[1]}};
            const abacus_edge_kind kind = how == Fixed::no     ? ABACUS_FREE_EDGE
                                          : how == Fixed::soft ? ABACUS_SOFT_EDGE
                                                               : ABACUS_HARD_EDGE;
            host::require(report(context, ids, ends, kind));
        };
        *is_whole = edges_along(reader, finite_point<2>(a), finite_point<2>(b), tell);
        return ABACUS_OK;
    });
}

abacus_status abacus_fixed_straight_on(abacus_mesh *mesh, const double behind[2],
                                       const double at[2], double next[2], abacus_error *error) {
    using namespace abacus;
    return in_plane(mesh->reader, "lines", error, [&](Reader<2> &reader) {
        const auto corner = corner_at(reader, finite_point<2>(at));
        if (!corner) return ABACUS_END;
        const auto end = fixed_straight_on(reader.cache(), *corner, finite_point<2>(behind));
        if (!end) return ABACUS_END;
        std::copy(end->begin(), end->end(), next);
        return ABACUS_OK;
    });
}

abacus_status abacus_is_on_ray(const double from[2], const double through[2], const double p[2],
                               abacus_error *error) {
    using namespace abacus;
    return guard(error, [&] {
        return is_on_ray(finite_point<2>(from), finite_point<2>(through), finite_point<2>(p))
                   ? ABACUS_OK
                   : ABACUS_END;
    });
}
