// The checksum at the end of a page. It is there for what no check can tell: an id, an attribute.
#pragma once

#include <cstddef>
#include <cstdint>

namespace abacus {

inline constexpr std::size_t checksum_bytes = sizeof(std::uint64_t);
/// Writes the checksum into a page that is otherwise complete; `size` includes it.
void seal_page(unsigned char *bytes, std::size_t size);
/// Whether a page of at least checksum_bytes ends with its checksum.
bool page_is_sealed(const unsigned char *bytes, std::size_t size);

} // namespace abacus
