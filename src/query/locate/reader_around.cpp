// The simplices around a place, and those near a simplex.
#include "query/locate/reader.hpp"

namespace abacus {

template <int D>
void Reader<D>::describe(std::uint64_t code, const std::int64_t *ids, abacus_simplex &simplex) {
    describe(named(code, ids), simplex);
}

template <int D>
void Reader<D>::neighbours(std::uint64_t code, const std::int64_t *ids, std::uint32_t steps,
                           const std::function<void(const abacus_simplex &)> &visit) {
    Arena<std::uint32_t> steps_to(cache_.host()); // of the simplices met, in the flood's order
    std::size_t at = 0;                           // the one whose facets are crossed
    const auto crosses = [&](Handle h, int) {
        while (around_.met()[at] != h) ++at;
        return steps_to[at] < steps && !cache_.simplex(h).is_ghost();
    };
    around_.from(cache_, named(code, ids), crosses, [&](Handle met) {
        steps_to.push_back(steps_to.empty() ? 0 : steps_to[at] + 1);
        if (cache_.simplex(met).is_ghost()) return true;
        abacus_simplex simplex;
        describe(met, simplex);
        visit(simplex);
        return true;
    });
}

template void Reader<2>::describe(std::uint64_t, const std::int64_t *, abacus_simplex &);
template void Reader<3>::describe(std::uint64_t, const std::int64_t *, abacus_simplex &);
template void Reader<2>::neighbours(std::uint64_t, const std::int64_t *, std::uint32_t,
                                    const std::function<void(const abacus_simplex &)> &);
template void Reader<3>::neighbours(std::uint64_t, const std::int64_t *, std::uint32_t,
                                    const std::function<void(const abacus_simplex &)> &);

} // namespace abacus
