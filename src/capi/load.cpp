// Loading behind the C interface.
#include "load/load.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/in_plane.hpp"
#include "capi/segments.hpp"
#include "capi/stage.hpp"

#include <abacus/build.h>
#include <abacus/load.h>

#include <array>
#include <cstring>

struct abacus_load {
    abacus_load(const abacus_host *table, const abacus_facts &facts, std::size_t memory,
                bool reorient, bool split_nodes)
        : host(*table), load(host, facts, memory, reorient, split_nodes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Load> load;
    std::string detail;
};

abacus_status abacus_load_open(const abacus_host *host, const abacus_facts *facts, size_t memory,
                               int reorient, int split_nodes, abacus_load **load,
                               abacus_error *error) {
    return abacus::guard(error, [&] {
        *load = abacus::create_handle<abacus_load>(host, *facts, memory, reorient != 0,
                                                   split_nodes != 0);
        return ABACUS_OK;
    });
}

abacus_status abacus_load_vertices(abacus_load *load, const uint64_t *points, size_t count,
                                   abacus_error *error) {
    return abacus::dispatch(load->load, error,
                            [&](auto &loading) { loading.add_vertices(points, count); });
}

abacus_status abacus_load_simplices(abacus_load *load, const uint64_t *simplices, size_t count,
                                    abacus_error *error) {
    return abacus::dispatch(load->load, error,
                            [&](auto &loading) { loading.add_simplices(simplices, count); });
}

abacus_status abacus_load_facets(abacus_load *load, const uint64_t *facets, size_t count,
                                 abacus_error *error) {
    return abacus::dispatch(load->load, error,
                            [&](auto &loading) { loading.add_facets(facets, count); });
}

abacus_status abacus_load_lines(abacus_load *load, const uint64_t *edges, size_t count,
                                abacus_error *error) {
    return abacus::in_plane(load->load, "lines", error, [&](abacus::Load<2> &loading) {
        loading.add_lines(edges, count);
        return ABACUS_OK;
    });
}

abacus_status abacus_load_edges(abacus_load *load, abacus_loaded_edge *edges, size_t room,
                                size_t *count, abacus_error *error) {
    return abacus::in_plane(load->load, "lines", error, [&](abacus::Load<2> &loading) {
        *count = 0;
        loading.next_edges(room, [&](const std::uint64_t *edge) {
            std::memcpy(&edges[(*count)++], edge, sizeof *edges);
        });
        return ABACUS_OK;
    });
}

abacus_status abacus_load_ties(abacus_load *load, abacus_segments *segments, uint64_t *count,
                               abacus_error *error) {
    return abacus::in_plane(load->load, "lines", error, [&](abacus::Load<2> &loading) {
        *count = loading.take_ties([&](const std::uint64_t *tie) {
            std::array<double, 4> ends;
            std::memcpy(ends.data(), tie, sizeof ends);
            segments->segments.add(ends.data(), abacus::Fixed::no);
        });
        return ABACUS_OK;
    });
}

abacus_status abacus_load_check(abacus_load *load, abacus_delaunay *outcome, abacus_error *error) {
    return abacus::dispatch(load->load, error, [&](auto &loading) {
        try {
            *outcome = loading.check();
        } catch (const abacus::Error &fault) {
            load->detail = fault.detail;
            throw;
        }
    });
}

const char *abacus_load_detail(const abacus_load *load) { return load->detail.c_str(); }

abacus_status abacus_load_write(abacus_load *load, int keeps_vertices, abacus_header *header,
                                abacus_error *error) {
    return abacus::dispatch(load->load, error, [&](auto &loading) {
        abacus_header changed = *header; // the caller's stays as it is if this fails
        loading.write(keeps_vertices != 0, changed);
        *header = changed;
    });
}

abacus_status abacus_load_stage(abacus_load *load, abacus_stage *stage, abacus_error *error) {
    return abacus::dispatch(load->load, error, [&]<int D>(abacus::Load<D> &loading) {
        abacus::Stage<D> &points = stage->stage.get<D>();
        loading.give_vertices([&](const std::uint64_t *vertex) { points.add(vertex, 1); });
    });
}

void abacus_load_close(abacus_load *load) { abacus::destroy_handle(load); }
