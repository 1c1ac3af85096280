#include "staging/vertex_page.hpp"

#include <bit>

namespace abacus {

static_assert(std::endian::native == std::endian::little,
              "pages are little-endian and are read and written as they are in memory");

VertexPageWriter::VertexPageWriter(const Host &host, unsigned dimension, unsigned attributes,
                                   std::uint64_t first)
    : host_(host), dimension_(dimension), attributes_(attributes),
      stride_(record_words(dimension, attributes)),
      capacity_((ABACUS_PAGE_BYTES / 8 - VertexPageHeader::words) / stride_), first_(first) {}

void VertexPageWriter::flush() {
    VertexPageHeader header;
    header.magic = VertexPageHeader::current_magic;
    header.dimension = static_cast<std::uint16_t>(dimension_);
    header.attributes = static_cast<std::uint16_t>(attributes_);
    header.count = count_;
    header.first = first_;
    std::memcpy(page_, &header, sizeof header);
    host_.append_vertices(first_, reinterpret_cast<const unsigned char *>(page_),
                          8 * (VertexPageHeader::words + count_ * stride_));
    first_ += count_;
    count_ = 0;
    ++pages_;
}

namespace {

[[noreturn]] void throw_bad_page(std::uint64_t first, const char *what) {
    throw_corrupted("Vertex page " + std::to_string(first) + " " + what + ".");
}

/// False for infinities, NaN and -0.0, none of which is ever staged.
bool is_canonical(std::uint64_t coordinate) {
    constexpr std::uint64_t exponent = 0x7ffull << 52;
    return (coordinate & exponent) != exponent && coordinate != 1ull << 63;
}

} // namespace

template <int D>
VertexPage<D>::VertexPage(const unsigned char *bytes, std::size_t size, unsigned attributes,
                          std::uint64_t first)
    : stride_(8 * record_words(D, attributes)), first_(first) {
    VertexPageHeader header;
    if (size < sizeof header) throw_bad_page(first, "is too short");
    std::memcpy(&header, bytes, sizeof header);
    if (header.magic != VertexPageHeader::current_magic)
        throw_bad_page(first, "is none of this format version");
    if (header.dimension != D || header.attributes != attributes)
        throw_bad_page(first, "has points of another kind than the mesh");
    if (header.first != first) throw_bad_page(first, "says that it is another one");
    const std::size_t room = size - sizeof header;
    if (header.count == 0 || header.count > room / stride_ || header.count * stride_ != room)
        throw_bad_page(first, "has a size that does not fit its number of points");
    records_ = bytes + sizeof header;
    count_ = header.count;
    for (std::size_t i = 0; i < count_; ++i) {
        for (const double coordinate : point(i))
            if (!is_canonical(std::bit_cast<std::uint64_t>(coordinate)))
                throw_bad_page(first, "has a coordinate that is not a finite number");
    }
}

template class VertexPage<2>;
template class VertexPage<3>;

} // namespace abacus
