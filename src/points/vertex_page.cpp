#include "points/vertex_page.hpp"

#include <bit>

namespace abacus {

static_assert(VertexPageHeader::words + record_words(ABACUS_MAX_DIMENSION, ABACUS_MAX_ATTRIBUTES) <=
              ABACUS_MAX_PAGE_BYTES / 8);
static_assert(std::endian::native == std::endian::little,
              "pages are little-endian and are read and written as they are in memory");

VertexPageWriter::VertexPageWriter(const Host &host, unsigned dimension, unsigned attributes,
                                   std::uint64_t first)
    : host_(host), dimension_(dimension), attributes_(attributes),
      stride_(record_words(dimension, attributes)),
      capacity_(records_in_page(stride_, VertexPageHeader::words)), first_(first) {}

void VertexPageWriter::flush() {
    VertexPageHeader header;
    header.magic = VertexPageHeader::current_magic;
    header.dimension = static_cast<std::uint16_t>(dimension_);
    header.attributes = static_cast<std::uint16_t>(attributes_);
    header.count = count_;
    header.first = first_;
    std::memcpy(page_, &header, sizeof header);
    abacus_page page{{first_, 0},
                     reinterpret_cast<const unsigned char *>(page_),
                     8 * (VertexPageHeader::words + count_ * stride_),
                     0};
    host_.put(ABACUS_STAGED_PAGES, page);
    first_ += count_;
    count_ = 0;
    ++pages_;
}

namespace {

[[noreturn]] void throw_bad_page(std::uint64_t first, const char *what) {
    throw_corrupted("Vertex page " + std::to_string(first) + " " + what + ".");
}

} // namespace

template <int D>
VertexPage<D>::VertexPage(const std::uint64_t *words, std::size_t size, unsigned attributes,
                          const abacus_key &key)
    : stride_(record_words(D, attributes)), first_(key.code) {
    VertexPageHeader header;
    if (size < sizeof header) throw_bad_page(first_, "is too short");
    std::memcpy(&header, words, sizeof header);
    if (header.magic != VertexPageHeader::current_magic)
        throw_bad_page(first_, "is not of this format version");
    if (header.dimension != D || header.attributes != attributes)
        throw_bad_page(first_, "has points of another kind than the mesh");
    if (header.first != first_ || key.part != 0)
        throw_bad_page(first_, "says that it is another one");
    const std::size_t room = size - sizeof header, bytes = 8 * stride_;
    if (header.count == 0 || header.count > room / bytes || header.count * bytes != room)
        throw_bad_page(first_, "has a size that does not fit its number of points");
    records_ = words + VertexPageHeader::words;
    count_ = header.count;
    for (std::size_t i = 0; i < count_; ++i)
        if (!is_canonical<D>(record_point<D>(record(i))))
            throw_bad_page(first_, "has a coordinate that is not a finite number");
}

template class VertexPage<2>;
template class VertexPage<3>;

} // namespace abacus
