#include "draw/picture.hpp"

#include <cairo.h>

#include <cstring>
#include <exception>
#include <memory>

namespace abacus {

Png::Png(Png &&other) noexcept
    : host_(other.host_), bytes_(std::exchange(other.bytes_, nullptr)),
      size_(std::exchange(other.size_, 0)), capacity_(std::exchange(other.capacity_, 0)) {}

void Png::append(const unsigned char *bytes, std::size_t size) {
    if (size > capacity_ - size_) {
        const std::size_t capacity = std::max(size_ + size, capacity_ + capacity_ / 2);
        bytes_ = static_cast<unsigned char *>(host_->resize(bytes_, capacity));
        capacity_ = capacity;
    }
    std::memcpy(bytes_ + size_, bytes, size);
    size_ += size;
}

unsigned char *Png::release() {
    size_ = capacity_ = 0;
    return std::exchange(bytes_, nullptr);
}

Picture::Picture(const Host &host, std::int32_t width, std::int32_t height, bool is_transparent)
    : host_(&host), width_(width), height_(height), is_transparent_(is_transparent), pixels_(host) {
    pixels_.resize(static_cast<std::size_t>(width) * height);
}

namespace {

// cairo is written in C: an exception waits here until cairo has returned.
struct Writer {
    const Host *host;
    Png *png;
    std::exception_ptr failure;
};

cairo_status_t write(void *closure, const unsigned char *bytes, unsigned int size) noexcept {
    auto &writer = *static_cast<Writer *>(closure);
    try {
        writer.host->poll();
        writer.png->append(bytes, size);
        return CAIRO_STATUS_SUCCESS;
    } catch (...) {
        writer.failure = std::current_exception();
        return CAIRO_STATUS_WRITE_ERROR;
    }
}

void require(cairo_status_t status) {
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (status != CAIRO_STATUS_SUCCESS)
        throw Error(ABACUS_ERROR_INTERNAL, "could not write the picture",
                    cairo_status_to_string(status));
}

} // namespace

void Picture::SurfaceEnd::operator()(cairo_surface_t *surface) const {
    cairo_surface_destroy(surface);
}

Picture::Surface Picture::surface() {
    static_assert(sizeof(std::uint32_t) == 4);
    Surface surface(cairo_image_surface_create_for_data(
        reinterpret_cast<unsigned char *>(pixels_.data()),
        is_transparent_ ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24, width_, height_, width_ * 4));
    require(cairo_surface_status(surface.get()));
    return surface;
}

void Picture::paint(const std::function<void(cairo_t *)> &draw) {
    const Surface on = surface();
    const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> pen(cairo_create(on.get()),
                                                                 &cairo_destroy);
    require(cairo_status(pen.get()));
    draw(pen.get());
    require(cairo_status(pen.get()));
    cairo_surface_flush(on.get());
}

Png Picture::png() {
    const Surface from = surface();
    Png png(*host_);
    Writer writer{host_, &png, nullptr};
    const cairo_status_t status = cairo_surface_write_to_png_stream(from.get(), &write, &writer);
    if (writer.failure) std::rethrow_exception(writer.failure);
    require(status);
    return png;
}

} // namespace abacus
