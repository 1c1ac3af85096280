// What the programs that time other engines share: the same points, read in the same way,
// and one line of JSON about the run.
//
//   bench_<engine> DIMENSION FILE
//
// FILE holds raw records (an int64 id, then a double for each coordinate; see oracle_points). The
// measured time is that of reading them and of building the triangulation, until the engine could
// answer questions. Freeing memory is not timed. The memory is the largest resident set of the
// process, including the points.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace comparator {

/// Calls visit(coordinates) for the points of a file, in its order.
template <int D, class Visit> void for_each_point(const char *path, Visit visit) {
    struct Record {
        std::int64_t id;
        double x[D];
    };
    std::FILE *file = std::fopen(path, "rb");
    if (file == nullptr) throw std::runtime_error(std::string("cannot open ") + path);
    std::vector<Record> records(1 << 14);
    while (const std::size_t count =
               std::fread(records.data(), sizeof(Record), records.size(), file))
        for (std::size_t i = 0; i < count; ++i) visit(records[i].x);
    std::fclose(file);
}

/// The coordinates of all points, one point after the other.
template <int D> std::vector<double> read_coordinates(const char *path) {
    std::vector<double> coordinates;
    for_each_point<D>(path,
                      [&](const double *x) { coordinates.insert(coordinates.end(), x, x + D); });
    return coordinates;
}

/// Wall and CPU seconds of successive phases from the start of the program.
class Stopwatch {
public:
    Stopwatch() : wall_(now(CLOCK_MONOTONIC)), cpu_(now(CLOCK_PROCESS_CPUTIME_ID)), last_(wall_) {}

    void phase(const char *name) {
        const double wall = now(CLOCK_MONOTONIC);
        char text[64];
        std::snprintf(text, sizeof text, ", \"%s\": %.6f", name, wall - last_);
        phases_ += text;
        last_ = wall;
    }

    void print(std::size_t simplices) const {
        std::printf("{\"wall\": %.6f, \"cpu\": %.6f, \"memory\": %llu, \"simplices\": %zu%s}\n",
                    last_ - wall_, now(CLOCK_PROCESS_CPUTIME_ID) - cpu_, largest_memory(),
                    simplices, phases_.c_str());
    }

private:
    static double now(clockid_t clock) {
        timespec time{};
        clock_gettime(clock, &time);
        return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
    }

    static unsigned long long largest_memory() {
        unsigned long long kilobytes = 0;
        std::FILE *status = std::fopen("/proc/self/status", "r");
        if (status == nullptr) return 0;
        char line[256];
        while (std::fgets(line, sizeof line, status) != nullptr)
            if (std::sscanf(line, "VmHWM: %llu", &kilobytes) == 1) break;
        std::fclose(status);
        return kilobytes << 10;
    }

    double wall_, cpu_, last_;
    std::string phases_;
};

/// main() of a comparator: calls run<2>(path) or run<3>(path).
template <class Run> int main(int argc, char **argv, Run run) {
    try {
        if (argc == 3 && std::strcmp(argv[1], "2") == 0) {
            run.template operator()<2>(argv[2]);
            return 0;
        }
        if (argc == 3 && std::strcmp(argv[1], "3") == 0) {
            run.template operator()<3>(argv[2]);
            return 0;
        }
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
    std::fprintf(stderr, "usage: %s 2|3 FILE_OF_RAW_POINTS\n", argv[0]);
    return 2;
}

} // namespace comparator
