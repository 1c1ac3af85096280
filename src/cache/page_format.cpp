#include "cache/page_format.hpp"

#include "host/host.hpp"
#include "mesh/simplex.hpp"

#include <cmath>

namespace abacus {

namespace {

void require(bool condition, const char *detail) {
    if (!condition) throw_corrupted(detail);
}

} // namespace

template <int D>
PageView<D> PageView<D>::parse(const unsigned char *bytes, std::size_t size, int attributes) {
    PageHeader header;
    require(size >= sizeof header && size <= ABACUS_PAGE_BYTES,
            "A simplex page has an impossible size.");
    std::memcpy(&header, bytes, sizeof header);
    require(header.magic == PageHeader::expected_magic, "A page is no simplex page.");
    require(header.version == PageHeader::expected_version,
            "A simplex page has an unknown format version.");
    require(header.dimension == D && header.attributes == attributes,
            "A simplex page belongs to another kind of mesh.");
    require((header.flags & ~(PageHeader::wide | PageHeader::long_links)) == 0 &&
                header.simplices <= block_slots<D> && header.border_vertices <= header.vertices &&
                header.links <= header.simplices * (D + 1),
            "A simplex page has impossible counts.");
    require(((header.flags & PageHeader::wide) != 0) == (header.vertices > 255),
            "A simplex page's vertex numbers have the wrong size.");
    require(header.lower < header.upper && header.upper <= end_key &&
                header.lower.part < key_word_end && header.upper.part < key_word_end,
            "A simplex page has an impossible interval.");

    const PageView page(bytes, header);
    require(page.layout_.size == size, "A simplex page's size does not fit its counts.");
    for (int v = 0; v < page.vertices(); ++v)
        for (const double x : page.point(v)) {
            require(std::isfinite(x), "A simplex page has a coordinate that is not finite.");
            require(x != 0 || !std::signbit(x), "A simplex page has a coordinate of minus zero.");
        }
    for (int s = 0; s < page.simplices(); ++s) {
        for (int i = 0; i <= D; ++i) {
            const int corner = page.corner(s, i);
            // Only the last corner may be at infinity.
            require(corner < page.vertices() + (i == D),
                    "A simplex page names a vertex that it does not have.");
            for (int j = 0; j < i; ++j)
                require(page.corner(s, j) != corner, "A simplex has the same vertex twice.");
        }
    }
    return page;
}

template class PageView<2>;
template class PageView<3>;

} // namespace abacus
