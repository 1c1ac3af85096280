// A finished picture and its PNG.
#pragma once

#include "host/arena.hpp"

#include <cstdint>
#include <functional>
#include <memory>

typedef struct _cairo cairo_t;
typedef struct _cairo_surface cairo_surface_t;

namespace abacus {

/// Bytes in the host's memory, freed with the object unless released.
class Png {
public:
    explicit Png(const Host &host) : host_(&host) {}
    Png(Png &&other) noexcept;
    Png(const Png &) = delete;
    Png &operator=(const Png &) = delete;
    ~Png() { host_->release(bytes_); }

    const unsigned char *data() const { return bytes_; }
    std::size_t size() const { return size_; }
    void append(const unsigned char *bytes, std::size_t size);
    /// Hands the bytes over to the caller, who frees them with resize().
    unsigned char *release();

private:
    const Host *host_;
    unsigned char *bytes_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

/// Pixels, 0xrrggbb each, top row first; with transparency 0xaarrggbb, the colours times alpha.
class Picture {
public:
    Picture(const Host &host, std::int32_t width, std::int32_t height, bool is_transparent);

    std::int32_t width() const { return width_; }
    std::int32_t height() const { return height_; }

    std::uint32_t *row(std::int32_t y) {
        return pixels_.data() + static_cast<std::size_t>(y) * width_;
    }
    /// Has something drawn over it.
    void paint(const std::function<void(cairo_t *)> &draw);
    Png png();

private:
    const Host *host_;
    struct SurfaceEnd {
        void operator()(cairo_surface_t *surface) const;
    };
    using Surface = std::unique_ptr<cairo_surface_t, SurfaceEnd>;
    Surface surface();

    std::int32_t width_, height_;
    bool is_transparent_;
    Arena<std::uint32_t> pixels_;
};

} // namespace abacus
