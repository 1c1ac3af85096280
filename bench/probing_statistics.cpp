// probing_statistics: how misses are served when only the shared facet of a neighbour is known, as
// the dissertation measured it (§5.7, Figures 5.19, 5.20).
//
//   probing_statistics DIMENSION FILE CACHE_MB
//
// Builds the mesh of a file of raw points (see oracle_points) over an in-memory store, with a cache
// that does not read the stored links, so that every miss needs probing. Prints, one a line: links
// followed, misses, the misses served by quick, ray-casting and concentric probing, and the pages
// that each of these read.
//
// The counters show the pages read by each kind. A miss was served by the last kind that read a
// page for it. The core polls its host at the start of every miss. Then this host reads the
// counters and judges the miss before.
#include "delaunay/insertion.hpp"
#include "keys/domain_of.hpp"
#include "points/vertex_reader.hpp"
#include "staged_file.hpp"
#include "support/memory_host.hpp"

#include <abacus/mesh_header.h>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace {

using namespace abacus;

struct Served {
    std::uint64_t quick = 0, ray = 0, concentric = 0;
};

class WatchingHost : public MemoryHost {
public:
    WatchingHost() : watching_(*table()) {
        strict = false;
        watching_.poll = [](void *context) {
            static_cast<WatchingHost *>(static_cast<MemoryHost *>(context))->look();
            return ABACUS_HOST_OK;
        };
        watching_.interrupted = &always_;
    }

    const abacus_host &watching() const { return watching_; }
    /// Reads `counters` from now on, until the last look.
    void watch(const abacus_counters &counters) { counters_ = &counters; }
    const Served &last_look() {
        judge();
        counters_ = nullptr;
        return served_;
    }

private:
    void look() {
        if (counters_ == nullptr || counters_->misses == before_.misses) return;
        judge();
        before_ = *counters_;
    }
    /// Credits the last miss, if there was one, to the kind that served it.
    void judge() {
        if (before_.misses == 0) return;
        if (counters_->concentric_probes > before_.concentric_probes)
            ++served_.concentric;
        else if (counters_->ray_probes > before_.ray_probes)
            ++served_.ray;
        else
            ++served_.quick;
    }

    static constexpr int always_ = 1;
    abacus_host watching_;
    const abacus_counters *counters_ = nullptr;
    abacus_counters before_{}; // at the beginning of the last miss
    Served served_;
};

/// Calls visit(point, id) for the staged points, until it returns false.
template <int D, class Visit>
void for_each_point(const Host &host, const abacus_header &header, Visit visit) {
    VertexReader<D> reader(host, header.facts.columns.attributes, 0, header.facts.census.staged);
    while (reader.advance() && visit(reader.point(), reader.id())) {
    }
}

template <int D> int run(const char *path, std::size_t cache_bytes) {
    WatchingHost memory;
    const Host host(memory.watching());
    abacus_header header{};
    header.facts.form.dimension = D;
    stage_file(memory.watching(), header, path);

    Cache<D> cache(host, domain_of<D>(header.facts.form), 0,
                   {.budget = cache_bytes, .stored_links = false});
    Delaunay<D> delaunay(host, cache, 0, 0);
    Insertion<D> insertion(delaunay);
    memory.watch(cache.counters);
    std::array<Point<D>, D + 1> points;
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &points[i];
    std::array<VertexIndex, D + 1> vertices;
    int n = 0;
    for_each_point<D>(host, header, [&](const Point<D> &p, std::int64_t id) {
        if (is_independent(corners, n, p)) {
            points[n] = p;
            vertices[n++] = cache.create_vertex(p, id, nullptr);
        }
        return n <= D;
    });
    if (n <= D) throw std::runtime_error("the points span no simplex");
    insertion.start(vertices);
    for_each_point<D>(host, header, [&](const Point<D> &p, std::int64_t id) {
        insertion.insert(p, id, nullptr); // refuses the first ones, which are vertices already
        return true;
    });
    const Served served = memory.last_look();
    const abacus_counters &counters = cache.counters;
    std::printf("steps %" PRIu64 "\nmisses %" PRIu64 "\n", counters.steps, counters.misses);
    std::printf("served_quick %" PRIu64 "\nserved_ray %" PRIu64 "\nserved_concentric %" PRIu64 "\n",
                served.quick, served.ray, served.concentric);
    std::printf("pages_quick %" PRIu64 "\npages_ray %" PRIu64 "\npages_concentric %" PRIu64 "\n",
                counters.quick_probes, counters.ray_probes, counters.concentric_probes);
    return 0;
}

} // namespace

int main(int argc, char **argv) {
    try {
        if (argc == 4) {
            const std::size_t cache_bytes = std::stoull(argv[3]) << 20;
            if (std::strcmp(argv[1], "2") == 0) return run<2>(argv[2], cache_bytes);
            if (std::strcmp(argv[1], "3") == 0) return run<3>(argv[2], cache_bytes);
        }
    } catch (const std::exception &error) {
        std::fprintf(stderr, "probing_statistics: %s\n", error.what());
        return 1;
    }
    std::fprintf(stderr, "usage: probing_statistics 2|3 FILE_OF_RAW_POINTS CACHE_MB\n");
    return 2;
}
