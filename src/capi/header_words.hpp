// The header row of a mesh as words and names: written, and read without trust.
#pragma once

#include "host/error.hpp"

#include <abacus/mesh_header.h>

#include <bit>
#include <cstdint>
#include <cstring>

namespace abacus {

/// A name of 63 bytes at most, and zeros; then the type of the column, which was 0 before there
/// were types: doubles.
inline constexpr std::size_t type_byte = ABACUS_NAME_BYTES - 1;

class HeaderWriter {
public:
    explicit HeaderWriter(unsigned char *bytes) : begin_(bytes), at_(bytes) {}
    void operator()(std::uint64_t value) {
        for (int i = 0; i < 8; ++i) *at_++ = static_cast<unsigned char>(value >> (8 * i));
    }
    void operator()(std::uint32_t value) { (*this)(std::uint64_t{value}); }
    void operator()(double value) { (*this)(std::bit_cast<std::uint64_t>(value)); }
    void names(const abacus_header &header, unsigned begin, unsigned end) {
        for (unsigned i = begin; i < end; ++i) {
            const std::size_t length = strnlen(header.names[i], ABACUS_NAME_BYTES - 1);
            std::memcpy(at_, header.names[i], length);
            std::memset(at_ + length, 0, ABACUS_NAME_BYTES - length);
            at_[type_byte] = header.types[i];
            at_ += ABACUS_NAME_BYTES;
        }
    }
    std::size_t size() const { return static_cast<std::size_t>(at_ - begin_); }

private:
    unsigned char *begin_, *at_;
};

class HeaderReader {
public:
    HeaderReader(const unsigned char *bytes, std::size_t size) : at_(bytes), end_(bytes + size) {}
    void operator()(std::uint64_t &value) {
        const unsigned char *from = take(8);
        value = 0;
        for (int i = 0; i < 8; ++i) value |= std::uint64_t{from[i]} << (8 * i);
    }
    void operator()(std::uint32_t &value) {
        std::uint64_t wide;
        (*this)(wide);
        if (wide > UINT32_MAX) throw_corrupted("A number in the header is out of range.");
        value = static_cast<std::uint32_t>(wide);
    }
    void operator()(double &value) {
        std::uint64_t bits;
        (*this)(bits);
        value = std::bit_cast<double>(bits);
    }
    const char *text(std::size_t size) { return reinterpret_cast<const char *>(take(size)); }
    std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }

private:
    const unsigned char *take(std::size_t size) {
        if (size > left()) throw_corrupted("The header is too short.");
        at_ += size;
        return at_ - size;
    }

    const unsigned char *at_, *end_;
};

} // namespace abacus
