// oracle_points: writes a data set of points (id, x, y[, z]) to standard output in the given order:
// in PostgreSQL's binary COPY format, as text for COPY, or as raw records (an int64, then a double
// for each coordinate, in this machine's byte order) for programs that time CGAL or the core alone.
// Ids count the points as they were made, from 1.
#include "copy_format.hpp"
#include "datasets.hpp"
#include "random.hpp"

#include <algorithm>
#include <cinttypes>
#include <numeric>

using namespace abacus::oracle;

namespace {

/// The positions of the points in an order; empty for the original order.
template <int D>
std::vector<std::uint64_t> order_of(const Points<D> &points, const std::string &order,
                                    std::uint64_t seed) {
    if (order == "made") return {};
    std::vector<std::uint64_t> places(points.size());
    std::iota(places.begin(), places.end(), 0);
    const auto less = [&](std::uint64_t a, std::uint64_t b) { return points[a] < points[b]; };
    if (order == "shuffled") {
        Random(seed + 1).shuffle(places);
    } else if (order == "sorted") {
        std::stable_sort(places.begin(), places.end(), less);
    } else if (order == "reversed") {
        std::stable_sort(places.rbegin(), places.rend(), less);
    } else {
        throw std::invalid_argument("no order " + order);
    }
    return places;
}

template <int D>
void write(const Points<D> &points, const std::vector<std::uint64_t> &places,
           const std::string &format) {
    File file("-", "w");
    const auto each = [&](auto put) {
        for (std::uint64_t n = 0; n < points.size(); ++n) put(places.empty() ? n : places[n]);
    };
    if (format == "copy") {
        CopyWriter<D + 1> writer(file);
        each([&](std::uint64_t i) {
            std::array<std::uint64_t, D + 1> row{i + 1};
            for (int axis = 0; axis < D; ++axis)
                row[axis + 1] = std::bit_cast<std::uint64_t>(points[i][axis]);
            writer.put(row);
        });
        writer.finish();
    } else if (format == "raw") {
        each([&](std::uint64_t i) {
            const std::uint64_t id = i + 1;
            file.write(&id, sizeof id);
            file.write(&points[i], sizeof points[i]);
        });
    } else if (format == "text") {
        char text[32];
        const auto put = [&](int size) { file.write(text, std::size_t(size)); };
        each([&](std::uint64_t i) {
            put(std::snprintf(text, sizeof text, "%" PRIu64, i + 1));
            for (const double x : points[i]) put(std::snprintf(text, sizeof text, "\t%.17g", x));
            file.write("\n", 1);
        });
    } else {
        throw std::invalid_argument("no format " + format);
    }
}

template <int D> void run(int argc, char **argv) {
    const std::uint64_t seed = argc > 6 ? std::stoull(argv[6]) : 1;
    const Points<D> points = dataset<D>(argv[2], std::stoull(argv[3]), seed);
    write<D>(points, order_of<D>(points, argc > 5 ? argv[5] : "made", seed),
             argc > 4 ? argv[4] : "copy");
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 4 || argc > 7) {
        std::fprintf(stderr,
                     "usage: oracle_points DIMENSION NAME SIZE [copy|raw|text "
                     "[made|shuffled|sorted|reversed [SEED]]]\n%s",
                     dataset_names().c_str());
        return 2;
    }
    try {
        const std::string dimension = argv[1];
        if (dimension == "2")
            run<2>(argc, argv);
        else if (dimension == "3")
            run<3>(argc, argv);
        else
            throw std::invalid_argument("no points of dimension " + dimension);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "oracle_points: %s\n", error.what());
        return 2;
    }
}
