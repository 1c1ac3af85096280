#include "query/reader.hpp"

#include "cache/domain_of.hpp"
#include "host/memory.hpp"
#include "query/describe.hpp"

#include <memory_resource>
#include <string>
#include <unordered_set>

namespace abacus {

template <int D>
Reader<D>::Reader(const Host &host, const abacus_header &header, const CacheOptions &options)
    : size_(header.simplices == 0 ? 0 : header.simplices + header.ghosts),
      cache_(host, domain_of<D>(header), static_cast<int>(header.attributes), options),
      walk_(cache_) {}

template <int D> Handle Reader<D>::find(const Point<D> &p) {
    if (size_ == 0) return no_handle;
    cache_.trim();
    const std::uint64_t code = cache_.domain().code(p);
    Handle from = last_;
    if (!cache_.is_live(from) || !(cache_.near(from, code) || walk_.is_close(from, p)))
        from = cache_.start(code, p);
    if (from == no_handle) throw_corrupted("The mesh has no simplices.");
    return last_ = walk_.to(p, from, size_);
}

template <int D> void Reader<D>::describe(Handle h, abacus_simplex &simplex) const {
    const Simplex<D> &s = cache_.simplex(h);
    SimplexWriter<D> writer(simplex, cache_.code(s), s.is_ghost());
    for (int i = 0; i < s.finite_vertices(); ++i)
        writer.corner(i, cache_.vertices().id(s.vertex[i]), cache_.point(s.vertex[i]));
    writer.finish();
}

template <int D> bool Reader<D>::locate(const Point<D> &p, abacus_simplex &simplex) {
    const Handle h = find(p);
    if (h == no_handle || cache_.simplex(h).is_ghost()) return false;
    first_around(p, h, simplex);
    return true;
}

template <int D>
void Reader<D>::first_around(const Point<D> &p, Handle h, abacus_simplex &simplex) {
    describe(h, simplex);
    // Across every facet that p lies on there is another simplex that contains p.
    HostMemory memory(cache_.host());
    std::pmr::unordered_set<Handle> seen(&memory);
    Arena<Handle> open(cache_.host());
    for (Handle at = h;;) {
        for (int i = 0; i <= D; ++i) {
            Corners<D> corners = cache_.corners(cache_.simplex(at));
            corners[i] = &p;
            if (orientation<D>(corners) != 0) continue;
            if (seen.empty()) seen.insert(h);
            const Handle next = link_simplex(cache_.cross(at, i));
            if (cache_.simplex(next).is_ghost() || !seen.insert(next).second) continue;
            open.push_back(next);
            abacus_simplex other;
            describe(next, other);
            if (comes_before<D>(other, simplex)) simplex = other;
        }
        if (open.empty()) return;
        at = open.back();
        open.pop_back();
        cache_.poll();
    }
}

template <int D>
bool Reader<D>::walk(std::uint64_t code, const std::int64_t *ids, int facet,
                     abacus_simplex &simplex) {
    Handle h = no_handle;
    int crossed = 0;
    if (size_ != 0 && facet >= 0 && facet <= D && code < key_word_end) {
        cache_.trim();
        h = cache_.find(code, [&](Handle candidate) {
            const Simplex<D> &s = cache_.simplex(candidate);
            if (s.is_ghost()) return false;
            // The ids in any order: the facet is named by the corner opposite it.
            std::array<bool, D + 1> used{};
            int opposite = -1;
            for (int i = 0; i <= D; ++i) {
                int j = 0;
                while (j <= D && (used[j] || cache_.vertices().id(s.vertex[j]) != ids[i])) ++j;
                if (j > D) return false;
                used[j] = true;
                if (i == facet) opposite = j;
            }
            crossed = opposite;
            return true;
        });
    }
    if (h == no_handle)
        throw Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such simplex", {},
                    "Take a simplex that abacus_locate, abacus_walk or abacus_simplices returned "
                    "for this mesh, and a facet from 0 to " + std::to_string(D) + ".");
    const Handle neighbour = link_simplex(cache_.cross(h, crossed));
    if (cache_.simplex(neighbour).is_ghost()) return false;
    last_ = neighbour;
    describe(neighbour, simplex);
    return true;
}

template <int D>
std::optional<typename Reader<D>::Found> Reader<D>::vertex_at(const Point<D> &p) {
    const Handle h = find(p);
    if (h == no_handle) return std::nullopt;
    const Simplex<D> &s = cache_.simplex(h);
    for (int i = 0; i < s.finite_vertices(); ++i) {
        const VertexIndex v = s.vertex[i];
        if (cache_.point(v) == p)
            return Found{cache_.vertices().id(v), cache_.vertices().attributes(v)};
    }
    return std::nullopt;
}

template class Reader<2>;
template class Reader<3>;

} // namespace abacus
