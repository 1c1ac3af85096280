// Points of a file, staged into a store in memory: the beginning of the benchmarks that build
// without a server.
#pragma once

#include <abacus/build.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace abacus {

inline void require(abacus_status status, const abacus_error &error) {
    if (status != ABACUS_OK) throw std::runtime_error(error.message);
}

/// Stages the raw points (see oracle_points) of the file at `path`.
inline void stage_file(const abacus_host &host, abacus_header &header, const char *path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(path, "rb"),
                                                                std::fclose);
    if (!file) throw std::runtime_error(std::string("cannot open ") + path);
    abacus_stage *stage = nullptr;
    abacus_error error{};
    require(abacus_stage_open(&host, &header.facts, std::size_t{256} << 20, &stage, &error), error);
    const std::size_t words = 1 + header.facts.form.dimension;
    std::vector<std::uint64_t> records((1 << 14) * words);
    while (const std::size_t count =
               std::fread(records.data(), words * sizeof(std::uint64_t), 1 << 14, file.get()))
        require(abacus_stage_add(stage, records.data(), count, &error), error);
    require(abacus_stage_finish(stage, &header.facts, &error), error);
    abacus_stage_close(stage);
}

} // namespace abacus
