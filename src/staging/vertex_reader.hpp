// Staged points in insertion order, read page by page.
#pragma once

#include "staging/vertex_page.hpp"

#include <optional>

namespace abacus {

template <int D> class VertexReader {
public:
    /// Reads from sequence number `from` up to, not including, `to`.
    VertexReader(const Host &host, unsigned attributes, std::uint64_t from, std::uint64_t to)
        : host_(host), attributes_(attributes), next_(from), to_(to) {}

    /// Goes to the next point; false after the last.
    bool advance() {
        if (next_ >= to_) return false;
        if (!page_ || next_ >= page_->first() + page_->size()) load();
        at_ = next_ - page_->first();
        ++next_;
        return true;
    }

    std::uint64_t sequence() const { return next_ - 1; }
    std::int64_t id() const { return page_->id(at_); }
    Point<D> point() const {
        Point<D> p = page_->point(at_);
        for (double &x : p) x += 0.0; // -0.0 is +0.0
        return p;
    }
    void attributes(double *to) const { page_->attributes(at_, to); }

private:
    void load() {
        host_.poll();
        std::uint64_t first;
        const unsigned char *bytes;
        std::size_t size;
        if (!host_.read_vertices(next_, first, bytes, size) || size > sizeof copy_)
            throw_corrupted("A vertex page is missing or too large.");
        std::memcpy(copy_, bytes, size); // the host's bytes do not outlive its next call
        page_.emplace(copy_, size, attributes_, first);
        if (next_ < first || next_ >= first + page_->size())
            throw_corrupted("A vertex page is missing.");
    }

    const Host &host_;
    unsigned attributes_;
    std::uint64_t next_, to_;
    std::size_t at_ = 0;
    std::optional<VertexPage<D>> page_;
    alignas(8) unsigned char copy_[ABACUS_PAGE_BYTES];
};

} // namespace abacus
