#include "mesh/page_format.hpp"

#include "host/host.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace abacus {

namespace {

// Inline in all callers: some are in loops.
[[gnu::always_inline]] inline void require(bool condition, const char *detail) {
    if (!condition) [[unlikely]]
        throw_corrupted(detail);
}

constexpr const char *wrong_size = "A simplex page's size does not fit its counts.";
constexpr const char *unknown_vertex = "A simplex page names a vertex that it does not have.";
constexpr const char *repeated_vertex = "A simplex has the same vertex twice.";
constexpr const char *not_finite = "A simplex page has a coordinate that is not finite.";
constexpr const char *minus_zero = "A simplex page has a coordinate of minus zero.";

} // namespace

template <int D>
void PageView<D>::read_header(const unsigned char *bytes, std::size_t size, int attributes) {
    require(size >= sizeof header_ + checksum_bytes && size <= ABACUS_PAGE_BYTES,
            "A simplex page has an impossible size.");
    std::memcpy(&header_, bytes, sizeof header_);
    require(header_.magic == PageHeader::expected_magic, "A page is not a simplex page.");
    if (header_.version != PageHeader::expected_version)
        throw Error(ABACUS_ERROR_CORRUPTED, "mesh has pages of another format",
                    "A simplex page has format version " + std::to_string(header_.version) +
                        ", not " + std::to_string(PageHeader::expected_version) + ".",
                    "Build the mesh anew with this version of the extension.");
    require(header_.dimension == D && header_.attributes == attributes &&
                (header_.lined & ~PageHeader::has_regions) <= 2 && (D == 2 || header_.lined == 0),
            "A simplex page belongs to another kind of mesh.");
    require(header_.simplices <= block_slots<D> && header_.vertices <= page_vertices<D> &&
                header_.links <= header_.simplices * (D + 1) && header_.codes <= header_.links,
            "A simplex page has impossible counts.");
    require(header_.lower < header_.upper && header_.upper <= end_key &&
                header_.lower.part < key_word_end && header_.upper.part < key_word_end,
            "A simplex page has an impossible interval.");
}

template <int D>
void PageView<D>::read_patches(const unsigned char *&at, const unsigned char *end) {
    const auto n = static_cast<std::size_t>(patches());
    require(static_cast<std::size_t>(end - at) >= n * sizeof patches_[0], wrong_size);
    std::memcpy(patches_.data(), at, n * sizeof patches_[0]);
    at += n * sizeof patches_[0];
    PagePatch<D> before{};
    for (std::size_t i = 0; i < n; before = patches_[i++])
        require(before.named_end <= patches_[i].named_end &&
                    before.fresh_end <= patches_[i].fresh_end,
                "A simplex page has a patch that ends before it begins.");
    require(before.fresh_end == vertices(), "A page has a vertex without simplices.");
}

template <int D>
void PageView<D>::open(const unsigned char *bytes, std::size_t size, int attributes,
                       Checksum checksum) {
    read_header(bytes, size, attributes);
    require(checksum == Checksum::ignore || page_is_sealed(bytes, size),
            "A simplex page has a wrong checksum.");
    const unsigned char *const end = bytes + size - checksum_bytes;
    const unsigned char *at = bytes + sizeof header_;
    const std::size_t v = header_.vertices, l = header_.links, s = header_.simplices;
    read_patches(at, end);
    const auto each_column = [&](auto take) {
        for (Column &axis : axes_) take(axis, v);
        take(ids_, v);
        for (int i = 0; i < attributes; ++i) take(attributes_[i], v);
        take(codes_, std::size_t{header_.codes});
        take(parts_, l);
    };
    const auto fields = [&](std::size_t n, int width) {
        const std::size_t taken = bits_to_bytes(n * width);
        require(static_cast<std::size_t>(end - at) >= taken, wrong_size);
        const BitFields result(at, width);
        at += taken;
        return result;
    };
    each_column(
        [&](Column &column, std::size_t) { require(column.read_head(at, end), wrong_size); });
    steps_ = fields(s, D + 1);
    numbers_ = fields(s == 0 ? 0 : patches_[patches() - 1].named_end, std::bit_width(v));
    each_column([&](Column &column, std::size_t n) {
        require(column.read_deltas(at, end, n), wrong_size);
    });
    has_parts_ = parts_.is_not_zero();
    link_vertices_ = fields(l, std::bit_width(v + header_.codes));
    fixed_ = fields(fixed_width() != 0 ? s : 0, fixed_width());
    if (has_regions())
        require(regions_.read_head(at, end) && regions_.read_deltas(at, end, s), wrong_size);
    require(at == end, wrong_size);
}

template <int D>
void PageView<D>::read(const unsigned char *bytes, std::size_t size, int attributes,
                       Checksum checksum) {
    open(bytes, size, attributes, checksum);
    read_rest();
}

template <int D> void PageView<D>::read_rest() {
    for (int i = 0; i < links(); ++i)
        require(link_vertex(i) < vertices() + header_.codes,
                "A simplex page has a link to a code that it does not have.");
    read_points();
    for (int i = 0; i < patches(); ++i) read_patch(i);
    check_regions();
}

template <int D> void PageView<D>::check_regions() const {
    if (!has_regions()) return;
    require(regions_.is_not_zero(),
            "A simplex page has regions, but none of its simplices is in one.");
    for (int s = 0; s < simplices(); ++s)
        require(regions_[s] <= most_regions && (regions_[s] == no_region || !is_ghost(s)),
                "A simplex page has an impossible number of a region.");
}

template <int D> void PageView<D>::read_points() {
    for (int i = 0; i < D; ++i) {
        std::uint64_t least = ~0ull, greatest = 0;
        bool has_minus_zero = false;
        for (int v = 0; v < vertices(); ++v) {
            const std::uint64_t rank = axes_[i][v];
            least = std::min(least, rank);
            greatest = std::max(greatest, rank);
            has_minus_zero |= rank == ordered(-0.0);
            points_[v][i] = from_ordered(rank);
        }
        constexpr double most = std::numeric_limits<double>::infinity();
        box_[i] = vertices() > 0 ? from_ordered(least) : most;
        box_[D + i] = vertices() > 0 ? from_ordered(greatest) : -most;
        require(vertices() == 0 || (least > ordered(-most) && greatest < ordered(most)),
                not_finite);
        require(!has_minus_zero, minus_zero);
    }
}

template <int D> void PageView<D>::read_point(int vertex) {
    constexpr double most = std::numeric_limits<double>::infinity();
    for (int i = 0; i < D; ++i) {
        const std::uint64_t rank = axes_[i][vertex];
        require(rank > ordered(-most) && rank < ordered(most), not_finite);
        require(rank != ordered(-0.0), minus_zero);
        points_[vertex][i] = from_ordered(rank);
    }
}

template <int D> std::size_t PageView<D>::read_root(int s, std::size_t named, std::size_t fresh) {
    const auto infinity = static_cast<std::size_t>(vertices());
    Lanes &corner = corners_[s];
    corner = Lanes{} + no_vertex;
    for (int i = 0; i <= D; ++i) {
        const auto v = static_cast<std::uint16_t>(numbers_.narrow(named++));
        // The next new vertex has number `fresh`; only the last corner may be at infinity.
        require(v == infinity ? i == D : v <= fresh, unknown_vertex);
        fresh += v == fresh && fresh < infinity;
        for (int j = 0; j < i; ++j) require(corner[j] != v, repeated_vertex);
        corner[i] = v;
    }
    return fresh;
}

template <int D> void PageView<D>::read_patch(int patch) {
    const auto infinity = static_cast<std::size_t>(vertices());
    const BitFields numbers = numbers_; // copied here and below to be in registers
    auto named = static_cast<std::size_t>(named_of(patch).begin);
    auto fresh = static_cast<std::size_t>(fresh_of(patch).begin);
    const auto named_end = static_cast<std::size_t>(named_of(patch).end);
    int s = simplices_of(patch).begin;
    const int patch_end = simplices_of(patch).end;
    PageLink *reached = parents_.data() + s;
    Lanes repeated{}; // where a simplex has its apex twice
    // The next step is as hard to predict as a coin toss. So branches only lead to errors, and
    // errors that do not affect this loop are reported after it.
    while (s < patch_end) {
        std::uint64_t steps = steps_.word(static_cast<std::size_t>(s));
        for (const int end = std::min(s + simplices_at_once, patch_end); s < end; ++s) {
            auto bits = static_cast<unsigned>(steps) & ((2u << D) - 1);
            steps >>= D + 1;
            int facet = D + 1;
            if (parents_.data() + s == reached) [[unlikely]] { // a root
                require(named + D < named_end, wrong_size);
                fresh = read_root(s, named, fresh);
                named += D + 1;
                *reached++ = no_link;
            } else {
                const PageLink parent = parents_[s];
                const std::size_t is_new = bits & 1;
                bits >>= 1;
                const std::size_t number = numbers.narrow(named);
                const std::size_t apex = number ^ ((number ^ fresh) & -is_new);
                const std::size_t known = fresh + is_new;
                const Lanes corners = corners_[page_simplex(parent)];
                const Lanes everywhere = Lanes{} + static_cast<std::uint16_t>(apex);
                repeated |= corners == everywhere;
                facet = page_facet(parent);
                Lanes child = child_across(corners, facet, everywhere);
                if (apex >= known) [[unlikely]] {
                    require(apex == infinity && is_new == 0, unknown_vertex);
                    if (facet != D) child = ghost_across<D>(corners, facet, everywhere);
                    facet = D;
                }
                corners_[s] = child;
                fresh = known;
                named += 1 - is_new;
            }
            const Lanes parents =
                children<D>.facets[facet][bits] + page_link(static_cast<unsigned>(s), 0);
            std::memcpy(reached, &parents, sizeof parents);
            reached += children<D>.count[facet][bits];
            require(named <= named_end, wrong_size);
        }
        require(reached <= parents_.data() + patch_end, "A simplex page has impossible counts.");
    }
    require(std::bit_cast<std::uint64_t>(repeated) == 0, repeated_vertex);
    require(named == named_end && fresh == static_cast<std::size_t>(fresh_of(patch).end),
            "A patch of simplices ends before the next one begins.");
}

template class PageView<2>;
template class PageView<3>;

} // namespace abacus
