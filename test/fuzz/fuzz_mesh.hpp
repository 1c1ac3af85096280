// What the fuzz targets share: a small sound mesh of several pages, built once, and all operations
// on a mesh, run on a damaged copy of it. Whatever the damage, every call must end with a clean
// status, in bounded time and without a leak.
#pragma once

#include "mesh/page_format.hpp"
#include "support/memory_host.hpp"

#include <abacus/abacus.h>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace abacus::fuzz {

[[noreturn]] inline void fail(const std::string &what) {
    std::fprintf(stderr, "%s\n", what.c_str());
    std::abort();
}

inline void require(bool condition, const char *what) {
    if (!condition) fail(what);
}

class Mesh {
public:
    MemoryHost host;
    abacus_header header{};
    std::size_t cache_bytes = 1 << 20;

    /// Runs a call that returns a status; every status except an internal error is right.
    template <class Call> abacus_status run(Call call) {
        abacus_error error{};
        const abacus_status status = call(error);
        if (status == ABACUS_ERROR && error.kind == ABACUS_ERROR_INTERNAL)
            fail(std::string("internal error: ") + error.message + ' ' + error.detail);
        if (status == ABACUS_HOST_ERROR) {
            // If pages overlap, a database refuses a second one under the same key.
            require(host.violations.size() == 1 &&
                        host.violations[0] == "a second page is put under one key",
                    "a host error without a cause");
        } else {
            require(host.violations.empty(), "the host was used wrongly");
        }
        host.violations.clear();
        host.recover();
        return status;
    }

    /// Calls use(stage, error) with a stage that has the points drawn from the seed.
    template <class Use> void with_stage(int points, unsigned seed, Use use) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        run([&](abacus_error &error) {
            abacus_stage *stage = nullptr;
            abacus_status status =
                abacus_stage_open(host.table(), &header.facts, 1 << 20, &stage, &error);
            for (int i = 0; i < points && status == ABACUS_OK; ++i) {
                std::vector<std::uint64_t> record{random() % 1000};
                for (unsigned j = 0;
                     j < header.facts.form.dimension + header.facts.columns.attributes; ++j)
                    record.push_back(std::bit_cast<std::uint64_t>(unit(random)));
                status = abacus_stage_add(stage, record.data(), 1, &error);
            }
            if (status == ABACUS_OK) status = use(stage, error);
            abacus_stage_close(stage);
            return status;
        });
    }

    void stage(int points, unsigned seed) {
        with_stage(points, seed, [&](abacus_stage *stage, abacus_error &error) {
            return abacus_stage_finish(stage, &header.facts, &error);
        });
    }

    void remove(int points, unsigned seed) {
        with_stage(points, seed, [&](abacus_stage *stage, abacus_error &error) {
            abacus_build *build = nullptr;
            abacus_status status =
                abacus_build_open(host.table(), &header.facts, cache_bytes, &build, &error);
            if (status != ABACUS_OK) return status;
            std::uint64_t deleted;
            status = abacus_build_delete(build, stage, 0, &header, &deleted, &error);
            abacus_build_close(build);
            return status;
        });
    }

    abacus_status build() {
        return run([&](abacus_error &error) {
            abacus_build *build = nullptr;
            abacus_status status =
                abacus_build_open(host.table(), &header.facts, cache_bytes, &build, &error);
            if (status != ABACUS_OK) return status;
            status = abacus_build_run(build, 0, &header, &error);
            abacus_build_close(build);
            return status;
        });
    }

    void locate_and_walk() {
        for (int i = 0; i < 6; ++i)
            run([&](abacus_error &error) {
                abacus_mesh *mesh = nullptr;
                abacus_status status =
                    abacus_mesh_open(host.table(), &header.facts, cache_bytes, &mesh, &error);
                if (status != ABACUS_OK) return status;
                const double p[] = {0.1 + 0.15 * i, 0.8 - 0.1 * i, 0.2 + 0.1 * i};
                abacus_simplex s;
                status = abacus_mesh_locate(mesh, p, &s, &error);
                for (int step = 0; step < 12 && status == ABACUS_OK; ++step)
                    status =
                        abacus_mesh_walk(mesh, s.code, s.id,
                                         step % (int(header.facts.form.dimension) + 1), &s, &error);
                abacus_mesh_close(mesh);
                return status;
            });
    }

    static abacus_host_status ignore_place(void *, std::int64_t, const abacus_simplex *,
                                           const double *) {
        return ABACUS_HOST_OK;
    }

    void locate_places() {
        run([&](abacus_error &error) {
            abacus_places *places = nullptr;
            abacus_status status = abacus_places_open(host.table(), &header.facts, 1 << 20,
                                                      cache_bytes, &places, &error);
            for (int i = 0; i < 100 && status == ABACUS_OK; ++i) {
                std::vector<std::uint64_t> record{static_cast<std::uint64_t>(i)};
                for (const int step : {7, 31, 53}) // dense enough for many in one page
                    record.push_back(std::bit_cast<std::uint64_t>(i * step % 100 / 100.0));
                record.resize(1 + header.facts.form.dimension);
                status = abacus_places_add(places, record.data(), 1, &error);
            }
            if (status == ABACUS_OK)
                status = abacus_places_locate(places, ignore_place, nullptr, &error);
            abacus_places_close(places);
            return status;
        });
    }

    void scan() {
        run([&](abacus_error &error) {
            abacus_scan *scan = nullptr;
            abacus_status status = abacus_scan_open(host.table(), &header.facts, 1, &scan, &error);
            if (status != ABACUS_OK) return status;
            abacus_simplex s;
            while ((status = abacus_scan_next(scan, &s, &error)) == ABACUS_OK) {
            }
            abacus_scan_close(scan);
            return status;
        });
    }

    void vertex_scan() {
        run([&](abacus_error &error) {
            abacus_vertex_scan *scan = nullptr;
            abacus_status status =
                abacus_vertex_scan_open(host.table(), &header.facts, cache_bytes, &scan, &error);
            if (status != ABACUS_OK) return status;
            abacus_vertex v;
            while ((status = abacus_vertex_scan_next(scan, &v, &error)) == ABACUS_OK) {
            }
            abacus_vertex_scan_close(scan);
            return status;
        });
    }

    /// Returns the number of faults.
    int check() {
        int faults = 0;
        run([&](abacus_error &error) {
            abacus_check *check = nullptr;
            const abacus_status status =
                abacus_check_open(host.table(), &header.facts, cache_bytes, 20, &check, &error);
            if (status != ABACUS_OK) return status;
            for (abacus_fault fault; abacus_check_next(check, &fault) == ABACUS_OK;) ++faults;
            abacus_check_close(check);
            return status;
        });
        return faults;
    }

    /// Draws the whole mesh, and a window.
    void draw() {
        abacus_drawing drawing{};
        drawing.width = drawing.height = 16;
        drawing.edges = 1;
        drawing.exaggeration = 1;
        draw(drawing);
        std::fill_n(drawing.lower, 3, 0.45);
        std::fill_n(drawing.upper, 3, 0.55);
        draw(drawing);
    }
    void draw(const abacus_drawing &drawing) {
        run([&](abacus_error &error) {
            const abacus_section section{{0.5, 0.5, 0.5}, {1, 2, 3}, 1};
            abacus_picture picture{};
            const abacus_status status =
                header.facts.form.dimension == 2
                    ? abacus_draw(host.table(), &header.facts, &drawing, &picture, &error)
                    : abacus_draw_section(host.table(), &header.facts, &section, &drawing, &picture,
                                          &error);
            if (status == ABACUS_OK) host.host().release(picture.png);
            return status;
        });
    }

    /// Runs all operations; those that change pages come last.
    void do_everything() {
        locate_and_walk();
        locate_places();
        scan();
        vertex_scan();
        check();
        draw();
        build();
        check();
        remove(100, 1);
        check();
        require(host.bytes == 0, "memory is not given back");
    }
};

/// Where vertices have their attributes: some in the pages of simplices, or in pages of their own;
/// or as many as possible, so that a point that waits or is repeated takes a page.
enum class Carried { in_pages, apart, many };

/// The sound mesh: its attributes make small pages; some points are repeated, some wait.
inline const Mesh &sound_mesh(int dimension, Carried carried = Carried::in_pages) {
    static Mesh meshes[6];
    Mesh &mesh = meshes[dimension - 2 + 2 * static_cast<int>(carried)];
    if (mesh.header.facts.form.dimension == 0) {
        const bool many = carried == Carried::many;
        mesh.header.facts.form.dimension = static_cast<std::uint32_t>(dimension);
        mesh.header.facts.columns.attributes = many ? ABACUS_MAX_ATTRIBUTES : 5;
        mesh.header.facts.columns.apart = carried != Carried::in_pages;
        for (unsigned i = 0; i < mesh.header.facts.columns.attributes; ++i)
            std::strcpy(mesh.header.names[i], "height");
        const int points = many ? 10 : 40;
        mesh.stage(4 * points, 1);
        mesh.stage(2 * points, 1); // a second time
        require(mesh.build() == ABACUS_OK, "the sound mesh cannot be built");
        mesh.stage(points, 2);
        require(mesh.check() == 0, "the sound mesh is not sound");
    }
    return mesh;
}

/// The first byte of an input chooses a mesh.
constexpr std::uint8_t many = 64;
inline int dimension_of(std::uint8_t choice) { return choice % 2 == 0 ? 2 : 3; }
inline Carried carried_by(std::uint8_t choice) {
    return (choice & many) != 0 ? Carried::many : Carried::in_pages;
}

/// Calls act(mesh) with a fresh copy of the sound mesh.
inline void with_copy(int dimension, std::size_t cache_bytes,
                      const std::function<void(Mesh &)> &act, Carried carried = Carried::in_pages) {
    Mesh mesh;
    mesh.host.restore(sound_mesh(dimension, carried).host);
    mesh.header = sound_mesh(dimension, carried).header;
    mesh.cache_bytes = cache_bytes;
    act(mesh);
}

/// Reads numbers from the input; 0 when it is used up.
class Bytes {
public:
    Bytes(const std::uint8_t *data, std::size_t size) : at_(data), end_(data + size) {}

    template <class T> T next() {
        T value{};
        const std::size_t n = std::min(sizeof value, rest());
        if (n > 0) std::memcpy(&value, at_, n);
        at_ += n;
        return value;
    }
    std::size_t rest() const { return static_cast<std::size_t>(end_ - at_); }
    const std::uint8_t *data() const { return at_; }

private:
    const std::uint8_t *at_, *end_;
};

/// Changes stored pages as the input says: either the input's bytes replace one page, or single
/// bytes, 16-bit numbers and words of any page change.
template <class Pages> void damage(Pages &pages, Bytes &input) {
    const auto page = [&]() -> MemoryHost::Page & {
        const auto n = input.next<std::uint8_t>() % pages.size();
        return std::next(pages.begin(), static_cast<std::ptrdiff_t>(n))->second;
    };
    const auto change = [&](auto value) {
        MemoryHost::Page &changed = page();
        const std::size_t at = input.next<std::uint16_t>();
        value = input.next<decltype(value)>();
        if (changed.size < sizeof value) return;
        // Aligned to its size, like everything in a page.
        const std::size_t slot = at % (changed.size / sizeof value);
        std::memcpy(changed.bytes() + slot * sizeof value, &value, sizeof value);
    };
    if (input.next<std::uint8_t>() % 4 == 0) {
        MemoryHost::Page &replaced = page();
        if (input.rest() == 0) return; // a database has no empty values
        const std::uint64_t location = replaced.location;
        replaced.assign(input.data(), std::min<std::size_t>(input.rest(), ABACUS_MAX_PAGE_BYTES));
        replaced.location = location;
        return;
    }
    while (input.rest() > 0) {
        switch (input.next<std::uint8_t>() % 4) {
        case 0:
            change(std::uint8_t{});
            break;
        case 1:
            change(std::uint16_t{});
            break;
        case 2:
            change(std::uint64_t{});
            break;
        default: { // a word from another place: plausible keys and coordinates
            MemoryHost::Page &from = page(), &to = page();
            const std::size_t a = input.next<std::uint16_t>(), b = input.next<std::uint16_t>();
            if (!from.words.empty() && !to.words.empty())
                to.words[b % to.words.size()] = from.words[a % from.words.size()];
        }
        }
    }
}

/// Gives damaged simplex pages the checksums of their bytes: with a wrong one, nothing behind it
/// would be read.
template <class Pages> void seal(Pages &pages) {
    for (auto &[key, page] : pages)
        if (page.size >= checksum_bytes) seal_page(page.bytes(), page.size);
}

/// libFuzzer starts from the files of a folder. The inputs from `seeds` go to the first folder on
/// the command line, if it is empty.
inline void write_seeds(int argc, char **argv,
                        const std::vector<std::vector<std::uint8_t>> &seeds) {
    for (int i = 1; i < argc; ++i) {
        const std::filesystem::path folder = argv[i];
        if (argv[i][0] == '-' || !std::filesystem::is_directory(folder)) continue;
        if (!std::filesystem::is_empty(folder)) return;
        for (std::size_t n = 0; n < seeds.size(); ++n) {
            std::ofstream file(folder / ("seed-" + std::to_string(n)), std::ios::binary);
            file.write(reinterpret_cast<const char *>(seeds[n].data()),
                       static_cast<std::streamsize>(seeds[n].size()));
        }
        return;
    }
}

/// Inputs for damage(): every page whole, after `prefix`, and a few single changes.
template <class Pages>
std::vector<std::vector<std::uint8_t>> page_seeds(const Pages &pages,
                                                  const std::vector<std::uint8_t> &prefix) {
    std::vector<std::vector<std::uint8_t>> seeds;
    std::uint8_t n = 0;
    for (const auto &[key, page] : pages) {
        seeds.push_back(prefix);
        seeds.back().insert(seeds.back().end(), {0, n++});
        const auto *bytes = reinterpret_cast<const std::uint8_t *>(page.words.data());
        seeds.back().insert(seeds.back().end(), bytes, bytes + page.size);
    }
    for (std::uint8_t kind = 0; kind < 4; ++kind) {
        seeds.push_back(prefix);
        seeds.back().insert(seeds.back().end(),
                            {1, kind, 2, 40, 1, 0, 0, 0, 0, 1, 0, 0, 0, kind, 1, 60, 0, 9, 9, 9});
    }
    return seeds;
}

} // namespace abacus::fuzz
