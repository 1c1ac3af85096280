// Shards behind the C interface.
#include "geometry/distance.hpp"
#include "keys/domain_of.hpp"
#include "shards/exports.hpp"
#include "shards/given_box.hpp"
#include "shards/own_attributes.hpp"
#include "shards/own_pages.hpp"
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

abacus_status abacus_exports_count(abacus_exports *exports, uint64_t *owned, abacus_error *error) {
    return abacus::guard(error, [&] {
        exports->exports.visit([&](auto &opened) { *owned = opened.count_owned(); });
        return ABACUS_OK;
    });
}

abacus_status abacus_exports_around(abacus_exports *exports, const double *place,
                                    abacus_export_report report, void *context,
                                    abacus_error *error) {
    return abacus::guard(error, [&] {
        exports->exports.visit([&]<int D>(abacus::Exports<D> &opened) {
            opened.around(point_at<D>(place), [&](std::uint32_t to, const abacus_vertex &vertex) {
                abacus::host::require(report(context, to, &vertex));
            });
        });
        return ABACUS_OK;
    });
}

void abacus_exports_close(abacus_exports *exports) { abacus::destroy_handle(exports); }

namespace {

/// Both kinds; pages of one are asked for.
template <int D> struct OwnOf {
    OwnOf(const abacus::Host &host, const abacus_facts &facts, std::uint64_t first,
          std::uint64_t last)
        : simplices(host, facts, first, last), attributes(host, facts, first, last) {}

    abacus::OwnPages<D> simplices;
    abacus::OwnAttributes<D> attributes;
};

} // namespace

struct abacus_own_pages {
    abacus_own_pages(const abacus_host *table, const abacus_facts &facts, abacus_page_kind asked,
                     std::uint64_t first, std::uint64_t last, const abacus_key &from)
        : host(*table), kind(asked), own(host, facts, first, last) {
        if (kind != ABACUS_SIMPLEX_PAGES && kind != ABACUS_ATTRIBUTE_PAGES)
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "a shard has no own pages of this kind");
        own.visit([&](auto &opened) {
            if (kind == ABACUS_SIMPLEX_PAGES)
                opened.simplices.seek(from);
            else
                opened.attributes.seek(from);
        });
    }

    const abacus::Host host;
    const abacus_page_kind kind;
    abacus::ByDimension<OwnOf> own;
};

abacus_status abacus_own_pages_open(const abacus_host *host, const abacus_facts *facts,
                                    abacus_page_kind kind, uint64_t first, uint64_t last,
                                    const abacus_key *from, abacus_own_pages **pages,
                                    abacus_error *error) {
    return abacus::guard(error, [&] {
        *pages = abacus::create_handle<abacus_own_pages>(host, *facts, kind, first, last, *from);
        return ABACUS_OK;
    });
}

abacus_status abacus_own_pages_next(abacus_own_pages *pages, abacus_page *page,
                                    abacus_error *error) {
    return abacus::guard(error, [&] {
        return pages->own.visit([&](auto &opened) {
            const bool any = pages->kind == ABACUS_SIMPLEX_PAGES ? opened.simplices.next(*page)
                                                                 : opened.attributes.next(*page);
            return any ? ABACUS_OK : ABACUS_END;
        });
    });
}

abacus_key abacus_own_pages_end(const abacus_own_pages *pages) {
    return pages->own.visit([&](const auto &opened) {
        return pages->kind == ABACUS_SIMPLEX_PAGES ? opened.simplices.end()
                                                   : opened.attributes.end();
    });
}

void abacus_own_pages_close(abacus_own_pages *pages) { abacus::destroy_handle(pages); }

uint64_t abacus_key_code(abacus_page_kind kind, const abacus_key *key) {
    return kind == ABACUS_ATTRIBUTE_PAGES ? abacus::code_of(*key) : key->code;
}

abacus_status abacus_own_count(const abacus_host *host, const abacus_facts *facts, uint64_t first,
                               uint64_t last, uint64_t *simplices, uint64_t *ghosts,
                               abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host own(*host);
        abacus::ByDimension<abacus::OwnPages> pages(own, *facts, first, last);
        pages.visit([&](auto &opened) { opened.count(*simplices, *ghosts); });
        return ABACUS_OK;
    });
}
