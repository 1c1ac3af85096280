#include "blocks/page_seal.hpp"

#include <cstring>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace abacus {

void seal_page(unsigned char *bytes, std::size_t size) {
    const std::uint64_t checksum = XXH3_64bits(bytes, size - checksum_bytes);
    std::memcpy(bytes + size - checksum_bytes, &checksum, sizeof checksum);
}

bool page_is_sealed(const unsigned char *bytes, std::size_t size) {
    std::uint64_t stored;
    std::memcpy(&stored, bytes + size - checksum_bytes, sizeof stored);
    return stored == XXH3_64bits(bytes, size - checksum_bytes);
}

} // namespace abacus
