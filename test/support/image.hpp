// Pictures taken apart: the pixels of a PNG, 0xrrggbb each.
#pragma once

#include "draw/picture.hpp"

#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace abacus {

/// A decoded PNG.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;
    std::vector<int> alphas; // all 255 in a PNG without alpha

    std::uint32_t operator()(int x, int y) const { return pixels[y * width + x]; }
};

inline int red(std::uint32_t rgb) { return rgb >> 16 & 255; }
inline int green(std::uint32_t rgb) { return rgb >> 8 & 255; }
inline int blue(std::uint32_t rgb) { return rgb & 255; }
inline int sum(std::uint32_t rgb) { return red(rgb) + green(rgb) + blue(rgb); }
inline int difference(std::uint32_t a, std::uint32_t b) {
    return std::max(
        {std::abs(red(a) - red(b)), std::abs(green(a) - green(b)), std::abs(blue(a) - blue(b))});
}

inline Image decode(const unsigned char *bytes, std::size_t size) {
    struct Reader {
        const unsigned char *at, *end;
    } reader{bytes, bytes + size};
    cairo_surface_t *surface = cairo_image_surface_create_from_png_stream(
        [](void *closure, unsigned char *bytes, unsigned int size) {
            auto &reader = *static_cast<Reader *>(closure);
            if (size > static_cast<std::size_t>(reader.end - reader.at))
                return CAIRO_STATUS_READ_ERROR;
            std::memcpy(bytes, reader.at, size);
            reader.at += size;
            return CAIRO_STATUS_SUCCESS;
        },
        &reader);
    EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
    Image image;
    image.width = cairo_image_surface_get_width(surface);
    image.height = cairo_image_surface_get_height(surface);
    for (int y = 0; y < image.height; ++y) {
        const auto *row = reinterpret_cast<const std::uint32_t *>(
            cairo_image_surface_get_data(surface) + y * cairo_image_surface_get_stride(surface));
        const bool is_opaque = cairo_image_surface_get_format(surface) == CAIRO_FORMAT_RGB24;
        for (int x = 0; x < image.width; ++x) {
            image.pixels.push_back(row[x] & 0xffffff);
            image.alphas.push_back(is_opaque ? 255 : static_cast<int>(row[x] >> 24));
        }
    }
    cairo_surface_destroy(surface);
    return image;
}
inline Image decode(const Png &png) { return decode(png.data(), png.size()); }

} // namespace abacus
