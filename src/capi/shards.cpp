// Shards behind the C interface.
#include "geometry/distance.hpp"
#include "keys/domain_of.hpp"
#include "shards/exports.hpp"
#include "shards/given_box.hpp"
#include "shards/survey.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/shards.h>

struct abacus_survey {
    abacus_survey(const abacus_host *table, const abacus_facts &facts)
        : host(*table), survey(host, facts) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Survey> survey;
};

struct abacus_exports {
    abacus_exports(const abacus_host *table, const abacus_facts &facts,
                   std::span<const std::uint64_t> borders, std::uint32_t shard,
                   const abacus_box &extent)
        : host(*table), exports(host, facts, borders, shard, extent) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Exports> exports;
};

abacus_status abacus_survey_open(const abacus_host *host, const abacus_facts *facts,
                                 abacus_survey **survey, abacus_error *error) {
    return abacus::guard(error, [&] {
        *survey = abacus::create_handle<abacus_survey>(host, *facts);
        return ABACUS_OK;
    });
}

abacus_status abacus_survey_add(abacus_survey *survey, const uint64_t *points, size_t count,
                                abacus_error *error) {
    return abacus::guard(error, [&] {
        survey->survey.visit([&](auto &opened) { opened.add(points, count); });
        return ABACUS_OK;
    });
}

abacus_status abacus_survey_merge(abacus_survey *survey, uint64_t points, const abacus_box *box,
                                  const double *sample, size_t count, abacus_error *error) {
    return abacus::guard(error, [&] {
        survey->survey.visit([&]<int D>(abacus::Survey<D> &opened) {
            abacus::Arena<abacus::Point<D>> drawn(survey->host);
            for (size_t i = 0; i < count; ++i)
                std::copy_n(sample + i * D, D, drawn.extend(1)->begin());
            opened.merge(points, abacus::given_box<D>(*box), drawn.data(), count);
        });
        return ABACUS_OK;
    });
}

abacus_status abacus_survey_result(abacus_survey *survey, uint64_t *points, abacus_box *box,
                                   const double **sample, size_t *count, abacus_error *error) {
    return abacus::guard(error, [&] {
        survey->survey.visit([&]<int D>(abacus::Survey<D> &opened) {
            const auto &drawn = opened.sample();
            *points = opened.points();
            std::copy_n(opened.box().lower.begin(), D, box->lower);
            std::copy_n(opened.box().upper.begin(), D, box->upper);
            *sample = drawn.empty() ? nullptr : drawn.data()->data();
            *count = drawn.size();
        });
        return ABACUS_OK;
    });
}

abacus_status abacus_survey_plan(abacus_survey *survey, uint32_t shards, abacus_form *form,
                                 uint64_t *borders, abacus_error *error) {
    return abacus::guard(error, [&] {
        survey->survey.visit([&]<int D>(abacus::Survey<D> &opened) {
            std::fill_n(borders, shards - 1, 0);
            if (opened.points() == 0) return;
            abacus_facts facts{};
            facts.form = *form;
            abacus::set_domain<D>(facts, opened.domain());
            opened.borders(abacus::domain_of<D>(facts.form), shards, borders);
            *form = facts.form;
        });
        return ABACUS_OK;
    });
}

void abacus_survey_close(abacus_survey *survey) { abacus::destroy_handle(survey); }

namespace {

template <int D> abacus::Point<D> point_at(const double *coordinates) {
    abacus::Point<D> p;
    std::copy_n(coordinates, D, p.begin());
    return p;
}

template <int D>
void codes_over(const abacus_form &form, const double *points, size_t count, uint64_t *codes) {
    const abacus::Domain<D> domain = abacus::domain_of<D>(form);
    for (size_t i = 0; i < count; ++i) {
        codes[i] = domain.code(point_at<D>(points + i * D));
    }
}

} // namespace

abacus_status abacus_codes(const abacus_form *form, const double *points, size_t count,
                           uint64_t *codes, abacus_error *error) {
    return abacus::guard(error, [&] {
        if (form->dimension == 2)
            codes_over<2>(*form, points, count, codes);
        else
            codes_over<3>(*form, points, count, codes);
        return ABACUS_OK;
    });
}

namespace {

template <int D> int order_by_nearness(const double *place, const double *a, const double *b) {
    const abacus::Point<D> p = point_at<D>(place), pa = point_at<D>(a), pb = point_at<D>(b);
    return abacus::comes_nearer<D>(p, pa, pb) ? -1 : abacus::comes_nearer<D>(p, pb, pa) ? 1 : 0;
}

} // namespace

abacus_status abacus_compare_nearness(uint32_t dimension, const double *place, const double *a,
                                      const double *b, int *order, abacus_error *error) {
    return abacus::guard(error, [&] {
        *order =
            dimension == 2 ? order_by_nearness<2>(place, a, b) : order_by_nearness<3>(place, a, b);
        return ABACUS_OK;
    });
}

abacus_status abacus_exports_open(const abacus_host *host, const abacus_facts *facts,
                                  const uint64_t *borders, size_t count, uint32_t shard,
                                  const abacus_box *extent, abacus_exports **exports,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        *exports = abacus::create_handle<abacus_exports>(
            host, *facts, std::span<const std::uint64_t>(borders, count), shard, *extent);
        return ABACUS_OK;
    });
}

abacus_status abacus_exports_next(abacus_exports *exports, uint32_t *shard, abacus_vertex *vertex,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        return exports->exports.visit(
            [&](auto &opened) { return opened.next(*shard, *vertex) ? ABACUS_OK : ABACUS_END; });
    });
}

void abacus_exports_close(abacus_exports *exports) { abacus::destroy_handle(exports); }
