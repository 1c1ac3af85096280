// Bytes of protocol buffers in the host's memory, as protozero writes them.
#pragma once

#include "host/arena.hpp"

#include <protozero/basic_pbf_writer.hpp>
#include <protozero/buffer_tmpl.hpp>

namespace protozero {

template <> struct buffer_customization<abacus::Arena<char>> {
    using Buffer = abacus::Arena<char>;

    static std::size_t size(const Buffer *buffer) { return buffer->size(); }
    static void append(Buffer *buffer, const char *data, std::size_t count) {
        if (count > 0) std::memcpy(buffer->extend(count), data, count);
    }
    static void append_zeros(Buffer *buffer, std::size_t count) {
        std::memset(buffer->extend(count), 0, count);
    }
    static void resize(Buffer *buffer, std::size_t size) { buffer->resize(size); }
    static void reserve_additional(Buffer *, std::size_t) {} // it grows as it fills
    static void erase_range(Buffer *buffer, std::size_t from, std::size_t to) {
        std::memmove(buffer->data() + from, buffer->data() + to, buffer->size() - to);
        buffer->resize(buffer->size() - (to - from));
    }
    static char *at_pos(Buffer *buffer, std::size_t pos) { return buffer->data() + pos; }
    static void push_back(Buffer *buffer, char byte) { buffer->push_back(byte); }
};

} // namespace protozero

namespace abacus {

using TileBuffer = Arena<char>;
using TileWriter = protozero::basic_pbf_writer<TileBuffer>;

} // namespace abacus
