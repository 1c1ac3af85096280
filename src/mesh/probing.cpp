// Probing: finding the page of a neighbour when only the shared facet is known (dissertation
// §4.10). Three methods, from speculative to certain:
//
//   quick       the page of the facet's greatest vertex, which gives the neighbour its key
//               unless the neighbour's other vertex is greater still
//   ray         the pages along rays from the facet's middle into the half-space beyond,
//               all rays one page at a time; octant by octant, with the ray-box
//               intersection of Kay and Kajiya
//   concentric  rings of growing size around the middle, and at last every page
//
// Stored links need none of this: a link carries its neighbour's key. Probing
// serves links without a key (a triangulation made elsewhere), and measurements.
//
// Where the dissertation walks the leaves of its octree, we have intervals of the
// same curve: the largest octant around a cell that lies inside the interval plays
// the leaf's part.
#include "mesh/cache.hpp"

#include <numbers>

namespace abacus {

namespace {

template <int D> constexpr int ray_count = D == 2 ? 9 : 17;
template <int D> constexpr int ray_steps = D == 2 ? 32 : 4;
constexpr int ring_limit = 32;

template <int D> using Vector = std::array<double, D>;

template <int D> double dot(const Vector<D> &a, const Vector<D> &b) {
    double sum = 0;
    for (int i = 0; i < D; ++i) sum += a[i] * b[i];
    return sum;
}

/// Directions spread over all sides; those into the wrong half-space are dropped.
template <int D> Vector<D> direction(int i, int n) {
    if constexpr (D == 2) {
        const double angle = 2 * std::numbers::pi * i / n;
        return {std::cos(angle), std::sin(angle)};
    } else { // spherical Fibonacci points
        const double z = 1 - (2 * i + 1.0) / n;
        const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
}

} // namespace

template <int D> void Cache<D>::probe(Handle h, int facet) {
    Cell<D> middle{};
    std::array<std::uint64_t, D> sum{};
    std::uint64_t greatest = 0;
    int n = 0;
    for (int i = 0; i <= D; ++i) {
        const VertexIndex v = slots_[h].vertex[i];
        if (i == facet || v == infinite_vertex) continue;
        const Cell<D> cell = domain_.cell(point(v));
        for (int axis = 0; axis < D; ++axis) sum[axis] += cell[axis];
        greatest = std::max(greatest, vertices_[v].code);
        ++n;
    }
    for (int axis = 0; axis < D; ++axis) middle[axis] = static_cast<std::uint32_t>(sum[axis] / n);
    if (quick_probe(h, facet, greatest) || ray_probe(h, facet, middle) ||
        concentric_probe(h, facet, middle))
        return;
    throw_corrupted("A facet has no simplex on its other side.");
}

/// Whether a page was loaded.
template <int D> bool Cache<D>::load_uncached(std::uint64_t code) {
    const Key key{code, 0};
    if (cached_owner(key) != no_block) return false;
    return owner(key) != no_block;
}

template <int D> bool Cache<D>::quick_probe(Handle h, int facet, std::uint64_t greatest) {
    if (!load_uncached(greatest)) return false;
    ++counters.quick_probes;
    return present(h, facet);
}

template <int D> int Cache<D>::octant_level(const Cell<D> &cell) const {
    const std::uint64_t code = curve_code<D>(cell);
    const BlockIndex b = cached_owner({code, 0});
    int level = 0;
    while (b != no_block && level < code_bits<D>) {
        const std::uint64_t size = 1ull << (D * (level + 1));
        const std::uint64_t from = code & ~(size - 1);
        if (from < blocks_[b].sure_lower || from + size > blocks_[b].sure_upper) break;
        ++level;
    }
    return level;
}

template <int D> bool Cache<D>::ray_probe(Handle h, int facet, const Cell<D> &middle) {
    // The half-space beyond the facet: away from the opposite vertex, or towards it
    // when that is the point at infinity. Only the direction matters here.
    const Simplex<D> &s = slots_[h];
    const bool from_ghost = s.vertex[facet] == infinite_vertex;
    Vector<D> outward{};
    if (!from_ghost)
        for (int axis = 0; axis < D; ++axis)
            outward[axis] =
                double(middle[axis]) - double(domain_.cell(point(s.vertex[facet]))[axis]);

    struct Ray {
        Vector<D> at, along;
        bool alive;
    };
    std::array<Ray, 2 * ray_count<D>> rays;
    for (int i = 0; i < 2 * ray_count<D>; ++i) {
        rays[i].along = direction<D>(i, 2 * ray_count<D>);
        for (int axis = 0; axis < D; ++axis) rays[i].at[axis] = middle[axis] + 0.5;
        rays[i].alive = dot<D>(rays[i].along, outward) >= 0;
    }
    const double end = static_cast<double>(1ull << code_bits<D>);
    for (int step = 0; step < ray_steps<D>; ++step) {
        for (Ray &ray : rays) {
            if (!ray.alive) continue;
            Cell<D> cell;
            for (int axis = 0; axis < D; ++axis)
                cell[axis] = static_cast<std::uint32_t>(ray.at[axis]);
            if (load_uncached(curve_code<D>(cell))) {
                ++counters.ray_probes;
                if (present(h, facet)) return true;
            }
            // Go to the exit from this octant, and half a cell further.
            const double size = std::ldexp(1.0, octant_level(cell));
            double exit = std::numeric_limits<double>::infinity();
            for (int axis = 0; axis < D; ++axis) {
                const double low = std::floor(cell[axis] / size) * size;
                const double d = ray.along[axis];
                if (d != 0) exit = std::min(exit, ((d > 0 ? low + size : low) - ray.at[axis]) / d);
            }
            for (int axis = 0; axis < D; ++axis) {
                ray.at[axis] += (std::max(exit, 0.0) + 0.5) * ray.along[axis];
                if (!(ray.at[axis] >= 0 && ray.at[axis] < end)) ray.alive = false;
            }
        }
    }
    return false;
}

template <int D> bool Cache<D>::concentric_probe(Handle h, int facet, const Cell<D> &middle) {
    const std::int64_t grid = std::int64_t(1) << octant_level(middle);
    const std::int64_t end = std::int64_t(1) << code_bits<D>;
    for (std::int64_t radius = 1; radius <= ring_limit; ++radius) {
        host_.poll();
        // The surface of a cube of grid steps.
        std::array<std::int64_t, D> step;
        step.fill(-radius);
        for (;;) {
            bool surface = false, inside = true;
            Cell<D> cell;
            for (int axis = 0; axis < D; ++axis) {
                surface = surface || step[axis] == radius || step[axis] == -radius;
                const std::int64_t at = middle[axis] + step[axis] * grid;
                inside = inside && at >= 0 && at < end;
                cell[axis] = static_cast<std::uint32_t>(at);
            }
            if (surface && inside && load_uncached(curve_code<D>(cell))) {
                ++counters.concentric_probes;
                if (present(h, facet)) return true;
            }
            int axis = 0;
            while (axis < D && ++step[axis] > radius) step[axis++] = -radius;
            if (axis == D) break;
        }
    }
    return probe_every_page(h, facet);
}

/// A neighbour that is still not found may be anywhere.
template <int D> bool Cache<D>::probe_every_page(Handle h, int facet) {
    Key last{};
    const Key *after = nullptr;
    abacus_page page{};
    while (host_.next(ABACUS_SIMPLEX_PAGES, after, page)) {
        host_.poll();
        last = page.key;
        after = &last;
        if (this->has_block_at(last)) continue;
        ++counters.concentric_probes;
        load(page);
        if (present(h, facet)) return true;
    }
    return false;
}

} // namespace abacus
