// Locating, walking and interpolating behind the C interface.
#include "query/values/gradient.hpp"
#include "query/values/weighted_mean.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/mesh.hpp"
#include "capi/nearest.hpp"

#include <abacus/locate.h>
#include <abacus/values.h>

namespace {

/// Calls answer(reader, point), which returns whether there is an answer.
template <class Answer>
abacus_status answer_at(abacus_mesh *mesh, const double *point, abacus_error *error,
                        Answer answer) {
    return abacus::guard(error, [&] {
        return mesh->reader.visit([&]<int D>(abacus::Reader<D> &reader) {
            return answer(reader, abacus::finite_point<D>(point)) ? ABACUS_OK : ABACUS_END;
        });
    });
}

} // namespace

abacus_status abacus_mesh_open(const abacus_host *host, const abacus_facts *facts,
                               size_t cache_bytes, abacus_mesh **mesh, abacus_error *error) {
    return abacus::guard(error, [&] {
        *mesh = abacus::create_handle<abacus_mesh>(host, *facts, cache_bytes);
        return ABACUS_OK;
    });
}

void abacus_mesh_close(abacus_mesh *mesh) { abacus::destroy_handle(mesh); }

abacus_status abacus_mesh_locate(abacus_mesh *mesh, const double *point, abacus_simplex *simplex,
                                 abacus_error *error) {
    return answer_at(mesh, point, error,
                     [&](auto &reader, const auto &p) { return reader.locate(p, *simplex); });
}

abacus_status abacus_mesh_interpolate(abacus_mesh *mesh, const abacus_interpolation *interpolation,
                                      const double *point, double *values, abacus_error *error) {
    return answer_at(mesh, point, error, [&]<int D>(abacus::Reader<D> &reader, const auto &p) {
        return mesh->interpolation.get<D>().values(reader, *interpolation, p, values);
    });
}

abacus_status abacus_mesh_weigh(abacus_mesh *mesh, const abacus_interpolation *interpolation,
                                const double *point, const abacus_weight **weights, size_t *count,
                                abacus_error *error) {
    return answer_at(mesh, point, error, [&]<int D>(abacus::Reader<D> &reader, const auto &p) {
        auto &found = mesh->interpolation.get<D>();
        if (!found.weigh(reader, *interpolation, p)) return false;
        *weights = found.weights().data();
        *count = found.weights().size();
        return true;
    });
}

double abacus_weighted_mean(const abacus_weight *weights, const double *values, size_t count) {
    return abacus::weighted_mean(
        count, [&](std::size_t i) { return weights[i].weight; },
        [&](std::size_t i) { return values[i]; });
}

abacus_status abacus_mesh_gradient(abacus_mesh *mesh, const abacus_interpolation *interpolation,
                                   const double *point, double *gradient, int *exponent,
                                   abacus_error *error) {
    return answer_at(mesh, point, error, [&]<int D>(abacus::Reader<D> &reader, const auto &p) {
        return abacus::gradient_at<D>(reader, *interpolation, p, gradient, exponent);
    });
}

abacus_status abacus_mesh_walk(abacus_mesh *mesh, uint64_t code, const int64_t *ids, int facet,
                               abacus_simplex *simplex, abacus_error *error) {
    return abacus::guard(error, [&] {
        return mesh->reader.visit([&](auto &reader) {
            return reader.walk(code, ids, facet, *simplex) ? ABACUS_OK : ABACUS_END;
        });
    });
}

abacus_status abacus_mesh_labels(abacus_mesh *mesh, uint64_t code, const int64_t *ids,
                                 const double **labels, abacus_error *error) {
    return abacus::dispatch(mesh->reader, error, [&]<int D>(abacus::Reader<D> &reader) {
        abacus_simplex simplex;
        reader.describe(code, ids, simplex);
        *labels = mesh->labels.get<D>().of(simplex);
    });
}

abacus_status abacus_mesh_nearest(abacus_mesh *mesh, const double *point, uint64_t k,
                                  abacus_nearest_report report, void *context,
                                  abacus_error *error) {
    return abacus::dispatch(mesh->reader, error, [&]<int D>(abacus::Reader<D> &reader) {
        const auto p = abacus::finite_point<D>(point);
        std::uint64_t rank = 0;
        abacus::Nearest<D>(reader).find(p, k, [&](const std::uint64_t *record) {
            const double distance = abacus::distance<D>(p, abacus::record_point<D>(record));
            abacus::report_vertex<D>(0, ++rank, record, distance, report, context);
        });
    });
}

abacus_status abacus_mesh_vertex_at(abacus_mesh *mesh, const double *point, int64_t *id,
                                    abacus_error *error) {
    return answer_at(mesh, point, error, [&](auto &reader, const auto &p) {
        const auto found = reader.vertex_at(p);
        if (found) *id = *found;
        return found.has_value();
    });
}

abacus_status abacus_mesh_star(abacus_mesh *mesh, const double *point, abacus_simplex_report report,
                               void *context, abacus_error *error) {
    return abacus::dispatch(mesh->reader, error, [&]<int D>(abacus::Reader<D> &reader) {
        reader.star(abacus::finite_point<D>(point), [&](const abacus_simplex &simplex) {
            abacus::host::require(report(context, &simplex));
        });
    });
}

abacus_status abacus_mesh_neighbours(abacus_mesh *mesh, uint64_t code, const int64_t *ids,
                                     uint32_t steps, abacus_simplex_report report, void *context,
                                     abacus_error *error) {
    return abacus::dispatch(mesh->reader, error, [&](auto &reader) {
        reader.neighbours(code, ids, steps, [&](const abacus_simplex &simplex) {
            abacus::host::require(report(context, &simplex));
        });
    });
}

void abacus_mesh_counters(const abacus_mesh *mesh, abacus_counters *counters) {
    const_cast<abacus_mesh *>(mesh)->reader.visit(
        [&](auto &reader) { *counters = reader.cache().counters; });
}
