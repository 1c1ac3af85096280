// core_in_memory: the core alone, over a store in memory, with a number of threads: what it takes
// to triangulate points of the plane that have a value, and to interpolate it linearly at places.
//
//   core_in_memory FILE THREADS PLACES
//
// FILE holds raw points (see oracle_points). The places are the first PLACES of them with x and y
// exchanged: as evenly spread as the points, and not among them. The part `gpu` of scripts/bench.sh
// runs it beside bench/suite/cupy_peer.py, which takes the same points, values and places. Points
// are read into memory before. Cache and memory for sorting are those of a server with default
// settings. Prints a line of JSON: seconds of elapsed and processor time of both; simplices; points
// that are not in the mesh; places with a value, and the mean of these.
#include "support/memory_host.hpp"

#include <abacus/build.h>
#include <abacus/values.h>

#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace abacus;

constexpr std::size_t cache_bytes = std::size_t{128} << 20;
constexpr std::size_t sort_bytes = std::size_t{64} << 20;

void require(abacus_status status, const abacus_error &error) {
    if (status != ABACUS_OK) throw std::runtime_error(error.message);
}

double value_at(double x, double y) { return std::sin(8 * x) * std::cos(6 * y) + x; }

/// Words of points as abacus_stage_add() takes them, and of places as abacus_places_add().
struct Input {
    std::vector<std::uint64_t> points, places;
    std::size_t count = 0;

    Input(const char *path, std::size_t place_count) {
        struct Record {
            std::int64_t id;
            double x, y;
        };
        std::FILE *file = std::fopen(path, "rb");
        if (file == nullptr) throw std::runtime_error(std::string("cannot open ") + path);
        std::vector<Record> records(1 << 14);
        while (const std::size_t n =
                   std::fread(records.data(), sizeof(Record), records.size(), file))
            for (std::size_t i = 0; i < n; ++i) {
                const auto &[id, x, y] = records[i];
                put(points, id, {x, y, value_at(x, y)});
                if (count++ < place_count) put(places, id, {y, x});
            }
        std::fclose(file);
    }

private:
    static void put(std::vector<std::uint64_t> &words, std::int64_t id,
                    std::initializer_list<double> numbers) {
        words.push_back(static_cast<std::uint64_t>(id));
        for (const double x : numbers) words.push_back(std::bit_cast<std::uint64_t>(x));
    }
};

struct Took {
    double wall, cpu;
};

double now(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

template <class Work> Took timed(Work work) {
    const double wall = now(CLOCK_MONOTONIC), cpu = now(CLOCK_PROCESS_CPUTIME_ID);
    work();
    return {now(CLOCK_MONOTONIC) - wall, now(CLOCK_PROCESS_CPUTIME_ID) - cpu};
}

void triangulate(const MemoryHost &host, abacus_header &header, const Input &input) {
    abacus_stage *stage = nullptr;
    abacus_build *build = nullptr;
    abacus_error error{};
    require(abacus_stage_open(host.table(), &header.facts, sort_bytes, &stage, &error), error);
    require(abacus_stage_add(stage, input.points.data(), input.count, &error), error);
    require(abacus_stage_end(stage, &header.facts, &error), error);
    require(abacus_build_open(host.table(), &header.facts, cache_bytes, &build, &error), error);
    require(abacus_build_insert(build, stage, ABACUS_KEEP, &header, &error), error);
    abacus_build_close(build);
    abacus_stage_close(stage);
}

struct Values {
    std::uint64_t count = 0;
    double sum = 0;
};

Values interpolate(const MemoryHost &host, const abacus_header &header, const Input &input) {
    abacus_interpolation linear{};
    linear.extent = {};
    linear.attributes = 1;
    Values found;
    const auto take = [](void *context, std::int64_t, const double *values) {
        if (values != nullptr) {
            auto &sums = *static_cast<Values *>(context);
            ++sums.count;
            sums.sum += values[0];
        }
        return ABACUS_HOST_OK;
    };
    abacus_places *places = nullptr;
    abacus_error error{};
    require(
        abacus_places_open(host.table(), &header.facts, sort_bytes, cache_bytes, &places, &error),
        error);
    require(abacus_places_add(places, input.places.data(), input.places.size() / 3, &error), error);
    require(abacus_places_interpolate(places, &linear, take, &found, &error), error);
    abacus_places_close(places);
    return found;
}

void run(const char *path, unsigned threads, std::size_t place_count) {
    const Input input(path, place_count);
    MemoryHost host;
    host.strict = false;
    host.set_threads(threads, false);
    abacus_header header{};
    header.facts.form.dimension = 2;
    header.facts.columns.attributes = 1;
    Values found;
    const Took built = timed([&] { triangulate(host, header, input); });
    const Took asked = timed([&] { found = interpolate(host, header, input); });
    const abacus_census &census = header.facts.census;
    std::printf("{\"wall\": %.6f, \"cpu\": %.6f, \"interpolate\": %.6f, \"interpolate_cpu\": %.6f, "
                "\"simplices\": %" PRIu64 ", \"missing\": %" PRIu64 ", \"answers\": %" PRIu64
                ", \"mean\": %.12g}\n",
                built.wall, built.cpu, asked.wall, asked.cpu, census.simplices,
                input.count - census.vertices - census.duplicates, found.count,
                found.sum / double(found.count));
}

} // namespace

int main(int argc, char **argv) {
    const int threads = argc == 4 ? std::atoi(argv[2]) : 0;
    const long places = argc == 4 ? std::atol(argv[3]) : 0;
    if (threads < 1 || places < 1) {
        std::fprintf(stderr, "usage: %s FILE_OF_RAW_POINTS THREADS PLACES\n", argv[0]);
        return 2;
    }
    try {
        run(argv[1], static_cast<unsigned>(threads), static_cast<std::size_t>(places));
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
    return 0;
}
