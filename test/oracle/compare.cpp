// oracle_compare: is a mesh CGAL's Delaunay triangulation, simplex by simplex?
//
//   oracle_compare DIMENSION POINTS SIMPLICES [KEPT]
//
// POINTS     COPY (SELECT id, x, y[, z] ...) in binary format; ids unique
// SIMPLICES  COPY (SELECT code, v0, v1, v2[, v3] FROM abacus_simplices(...))
//            in binary format; - is standard input
// KEPT       file that keeps CGAL's answer from one comparison to the next of
//            the same points; written if it doesn't exist
//
// Simplices are compared by the coordinates of their vertices, orientation
// included. With ABACUS_ORACLE_FIRST_IDS=1 each vertex must also bear the id
// of the first of its equal points in the file. Prints one line of counts and
// the first differences; exits with 0 if there are none, 1 if there are.
#include "cgal_delaunay.hpp"

#include <cinttypes>
#include <cstdlib>
#include <filesystem>

using namespace abacus::oracle;

namespace {

constexpr std::size_t shown_differences = 5;

template <int D> std::vector<Simplex<D>> load(const std::string &path) {
    std::vector<Simplex<D>> simplices(std::filesystem::file_size(path) / sizeof(Simplex<D>));
    File(path, "r").read(simplices.data(), simplices.size() * sizeof(Simplex<D>));
    return simplices;
}

template <int D> void save(const std::string &path, const std::vector<Simplex<D>> &simplices) {
    File(path, "w").write(simplices.data(), simplices.size() * sizeof(Simplex<D>));
}

template <int D> std::vector<Simplex<D>> expected(const PointTable<D> &table, const char *kept) {
    if (kept != nullptr && std::filesystem::exists(kept)) return load<D>(kept);
    std::vector<Simplex<D>> simplices = delaunay<D>(table.points());
    if (kept != nullptr) save<D>(kept, simplices);
    return simplices;
}

/// The exported mesh; faults of single simplices are reported and counted at once.
template <int D> struct Exported {
    std::vector<Simplex<D>> simplices; // sorted
    std::size_t faults = 0;

    Exported(const std::string &path, const PointTable<D> &table, bool first_ids) {
        File file(path, "r");
        CopyReader<D + 2> reader(file);
        std::array<std::uint64_t, D + 2> row;
        while (reader.next(row)) {
            Simplex<D> simplex;
            bool known = true;
            for (int i = 0; i <= D; ++i) {
                const auto id = std::int64_t(row[i + 1]);
                simplex[i] = table.number_of(id);
                if (simplex[i] == PointTable<D>::unknown) {
                    fault("id %" PRId64 " is no input point", id);
                    known = false;
                } else if (first_ids && table.first_id(simplex[i]) != id) {
                    fault("id %" PRId64 " is not the first of its point", id);
                }
            }
            if (!known) continue;
            if (!is_positive<D>(table.points(), simplex))
                fault("simplex of code %" PRId64 " is not positively oriented",
                      std::int64_t(row[0]));
            simplices.push_back(canonical<D>(simplex));
        }
        std::sort(simplices.begin(), simplices.end());
    }

private:
    void fault(const char *format, std::int64_t number) {
        if (++faults > shown_differences) return;
        std::printf("  ");
        std::printf(format, number);
        std::printf("\n");
    }
};

template <int D>
std::size_t report(const char *what, const PointTable<D> &table,
                   const std::vector<Simplex<D>> &simplices) {
    for (std::size_t i = 0; i < std::min(simplices.size(), shown_differences); ++i) {
        std::printf("  %s:", what);
        for (const std::uint32_t number : simplices[i]) {
            std::printf(" %" PRId64 "(", table.first_id(number));
            for (int axis = 0; axis < D; ++axis)
                std::printf(axis ? ", %.17g" : "%.17g", table.points()[number][axis]);
            std::printf(")");
        }
        std::printf("\n");
    }
    return simplices.size();
}

template <int D> int compare(char **argv, const char *kept) {
    const PointTable<D> table(argv[2]);
    const std::vector<Simplex<D>> wanted = expected<D>(table, kept);
    const char *first_ids = std::getenv("ABACUS_ORACLE_FIRST_IDS");
    const Exported<D> mesh(argv[3], table, first_ids != nullptr && *first_ids == '1');

    std::vector<Simplex<D>> missing, extra;
    std::set_difference(wanted.begin(), wanted.end(), mesh.simplices.begin(), mesh.simplices.end(),
                        std::back_inserter(missing));
    std::set_difference(mesh.simplices.begin(), mesh.simplices.end(), wanted.begin(), wanted.end(),
                        std::back_inserter(extra));
    const std::size_t differences =
        report<D>("missing", table, missing) + report<D>("extra", table, extra) + mesh.faults;
    std::printf("%s: %zu points, %zu distinct; %zu simplices, CGAL %zu; %zu missing, %zu extra, "
                "%zu other faults\n",
                differences == 0 ? "equal" : "DIFFERENT", table.count(), table.points().size(),
                mesh.simplices.size(), wanted.size(), missing.size(), extra.size(), mesh.faults);
    return differences == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 4 || argc > 5) {
        std::fprintf(stderr, "usage: oracle_compare DIMENSION POINTS SIMPLICES [KEPT]\n");
        return 2;
    }
    try {
        const std::string dimension = argv[1];
        const char *kept = argc > 4 ? argv[4] : nullptr;
        if (dimension == "2") return compare<2>(argv, kept);
        if (dimension == "3") return compare<3>(argv, kept);
        throw std::invalid_argument("no oracle for dimension " + dimension);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "oracle_compare: %s\n", error.what());
        return 2;
    }
}
