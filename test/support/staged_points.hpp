// Points of many kinds, staged through the C interface into an in-memory host
// and read back from its vertex pages.
#pragma once

#include "points/vertex_page.hpp"
#include "support/apart.hpp"
#include "support/memory_host.hpp"

#include <abacus/build.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace abacus {

inline constexpr std::size_t ample = std::size_t{1} << 30;
inline constexpr std::size_t tiny = 1;

template <int D> struct Staged {
    std::int64_t id;
    Point<D> point;
    std::vector<std::uint64_t> attributes; // bits, so that NaN equals itself

    bool operator==(const Staged &) const = default;
};

template <int D> using Input = std::vector<Staged<D>>;

template <int D> Input<D> with_ids(const std::vector<Point<D>> &points) {
    Input<D> input;
    for (const auto &p : points) input.push_back({static_cast<std::int64_t>(input.size()), p, {}});
    return input;
}

template <int D> std::vector<std::uint64_t> words(const Input<D> &input) {
    std::vector<std::uint64_t> result;
    for (const auto &staged : input) {
        result.push_back(static_cast<std::uint64_t>(staged.id));
        for (const double x : staged.point) result.push_back(std::bit_cast<std::uint64_t>(x));
        result.insert(result.end(), staged.attributes.begin(), staged.attributes.end());
    }
    return result;
}

template <int D> abacus_header empty_header(unsigned attributes = 0) {
    abacus_header header{};
    header.facts.form.dimension = D;
    header.facts.columns.attributes = attributes;
    test::choose_where_attributes_are(header);
    return header;
}

/// Stages in batches; closes the stage whatever happens.
template <int D>
abacus_status stage(MemoryHost &host, abacus_header &header, const Input<D> &input,
                    std::size_t memory, abacus_error &error, std::size_t batch = 1000) {
    const std::vector<std::uint64_t> records = words(input);
    const std::size_t stride = record_words(D, header.facts.columns.attributes);
    abacus_stage *handle = nullptr;
    abacus_status status = abacus_stage_open(host.table(), &header.facts, memory, &handle, &error);
    for (std::size_t at = 0; status == ABACUS_OK && at < input.size(); at += batch)
        status = abacus_stage_add(handle, records.data() + at * stride,
                                  std::min(batch, input.size() - at), &error);
    if (status == ABACUS_OK) status = abacus_stage_finish(handle, &header.facts, &error);
    abacus_stage_close(handle);
    return status;
}

/// The staged points in order, from the pages; checks the invariants of every page.
template <int D> Input<D> staged(MemoryHost &host, const abacus_header &header) {
    Input<D> result;
    for (auto &[key, page] : host.staged_pages) {
        EXPECT_EQ(key.code, result.size());
        EXPECT_LE(page.size, std::size_t{ABACUS_MAX_PAGE_BYTES});
        const VertexPage<D> view(page.words.data(), page.size, header.facts.columns.attributes,
                                 key);
        for (std::size_t i = 0; i < view.size(); ++i) {
            const std::uint64_t *record = view.record(i);
            result.push_back(
                {record_id(record),
                 record_point<D>(record),
                 {record + 1 + D, record + record_words(D, header.facts.columns.attributes)}});
        }
    }
    EXPECT_EQ(header.facts.census.staged, result.size());
    return result;
}

/// Stages the input into an empty mesh of this host and returns the order.
template <int D>
Input<D> order_by(MemoryHost &host, const Input<D> &input, std::size_t memory,
                  std::size_t batch = 1000) {
    abacus_header header =
        empty_header<D>(input.empty() ? 0 : static_cast<unsigned>(input[0].attributes.size()));
    abacus_error error{};
    EXPECT_EQ(stage<D>(host, header, input, memory, error, batch), ABACUS_OK) << error.message;
    EXPECT_EQ(host.bytes, 0u);
    EXPECT_TRUE(host.spools.empty());
    EXPECT_TRUE(host.violations.empty()) << host.violations[0];
    return staged<D>(host, header);
}
/// The same with a host of its own.
template <int D>
Input<D> order_of(const Input<D> &input, std::size_t memory = ample, std::size_t batch = 1000) {
    MemoryHost host;
    return order_by<D>(host, input, memory, batch);
}

/// Each point once.
template <int D> void expect_permutation(Input<D> input, Input<D> order) {
    const auto by_id = [](const auto &a, const auto &b) { return a.id < b.id; };
    std::sort(input.begin(), input.end(), by_id);
    std::sort(order.begin(), order.end(), by_id);
    EXPECT_TRUE(input == order);
}

enum class Kind { uniform, grid, clusters, extremes, denormals, equal, heavy, outliers };

template <int D> std::vector<Point<D>> points(Kind kind, std::size_t n) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Point<D>> result(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double centre = static_cast<double>(random() % 10);
        for (double &x : result[i]) {
            switch (kind) {
            case Kind::uniform:
                x = unit(random);
                break;
            case Kind::grid:
                x = static_cast<double>(random() % 40);
                break;
            case Kind::clusters:
                x = centre + 1e-12 * unit(random);
                break;
            case Kind::extremes:
                x = std::ldexp(unit(random) - 0.5, static_cast<int>(random() % 1990) - 995);
                break;
            case Kind::denormals:
                x = static_cast<double>(random() % 5) * std::numeric_limits<double>::denorm_min();
                break;
            case Kind::equal:
                x = 0.1;
                break;
            case Kind::heavy:
                x = i % 10 != 0 ? 0.5 : unit(random);
                break;
            case Kind::outliers:
                x = i < 3 ? std::ldexp(1.0, -300 * static_cast<int>(i)) : 0;
                break;
            }
        }
    }
    return result;
}

inline constexpr Kind all_kinds[] = {Kind::uniform,   Kind::grid,  Kind::clusters, Kind::extremes,
                                     Kind::denormals, Kind::equal, Kind::heavy,    Kind::outliers};

} // namespace abacus
