// oracle_points: writes a data set of points (id, x, y) to standard output, in
// the order asked for, as PostgreSQL's binary COPY format, as text for COPY, or
// as raw records (int64, double, double in this machine's byte order) for
// programs that time CGAL alone. Ids are places in the made order, from 1.
#include "copy_format.hpp"
#include "datasets.hpp"

#include <algorithm>
#include <cinttypes>
#include <numeric>
#include <random>

using namespace abacus::oracle;

namespace {

std::vector<std::uint64_t> order_of(const std::vector<Point2> &points, const std::string &order,
                                    std::uint64_t seed) {
    std::vector<std::uint64_t> places(points.size());
    std::iota(places.begin(), places.end(), 0);
    const auto less = [&](std::uint64_t a, std::uint64_t b) {
        return std::pair(points[a].x, points[a].y) < std::pair(points[b].x, points[b].y);
    };
    if (order == "shuffled") {
        std::mt19937_64 engine(seed + 1);
        for (std::size_t i = places.size(); i > 1; --i)
            std::swap(places[i - 1], places[engine() % i]);
    } else if (order == "sorted") {
        std::stable_sort(places.begin(), places.end(), less);
    } else if (order == "reversed") {
        std::stable_sort(places.rbegin(), places.rend(), less);
    } else if (order != "made") {
        throw std::invalid_argument("no order " + order);
    }
    return places;
}

void write(const std::vector<Point2> &points, const std::vector<std::uint64_t> &places,
           const std::string &format) {
    File file("-", "w");
    if (format == "copy") {
        CopyWriter<3> writer(file);
        for (const std::uint64_t i : places)
            writer.put({i + 1, std::bit_cast<std::uint64_t>(points[i].x),
                        std::bit_cast<std::uint64_t>(points[i].y)});
        writer.finish();
    } else if (format == "raw") {
        for (const std::uint64_t i : places) {
            const std::uint64_t id = i + 1;
            file.write(&id, sizeof id);
            file.write(&points[i], sizeof points[i]);
        }
    } else if (format == "text") {
        char line[128];
        for (const std::uint64_t i : places)
            file.write(line,
                       std::size_t(std::snprintf(line, sizeof line, "%" PRIu64 "\t%.17g\t%.17g\n",
                                                 i + 1, points[i].x, points[i].y)));
    } else {
        throw std::invalid_argument("no format " + format);
    }
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 3 || argc > 6) {
        std::fprintf(stderr,
                     "usage: oracle_points NAME SIZE [copy|raw|text [made|shuffled|sorted|reversed "
                     "[SEED]]]\n%s",
                     dataset_names().c_str());
        return 2;
    }
    try {
        const std::uint64_t seed = argc > 5 ? std::stoull(argv[5]) : 1;
        const std::vector<Point2> points = dataset(argv[1], std::stoull(argv[2]), seed);
        write(points, order_of(points, argc > 4 ? argv[4] : "made", seed),
              argc > 3 ? argv[3] : "copy");
    } catch (const std::exception &error) {
        std::fprintf(stderr, "oracle_points: %s\n", error.what());
        return 2;
    }
}
