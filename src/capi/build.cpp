// Building behind the C interface.
#include "capi/build.hpp"

#include "capi/handle.hpp"
#include "capi/stage.hpp"
#include "query/pages/describe.hpp"

#include <abacus/build.h>
#include <cstring>

abacus_status abacus_build_open(const abacus_host *host, const abacus_facts *facts,
                                size_t cache_bytes, abacus_build **build, abacus_error *error) {
    return abacus::guard(error, [&] {
        *build = abacus::create_handle<abacus_build>(host, *facts, cache_bytes);
        return ABACUS_OK;
    });
}

namespace {

template <int D> abacus::Stage<D> &stage_for(const abacus::Build<D> &, abacus_stage *stage) {
    return stage->stage.get<D>();
}

} // namespace

abacus_status abacus_build_run(abacus_build *build, uint64_t limit, abacus_header *header,
                               abacus_error *error) {
    return abacus::run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
        opened.run(limit, changed);
    });
}

abacus_status abacus_build_hold(abacus_build *build, abacus_error *error) {
    return abacus::guard(error, [&] {
        build->build.visit([](auto &opened) { opened.hold(); });
        return ABACUS_OK;
    });
}

abacus_status abacus_build_settle(abacus_build *build, abacus_header *header, abacus_error *error) {
    return abacus::run_change_of_values(
        build, header, error,
        [&](auto &opened, abacus_header &changed) { opened.settle(changed); });
}

uint64_t abacus_build_lost_labels(const abacus_build *build) {
    return build->build.visit([](const auto &opened) { return opened.lost_labels(); });
}

abacus_status abacus_build_insert(abacus_build *build, abacus_stage *stage,
                                  abacus_on_duplicate on_duplicate, abacus_header *header,
                                  abacus_error *error) {
    return abacus::run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
        opened.insert(stage_for(opened, stage), on_duplicate, changed);
    });
}

abacus_status abacus_build_delete(abacus_build *build, abacus_stage *stage, int exactly,
                                  abacus_header *header, uint64_t *deleted, abacus_error *error) {
    return abacus::run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
        *deleted = opened.remove(stage_for(opened, stage), exactly != 0, changed);
    });
}

abacus_status abacus_build_update(abacus_build *build, abacus_stage *stage,
                                  const uint32_t *attributes, size_t count, int exactly,
                                  abacus_header *header, uint64_t *updated,
                                  abacus_named_place *missing, abacus_error *error) {
    const auto run = [&](auto &opened, abacus_header &changed) {
        *updated = opened.update(stage_for(opened, stage), {attributes, count}, exactly != 0,
                                 changed, *missing);
    };
    return exactly != 0 ? abacus::run_change(build, header, error, run)
                        : abacus::run_change_of_values(build, header, error, run);
}

abacus_status abacus_build_change_attributes(abacus_build *build, const uint32_t *source,
                                             size_t count, size_t memory, abacus_header *header,
                                             abacus_error *error) {
    return abacus::run_change_of_values(
        build, header, error, [&](auto &opened, abacus_header &changed) {
            for (std::size_t i = 0; i < count; ++i)
                if (source[i] == abacus::no_attribute) {
                    std::memset(changed.names[i], 0, ABACUS_NAME_BYTES);
                    changed.types[i] = ABACUS_FLOAT8;
                } else {
                    std::memcpy(changed.names[i], header->names[source[i]], ABACUS_NAME_BYTES);
                    changed.types[i] = header->types[source[i]];
                }
            const abacus_columns &before = header->facts.columns;
            std::memcpy(changed.names[count], header->names[before.attributes],
                        before.labels * std::size_t{ABACUS_NAME_BYTES});
            std::memcpy(changed.types + count, header->types + before.attributes, before.labels);
            opened.change_attributes({source, count}, memory, changed);
        });
}

abacus_status abacus_build_clear(abacus_build *build, abacus_header *header, uint64_t *deleted,
                                 abacus_error *error) {
    return abacus::run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
        *deleted = opened.clear(changed);
    });
}

abacus_status abacus_build_rekey(abacus_build *build, size_t memory, abacus_header *header,
                                 int *done, abacus_error *error) {
    return abacus::run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
        *done = opened.rekey(memory, changed);
    });
}

abacus_status abacus_build_log(abacus_build *build, size_t memory, abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host &lone = build->lone_host.emplace(build->alone);
        build->build.visit([&]<int D>(abacus::Build<D> &opened) {
            abacus_facts shape{};
            shape.form.dimension = D;
            auto &changes = build->changes.emplace(lone, shape, memory, build->host.threads(),
                                                   build->host.has_tiny_intervals());
            opened.log_to(changes.template get<D>());
        });
        return ABACUS_OK;
    });
}

namespace {

/// Describes a simplex as other functions return it.
template <int D> abacus_simplex describe(const abacus::SimplexWords<D> &words) {
    std::array<abacus::Point<D>, D + 1> points;
    abacus::Corners<D> ascending;
    std::array<int, D + 1> order;
    for (int i = 0; i <= D; ++i) {
        points[i] = words.point(i);
        ascending[i] = &points[i];
        order[i] = i;
    }
    if (abacus::orientation<D>(ascending) < 0) std::swap(order[0], order[1]);
    abacus::DescribedCorners<D> corners;
    for (int i = 0; i <= D; ++i) {
        corners.id[i] = words.vertex(order[i]);
        corners.point[i] = &points[order[i]];
    }
    abacus_simplex simplex{};
    abacus::describe<D>(corners, words.code, false, simplex);
    return simplex;
}

} // namespace

abacus_status abacus_build_report(abacus_build *build, abacus_change_report report, void *context,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        if (!build->changes) return ABACUS_OK;
        build->changes->visit([&]<int D>(abacus::SimplexChanges<D> &changes) {
            changes.each([&](const abacus::SimplexWords<D> &words) {
                const abacus_simplex simplex = describe(words);
                abacus::host::require(report(context, words.change > 0, &simplex));
            });
        });
        return ABACUS_OK;
    });
}

void abacus_build_close(abacus_build *build) { abacus::destroy_handle(build); }
