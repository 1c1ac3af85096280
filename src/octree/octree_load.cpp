#include "octree/octree_load.hpp"

#include "blocks/counters.hpp"
#include "octree/outside.hpp"

#include <cstring>
#include <string>

namespace abacus {
namespace {

[[noreturn]] void refuse(const std::string &detail) {
    throw Error(ABACUS_ERROR_ARGUMENT, "the octants do not tile the domain", detail);
}

std::string row(std::uint64_t number) { return "row " + std::to_string(number); }

} // namespace

template <int D>
void OctreeLoad<D>::add(std::uint64_t code, std::int64_t level, const double *values) {
    const std::uint64_t number = leaves_.size() + 1;
    if (level < 0 || level > static_cast<std::int64_t>(facts_.form.levels))
        throw_no_level(level, static_cast<int>(facts_.form.levels));
    const Octant<D> leaf{code, static_cast<int>(level)};
    if (code >= domain_cells<D> || !leaf.is_aligned())
        throw Error(ABACUS_ERROR_ARGUMENT,
                    "no octant of level " + std::to_string(level) + " has the code " +
                        std::to_string(static_cast<std::int64_t>(code)),
                    "It is in " + row(number) + ".");
    std::uint64_t *const record = leaves_.add();
    record[0] = code;
    record[1] = static_cast<std::uint64_t>(level);
    record[2] = number;
    std::memcpy(record + 3, values, facts_.columns.attributes * sizeof *values);
}

template <int D> void OctreeLoad<D>::write(abacus_header &header) {
    LeafScan<D> before(host_, facts_);
    if (facts_.census.leaves != 1 || !before.next())
        throw Error(ABACUS_ERROR_STATE, "the octree already has leaves", {},
                    "Load the rows into a new octree.");
    LeafWriter<D> writer(host_, facts_);
    writer.begin(0, before.location());
    // Merging leaves may have left empty pages.
    while (before.next_page())
        host_.erase(ABACUS_OCTANT_PAGES, {{before.lower(), 0}, nullptr, 0, before.location()});
    leaves_.finish();
    Pacer pacer(host_);
    pacer.begin(ABACUS_PHASE_FLUSHING, leaves_.size());
    std::uint64_t end = 0, last = 0, n = 0;
    while (const std::uint64_t *record = leaves_.next()) {
        const Octant<D> leaf{record[0], static_cast<int>(record[1])};
        if (leaf.code < end)
            refuse("The octant of " + row(record[2]) + " overlaps that of " + row(last) + ".");
        if (leaf.code > end)
            refuse(n == 0 ? "There is a gap before the octant of " + row(record[2]) + "."
                          : "There is a gap between the octants of " + row(last) + " and " +
                                row(record[2]) + ".");
        writer.add(leaf, reinterpret_cast<const double *>(record + 3), true);
        end = leaf.end();
        last = record[2];
        if (++n % Pacer::stride == 0) pacer.reached(n, {1, writer.counters().stores});
    }
    if (n == 0) refuse("There are no octants.");
    if (end != domain_cells<D>) refuse("There is a gap after the octant of " + row(last) + ".");
    leaves_.close();
    writer.end(key_word_end);
    header.facts.census.leaves = n;
    header.counters += writer.counters();
    ++header.counters.deleted; // the leaf of the new octree
}

template class OctreeLoad<2>;
template class OctreeLoad<3>;

} // namespace abacus
