#include "attributes/attribute_page.hpp"

#include "mesh/page_format.hpp"

#include <limits>

namespace abacus {

namespace {

void require(bool condition, const char *detail) {
    if (!condition) [[unlikely]]
        throw_corrupted(detail);
}

} // namespace

template <int D>
void AttributePage<D>::read(const unsigned char *bytes, std::size_t size, unsigned group,
                            unsigned columns) {
    constexpr const char *wrong_size = "An attribute page's size does not fit its counts.";
    AttributePageHeader header;
    require(size >= sizeof header + checksum_bytes && size <= ABACUS_PAGE_BYTES,
            "An attribute page has an impossible size.");
    std::memcpy(&header, bytes, sizeof header);
    require(header.magic == AttributePageHeader::expected_magic &&
                header.version == AttributePageHeader::expected_version,
            "A page of attributes is none of this format version.");
    require(header.dimension == D && header.group == group && header.columns == columns &&
                columns <= columns_.size() && header.reserved == 0,
            "An attribute page belongs to another kind of mesh.");
    require(header.vertices <= most_in_attribute_page, "An attribute page has impossible counts.");
    require(page_is_sealed(bytes, size), "An attribute page has a wrong checksum.");
    const unsigned char *at = bytes + sizeof header, *const end = bytes + size - checksum_bytes;
    const auto each_column = [&](auto take) {
        for (Column &axis : axes_) require(take(axis), wrong_size);
        for (unsigned i = 0; i < columns; ++i) require(take(columns_[i]), wrong_size);
    };
    each_column([&](Column &column) { return column.read_head(at, end); });
    each_column([&](Column &column) { return column.read_deltas(at, end, header.vertices); });
    require(at == end, wrong_size);
    vertices_ = header.vertices;
    group_ = group;
    constexpr double most = std::numeric_limits<double>::infinity();
    for (const Column &axis : axes_)
        for (std::size_t v = 0; v < vertices_; ++v)
            require(ordered(-most) < axis[v] && axis[v] < ordered(most) && axis[v] != ordered(-0.0),
                    "An attribute page has a coordinate that is not a finite number.");
}

template <int D>
void AttributePage<D>::keys(const Domain<D> &domain, const Key &lower, const Key &upper,
                            Arena<Key> &keys) const {
    keys.resize(vertices_);
    for (std::size_t v = 0; v < vertices_; ++v) {
        const Point<D> p = point(v);
        keys[v] = in_group(attribute_key<D>(p, domain.code(p)), group_);
    }
    for (std::size_t v = 0; v < vertices_; ++v)
        require(v == 0 ? lower <= keys[v] : keys[v - 1] <= keys[v],
                "An attribute page is not in order.");
    require(vertices_ == 0 || keys[vertices_ - 1] < upper,
            "An attribute page has vertices that another page owns.");
}

const std::uint64_t *AttributePageWriter::gather(const std::uint64_t *rows, std::size_t n,
                                                 unsigned column) {
    column_.resize(n);
    std::uint64_t *const to = column_.data();
    rows += column;
    for (std::size_t i = 0; i < n; ++i) to[i] = rows[i * stride_];
    return to;
}

std::size_t AttributePageWriter::size(const std::uint64_t *rows, std::size_t n) {
    std::size_t size = sizeof(AttributePageHeader) + checksum_bytes;
    for (unsigned i = 0; i < stride_; ++i) size += ColumnPlan(gather(rows, n, i), n).size();
    return size;
}

/// Bytes grow with rows, nearly as a line: a few guesses along it will do.
std::size_t AttributePageWriter::count_that_fits(const std::uint64_t *rows, std::size_t n) {
    const std::size_t all = std::min(n, most_written_in_attribute_page);
    std::size_t fits = 0, too_many = all + 1, fit_size = sizeof(AttributePageHeader);
    std::size_t guess = all;
    constexpr int guesses = 8;
    for (int i = 0; fits + 1 < too_many && (fits == 0 || i < guesses); ++i) {
        const std::size_t bytes = size(rows, guess);
        if (bytes <= ABACUS_PAGE_BYTES) {
            fits = guess;
            fit_size = bytes;
            if (fits == all) break;
        } else {
            too_many = guess;
        }
        // One row takes as much as the others do, up to here.
        const std::size_t each =
            std::max<std::size_t>(1, (bytes - sizeof(AttributePageHeader)) / guess);
        const std::size_t more = (ABACUS_PAGE_BYTES - fit_size) / each;
        guess = std::clamp(fits + more, fits + 1, too_many - 1);
        if (fits > 0 && more == 0) break;
    }
    return fits;
}

void AttributePageWriter::write(const std::uint64_t *rows, std::size_t n) {
    const AttributePageHeader header{AttributePageHeader::expected_magic,
                                     AttributePageHeader::expected_version,
                                     static_cast<std::uint8_t>(dimension_),
                                     static_cast<std::uint16_t>(group_),
                                     static_cast<std::uint16_t>(stride_ - unsigned(dimension_)),
                                     static_cast<std::uint16_t>(n),
                                     0};
    std::memcpy(bytes_, &header, sizeof header);
    unsigned char *at = bytes_ + sizeof header;
    std::array<ColumnPlan, ABACUS_MAX_DIMENSION + AttributeGroups::widest> plans;
    for (unsigned i = 0; i < stride_; ++i) {
        plans[i] = ColumnPlan(gather(rows, n, i), n);
        at = plans[i].write_head(at);
    }
    for (unsigned i = 0; i < stride_; ++i) at = plans[i].write_deltas(gather(rows, n, i), at);
    size_ = static_cast<std::size_t>(at - bytes_) + checksum_bytes;
    seal_page(bytes_, size_);
}

template class AttributePage<2>;
template class AttributePage<3>;

} // namespace abacus
