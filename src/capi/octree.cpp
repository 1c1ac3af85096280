// Changes of octrees behind the C interface.
#include "octree/grow.hpp"
#include "octree/octree_edit.hpp"
#include "octree/octree_load.hpp"
#include "points/record.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "host/stopwatch.hpp"

#include <bit>
#include <cmath>

struct abacus_octree_growth {
    abacus_octree_growth(const abacus_host *table, const abacus_facts &facts, std::size_t memory)
        : host(*table), growth(host, facts, memory) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Growth> growth;
};

struct abacus_octree_edit {
    abacus_octree_edit(const abacus_host *table, const abacus_facts &facts, std::size_t memory,
                       std::size_t cache_bytes)
        : host(*table), edit(host, facts, memory, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::OctreeEdit> edit;
};

struct abacus_octree_load {
    abacus_octree_load(const abacus_host *table, const abacus_facts &facts, std::size_t memory)
        : host(*table), attributes(facts.columns.attributes), load(host, facts, memory) {}

    const abacus::Host host;
    const std::size_t attributes;
    abacus::ByDimension<abacus::OctreeLoad> load;
};

namespace abacus {
namespace {

/// Changes the caller's header only if all goes well.
template <class Change> void change(abacus_header *header, Change change) {
    abacus_header changed = *header;
    {
        const Stopwatch stopwatch(changed.counters.total_ns);
        change(changed);
    }
    *header = changed;
}

/// A level that came as a double.
std::int64_t whole_level(std::uint64_t word) {
    const double level = std::bit_cast<double>(word);
    if (!(std::fabs(level) < 1e9) || level != std::floor(level))
        throw Error(ABACUS_ERROR_ARGUMENT, "level is not a whole number");
    return static_cast<std::int64_t>(level);
}

} // namespace
} // namespace abacus

uint32_t abacus_octree_levels(uint32_t dimension) {
    return static_cast<uint32_t>(dimension == 2 ? abacus::finest_level<2>
                                                : abacus::finest_level<3>);
}

abacus_status abacus_octree_root(const abacus_host *table, abacus_header *header,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host host(*table);
        header->facts.form.dimension == 2 ? abacus::create_root<2>(host, *header)
                                          : abacus::create_root<3>(host, *header);
        return ABACUS_OK;
    });
}

// ---- Growth ----------------------------------------------------------------------

abacus_status abacus_octree_growth_open(const abacus_host *host, const abacus_facts *facts,
                                        size_t memory, abacus_octree_growth **growth,
                                        abacus_error *error) {
    return abacus::guard(error, [&] {
        *growth = abacus::create_handle<abacus_octree_growth>(host, *facts, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_growth_add(abacus_octree_growth *growth, const uint64_t *places,
                                       size_t count, int levels, abacus_error *error) {
    return abacus::dispatch(growth->growth, error, [&]<int D>(abacus::Growth<D> &grown) {
        for (; count > 0; --count, places += 1 + D)
            grown.add(abacus::record_point<D>(places),
                      levels != 0 ? static_cast<std::int64_t>(places[0]) : 0);
    });
}

abacus_status abacus_octree_growth_levels(abacus_octree_growth *growth, abacus_header *header,
                                          abacus_error *error) {
    return abacus::dispatch(growth->growth, error, [&](auto &grown) {
        abacus::change(header, [&](abacus_header &changed) { grown.to_levels(changed); });
    });
}

abacus_status abacus_octree_growth_points(abacus_octree_growth *growth, uint64_t most,
                                          abacus_header *header, abacus_error *error) {
    return abacus::dispatch(growth->growth, error, [&](auto &grown) {
        abacus::change(header, [&](abacus_header &changed) { grown.to_points(most, changed); });
    });
}

abacus_status abacus_octree_growth_sizes(abacus_octree_growth *growth, abacus_octree_sizes sizes,
                                         void *context, uint32_t samples, abacus_header *header,
                                         uint64_t *longer, abacus_error *error) {
    return abacus::dispatch(growth->growth, error, [&](auto &grown) {
        abacus::change(header, [&](abacus_header &changed) {
            *longer = grown.to_sizes(sizes, context, static_cast<int>(samples), changed);
        });
    });
}

abacus_status abacus_octree_growth_balance(abacus_octree_growth *growth, int32_t across,
                                           abacus_header *header, abacus_error *error) {
    return abacus::dispatch(growth->growth, error, [&](auto &grown) {
        abacus::change(header, [&](abacus_header &changed) { grown.to_balance(across, changed); });
    });
}

void abacus_octree_growth_close(abacus_octree_growth *growth) { abacus::destroy_handle(growth); }

// ---- Edits -----------------------------------------------------------------------

abacus_status abacus_octree_edit_open(const abacus_host *host, const abacus_facts *facts,
                                      size_t memory, size_t cache_bytes, abacus_octree_edit **edit,
                                      abacus_error *error) {
    return abacus::guard(error, [&] {
        *edit = abacus::create_handle<abacus_octree_edit>(host, *facts, memory, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_edit_add_merges(abacus_octree_edit *edit, const uint64_t *places,
                                            size_t count, abacus_error *error) {
    return abacus::dispatch(edit->edit, error, [&]<int D>(abacus::OctreeEdit<D> &edited) {
        for (; count > 0; --count, places += 1 + D)
            edited.merge_at(abacus::record_point<D>(places), static_cast<std::int64_t>(places[0]));
    });
}

abacus_status abacus_octree_edit_merge(abacus_octree_edit *edit, abacus_header *header,
                                       abacus_error *error) {
    return abacus::dispatch(edit->edit, error, [&](auto &edited) {
        abacus::change(header, [&](abacus_header &changed) { edited.merge(changed); });
    });
}

abacus_status abacus_octree_edit_add_values(abacus_octree_edit *edit, const uint64_t *rows,
                                            size_t count, abacus_error *error) {
    return abacus::dispatch(edit->edit, error, [&](auto &edited) {
        for (; count > 0; --count, rows += 1 + edited.attributes())
            edited.set_at(rows[0], reinterpret_cast<const double *>(rows + 1));
    });
}

abacus_status abacus_octree_edit_set(abacus_octree_edit *edit, abacus_header *header, uint64_t *set,
                                     abacus_error *error) {
    return abacus::dispatch(edit->edit, error, [&](auto &edited) {
        abacus::change(header, [&](abacus_header &changed) { *set = edited.set(changed); });
    });
}

void abacus_octree_edit_close(abacus_octree_edit *edit) { abacus::destroy_handle(edit); }

// ---- Loading ---------------------------------------------------------------------

abacus_status abacus_octree_load_open(const abacus_host *host, const abacus_facts *facts,
                                      size_t memory, abacus_octree_load **load,
                                      abacus_error *error) {
    return abacus::guard(error, [&] {
        *load = abacus::create_handle<abacus_octree_load>(host, *facts, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_load_add(abacus_octree_load *load, const uint64_t *rows, size_t count,
                                     abacus_error *error) {
    return abacus::dispatch(load->load, error, [&](auto &loaded) {
        for (; count > 0; --count, rows += 2 + load->attributes)
            loaded.add(rows[0], abacus::whole_level(rows[1]),
                       reinterpret_cast<const double *>(rows + 2));
    });
}

abacus_status abacus_octree_load_write(abacus_octree_load *load, abacus_header *header,
                                       abacus_error *error) {
    return abacus::dispatch(load->load, error, [&](auto &loaded) {
        abacus::change(header, [&](abacus_header &changed) { loaded.write(changed); });
    });
}

void abacus_octree_load_close(abacus_octree_load *load) { abacus::destroy_handle(load); }
