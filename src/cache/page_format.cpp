#include "cache/page_format.hpp"

#include "host/host.hpp"

#include <cmath>
#include <limits>
#include <string>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace abacus {

namespace {

// In sight of each of its callers: some are in loops.
[[gnu::always_inline]] inline void require(bool condition, const char *detail) {
    if (!condition) [[unlikely]] throw_corrupted(detail);
}

constexpr const char *wrong_size = "A simplex page's size does not fit its counts.";
constexpr const char *unknown_vertex = "A simplex page names a vertex that it does not have.";
constexpr const char *repeated_vertex = "A simplex has the same vertex twice.";

} // namespace

void seal_page(unsigned char *bytes, std::size_t size) {
    const std::uint64_t checksum = XXH3_64bits(bytes, size - checksum_bytes);
    std::memcpy(bytes + size - checksum_bytes, &checksum, sizeof checksum);
}

bool page_is_sealed(const unsigned char *bytes, std::size_t size) {
    std::uint64_t stored;
    std::memcpy(&stored, bytes + size - checksum_bytes, sizeof stored);
    return stored == XXH3_64bits(bytes, size - checksum_bytes);
}

template <int D>
void PageView<D>::read_header(const unsigned char *bytes, std::size_t size, int attributes) {
    require(size >= sizeof header_ + checksum_bytes && size <= ABACUS_PAGE_BYTES,
            "A simplex page has an impossible size.");
    std::memcpy(&header_, bytes, sizeof header_);
    require(header_.magic == PageHeader::expected_magic, "A page is no simplex page.");
    if (header_.version != PageHeader::expected_version)
        throw Error(ABACUS_ERROR_CORRUPTED, "mesh has pages of another format",
                    "A simplex page has format version " + std::to_string(header_.version) +
                        ", not " + std::to_string(PageHeader::expected_version) + ".",
                    "Build the mesh anew with this version of the extension.");
    require(header_.dimension == D && header_.attributes == attributes && header_.reserved == 0,
            "A simplex page belongs to another kind of mesh.");
    require(header_.simplices <= block_slots<D> && header_.vertices <= page_vertices<D> &&
                header_.links <= header_.simplices * (D + 1) && header_.codes <= header_.links,
            "A simplex page has impossible counts.");
    require(header_.lower < header_.upper && header_.upper <= end_key &&
                header_.lower.part < key_word_end && header_.upper.part < key_word_end,
            "A simplex page has an impossible interval.");
}

template <int D>
void PageView<D>::read(const unsigned char *bytes, std::size_t size, int attributes,
                       Checksum checksum) {
    read_header(bytes, size, attributes);
    require(checksum == Checksum::ignore || page_is_sealed(bytes, size),
            "A simplex page has a wrong checksum.");
    const unsigned char *const end = bytes + size - checksum_bytes;
    const unsigned char *at = bytes + sizeof header_;
    const std::size_t v = header_.vertices, l = header_.links, s = header_.simplices;
    require(ids_.read(at, end, v), wrong_size);
    for (Column &axis : axes_) require(axis.read(at, end, v), wrong_size);
    for (int i = 0; i < attributes; ++i) require(attributes_[i].read(at, end, v), wrong_size);
    require(codes_.read(at, end, header_.codes), wrong_size);
    require(parts_.read(at, end, l), wrong_size);
    has_parts_ = parts_.is_not_zero();
    const auto fields = [&](std::size_t n, int width) {
        const std::size_t taken = bits_to_bytes(n * width);
        require(static_cast<std::size_t>(end - at) >= taken, wrong_size);
        const BitFields result(at, width);
        at += taken;
        return result;
    };
    link_vertices_ = fields(l, std::bit_width(v + header_.codes));
    for (std::size_t i = 0; i < l; ++i)
        require(link_vertices_[i] < v + header_.codes, "A simplex page has a link to no code.");
    const BitFields steps = fields(s, D + 1);
    read_points();
    read_simplices(steps, at, end);
}

template <int D> void PageView<D>::read_points() {
    constexpr std::uint64_t minus_zero = ordered(-0.0);
    for (int i = 0; i < D; ++i) {
        std::uint64_t least = ~0ull, greatest = 0;
        bool has_minus_zero = false;
        for (int v = 0; v < vertices(); ++v) {
            const std::uint64_t rank = axes_[i][v];
            least = std::min(least, rank);
            greatest = std::max(greatest, rank);
            has_minus_zero |= rank == minus_zero;
            points_[v][i] = from_ordered(rank);
        }
        constexpr double most = std::numeric_limits<double>::infinity();
        box_[i] = vertices() > 0 ? from_ordered(least) : most;
        box_[D + i] = vertices() > 0 ? from_ordered(greatest) : -most;
        require(vertices() == 0 || (least > ordered(-most) && greatest < ordered(most)),
                "A simplex page has a coordinate that is not finite.");
        require(!has_minus_zero, "A simplex page has a coordinate of minus zero.");
    }
}

template <int D>
int PageView<D>::read_root(int s, const BitFields &numbers, std::size_t named, int fresh) {
    const int infinity = vertices();
    std::uint16_t *const corner = &corners_[s * (D + 1)];
    for (int i = 0; i <= D; ++i) {
        corner[i] = static_cast<std::uint16_t>(numbers.narrow(named++));
        // The next one is new; only the last corner may be at infinity.
        require(corner[i] == infinity ? i == D : corner[i] <= fresh, unknown_vertex);
        fresh += corner[i] == fresh && fresh < infinity;
        for (int j = 0; j < i; ++j) require(corner[j] != corner[i], repeated_vertex);
    }
    return fresh;
}

template <int D>
void PageView<D>::read_simplices(const BitFields steps, const unsigned char *at,
                                 const unsigned char *end) {
    const int n = simplices(), infinity = vertices();
    const int width = std::bit_width(header_.vertices);
    const BitFields numbers(at, width);
    // A width of 0 means no vertices, and the first simplex is refused.
    const std::size_t most = width == 0 ? 0 : static_cast<std::size_t>(end - at) * 8 / width;
    std::size_t named = 0;
    int fresh = 0, reached = 0;
    bool is_known = true, is_distinct = true; // each apex
    // What comes next is as hard to foresee as a coin: branches only lead to errors, and those
    // that nothing of this loop relies on are told after it.
    for (int s = 0; s < n; ++s) {
        auto bits = static_cast<unsigned>(steps.narrow(s));
        unsigned entry = D + 1;
        if (s == reached) [[unlikely]] { // a root
            steps_[reached++] = {no_link, 0};
            require(named + D < most, wrong_size);
            fresh = read_root(s, numbers, named, fresh);
            named += D + 1;
        } else {
            const std::uint16_t parent = steps_[s].parent;
            const int is_new = bits & 1;
            bits >>= 1;
            const auto number = static_cast<int>(numbers.narrow(named));
            const int apex = is_new * fresh + (1 - is_new) * number;
            const int limit = is_new * infinity + (1 - is_new) * fresh;
            is_known &= (apex < limit) | ((apex == infinity) & (is_new == 0));
            fresh += is_new;
            named += 1 - is_new;
            const std::uint16_t *const above = corners(link_simplex(parent));
            for (int i = 0; i <= D; ++i) is_distinct &= above[i] != apex;
            entry = static_cast<unsigned>(child_across<D>(
                above, link_facet(parent), static_cast<std::uint16_t>(apex),
                static_cast<std::uint16_t>(infinity), &corners_[s * (D + 1)]));
            steps_[s].facet = static_cast<std::uint16_t>(entry);
        }
        // Bits of all facets: none towards the parent.
        const unsigned before = (1u << entry) - 1;
        const unsigned children = (bits & before) | (bits & ~before) << 1;
#pragma GCC unroll 4
        for (int f = 0; f <= D; ++f) {
            steps_[reached].parent = static_cast<std::uint16_t>(make_link(s, f));
            reached += children >> f & 1;
        }
        require(reached <= n, "A simplex page has impossible counts.");
        require(named <= most, wrong_size);
    }
    require(is_known, unknown_vertex);
    require(is_distinct, repeated_vertex);
    require(fresh == infinity, "A page has a vertex without simplices.");
    require(at + bits_to_bytes(named * width) == end, wrong_size);
}

template class PageView<2>;
template class PageView<3>;

} // namespace abacus
