#include "staging/density.hpp"

#include "mesh/page_format.hpp"

#include <abacus/facts.h>

namespace abacus {

namespace {
constexpr double nearly_all = 0.9;
} // namespace

bool is_dense(const Host &host, Arena<std::uint64_t> &codes, double vertices_each) {
    std::sort(codes.begin(), codes.end());
    std::size_t dense = 0;
    const std::uint64_t *const end = codes.end();
    for (const std::uint64_t *code = codes.begin(); code != end;) {
        host.poll();
        abacus_page page;
        PageHeader header;
        if (!host.find(ABACUS_SIMPLEX_PAGES, {*code, 0}, page) || page.size < sizeof header)
            return false; // the next load of the page says what is wrong
        std::memcpy(&header, page.bytes, sizeof header);
        const auto *const next = std::lower_bound(code + 1, end, header.upper.code);
        const auto points = static_cast<std::size_t>(next - code);
        if (header.vertices >= vertices_each * static_cast<double>(points)) dense += points;
        code = next;
    }
    return static_cast<double>(dense) >= nearly_all * static_cast<double>(codes.size());
}

} // namespace abacus
