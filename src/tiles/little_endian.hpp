// Bytes of a file whose numbers have their lowest byte first.
#pragma once

#include "draw/picture.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace abacus {

/// Whether there is a float near a number.
inline bool fits_float(double number) {
    return std::fabs(number) <= std::numeric_limits<float>::max(); // not if it is NaN
}

class LittleEndian {
public:
    explicit LittleEndian(const Host &host) : bytes_(host) {}

    std::size_t size() const { return bytes_.size(); }
    void text(std::string_view text) {
        if (!text.empty())
            bytes_.append(reinterpret_cast<const unsigned char *>(text.data()), text.size());
    }
    void byte(std::uint8_t value) { bytes_.append(&value, 1); }
    void number(std::uint16_t value) { put(value); }
    void number(std::uint32_t value) { put(value); }
    void number(float value) { put(std::bit_cast<std::uint32_t>(value)); }
    void number(double value) { put(std::bit_cast<std::uint64_t>(value)); }
    Png take() { return std::move(bytes_); }

private:
    template <class T> void put(T value) {
        unsigned char bytes[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i)
            bytes[i] = static_cast<unsigned char>(value >> (8 * i));
        bytes_.append(bytes, sizeof bytes);
    }

    Png bytes_;
};

} // namespace abacus
