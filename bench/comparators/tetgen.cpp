// bench_tetgen: what TetGen takes for the tetrahedra of points only. The library is Debian's.
#include "comparator.hpp"

#define TETLIBRARY
#include <tetgen.h>

namespace {

template <int D> void run(const char *path) {
    if constexpr (D == 3) {
        comparator::Stopwatch watch;
        std::vector<double> coordinates = comparator::read_coordinates<3>(path);
        watch.phase("read");
        tetgenio in, out;
        in.numberofpoints = static_cast<int>(coordinates.size() / 3);
        in.pointlist = coordinates.data();
        char options[] = "Q";
        tetrahedralize(options, &in, &out);
        in.pointlist = nullptr; // it would delete what the vector owns
        watch.phase("build");
        watch.print(static_cast<std::size_t>(out.numberoftetrahedra));
    } else {
        throw std::runtime_error("TetGen is for dimension 3");
    }
}

} // namespace

int main(int argc, char **argv) {
    return comparator::main(argc, argv, []<int D>(const char *path) { run<D>(path); });
}
