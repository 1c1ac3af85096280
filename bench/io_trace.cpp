// io_trace: which pages a build reads and writes, and when: the traces of the dissertation's §5.5,
// Figures 5.15 and 5.16.
//
//   io_trace DIMENSION FILE CACHE_MB
//
// Stages a file of raw points (see oracle_points) into a store in memory, then triangulates them
// with a cache of CACHE_MB. Prints a line for each page that the core meanwhile requests from its
// host or passes to it:
//
//   SECONDS vertices|simplices read|write|erase BLOCK PLACE
//
// BLOCK is the page's place in a table's heap: within one transaction no space is reused, so each
// version of a page gets the next block. PLACE is where the page begins, from 0 to 1: on the curve
// for simplices, in the order of insertion for vertices. SECONDS are CPU time of the core alone.
// What happens to a request below the core depends on the server and the file system.
#include "staged_file.hpp"
#include "support/memory_host.hpp"

#include <abacus/build.h>
#include <ctime>
#include <unordered_map>

namespace {

using namespace abacus;

double cpu_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

class TracingHost : public MemoryHost {
public:
    TracingHost() : beneath_(*table()), tracing_(*table()) {
        strict = false;
        tracing_.find = [](void *context, abacus_page_kind kind, abacus_key key,
                           abacus_page *page) {
            TracingHost &host = self(context);
            const abacus_host_status status = host.beneath_.find(context, kind, key, page);
            if (status == ABACUS_HOST_OK) host.note(kind, "read", *page);
            return status;
        };
        tracing_.next = [](void *context, abacus_page_kind kind, const abacus_key *key,
                           abacus_page *page) {
            TracingHost &host = self(context);
            const abacus_host_status status = host.beneath_.next(context, kind, key, page);
            if (status == ABACUS_HOST_OK) host.note(kind, "read", *page);
            return status;
        };
        tracing_.put = [](void *context, abacus_page_kind kind, abacus_page *page) {
            TracingHost &host = self(context);
            const std::uint64_t before = page->location;
            const abacus_host_status status = host.beneath_.put(context, kind, page);
            if (status != ABACUS_HOST_OK) return status;
            host.tables_[kind].blocks.erase(before);
            host.tables_[kind].blocks.emplace(page->location, host.tables_[kind].size++);
            host.note(kind, "write", *page);
            return status;
        };
        tracing_.erase = [](void *context, abacus_page_kind kind, const abacus_page *page) {
            TracingHost &host = self(context);
            host.note(kind, "erase", *page);
            host.tables_[kind].blocks.erase(page->location);
            return host.beneath_.erase(context, kind, page);
        };
    }

    const abacus_host &tracing() const { return tracing_; }
    /// Prints all requests from now on.
    void start(const abacus_header &header) {
        spans_[ABACUS_SIMPLEX_PAGES] =
            double(std::uint64_t{1} << (header.facts.form.dimension == 2 ? 62 : 63));
        spans_[ABACUS_STAGED_PAGES] = double(header.facts.census.staged);
        spans_[ABACUS_REPEATED_PAGES] = spans_[ABACUS_SIMPLEX_PAGES];
        started_ = true;
        start_ = cpu_seconds();
    }

private:
    /// Repeated points share the vertex table, but their pages are written only at the end.
    static constexpr const char *names[] = {"simplices", "vertices", "repeated"};
    struct Table {
        std::uint64_t size = 0;                                  // blocks
        std::unordered_map<std::uint64_t, std::uint64_t> blocks; // by location
    };

    static TracingHost &self(void *context) {
        return *static_cast<TracingHost *>(static_cast<MemoryHost *>(context));
    }

    void note(abacus_page_kind kind, const char *what, const abacus_page &page) {
        if (!started_) return;
        std::printf("%.6f %s %s %llu %.6f\n", cpu_seconds() - start_, names[kind], what,
                    static_cast<unsigned long long>(tables_[kind].blocks.at(page.location)),
                    double(page.key.code) / spans_[kind]);
    }

    const abacus_host beneath_;
    abacus_host tracing_;
    Table tables_[3];
    double spans_[3] = {};
    bool started_ = false;
    double start_ = 0;
};

void run(unsigned dimension, const char *path, std::size_t cache_bytes) {
    TracingHost host;
    abacus_header header{};
    header.facts.form.dimension = dimension;
    stage_file(host.tracing(), header, path);
    host.start(header);
    abacus_build *build = nullptr;
    abacus_error error{};
    require(abacus_build_open(&host.tracing(), &header.facts, cache_bytes, &build, &error), error);
    require(abacus_build_run(build, 0, &header, &error), error);
    abacus_build_close(build);
}

} // namespace

int main(int argc, char **argv) {
    const std::string dimension = argc == 4 ? argv[1] : "";
    if (dimension != "2" && dimension != "3") {
        std::fprintf(stderr, "usage: io_trace 2|3 FILE_OF_RAW_POINTS CACHE_MB\n");
        return 2;
    }
    try {
        run(dimension == "2" ? 2 : 3, argv[2], std::stoull(argv[3]) << 20);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "io_trace: %s\n", error.what());
        return 1;
    }
}
