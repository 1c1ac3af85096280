// Points that wait, in insertion order, read page by page.
#pragma once

#include "points/vertex_page.hpp"

#include <optional>

namespace abacus {

template <int D> class VertexReader {
public:
    /// Reads from sequence number `from` up to, not including, `to`. `erase`: pages are
    /// erased when their last point has been left behind.
    VertexReader(const Host &host, unsigned attributes, std::uint64_t from, std::uint64_t to,
                 bool erase = false)
        : host_(host), attributes_(attributes), next_(from), to_(to), erase_(erase) {}

    /// Goes to the next point; false after the last.
    bool advance() {
        if (page_ && next_ >= page_->first() + page_->size()) leave();
        if (next_ >= to_) return false;
        if (!page_) load();
        at_ = next_ - page_->first();
        ++next_;
        return true;
    }

    std::uint64_t sequence() const { return next_ - 1; }
    /// Of the page with the current point.
    const abacus_key &page_key() const { return key_; }
    /// Of the current point; valid until the next advance(). No coordinate is -0.0.
    const std::uint64_t *record() const { return page_->record(at_); }
    std::int64_t id() const { return record_id(record()); }
    Point<D> point() const { return record_point<D>(record()); }
    const double *attributes() const { return record_attributes<D>(record()); }

private:
    void load() {
        host_.poll();
        abacus_page stored;
        if (!host_.find(ABACUS_STAGED_PAGES, {next_, 0}, stored) || stored.size > sizeof copy_)
            throw_corrupted("A vertex page is missing or too large.");
        std::memcpy(copy_, stored.bytes, stored.size); // not valid beyond the next call
        page_.emplace(copy_, stored.size, attributes_, stored.key);
        key_ = stored.key;
        location_ = stored.location;
        if (next_ < page_->first() || next_ >= page_->first() + page_->size())
            throw_corrupted("A vertex page is missing.");
    }
    void leave() {
        if (erase_) host_.erase(ABACUS_STAGED_PAGES, {{page_->first(), 0}, nullptr, 0, location_});
        page_.reset();
    }

    const Host &host_;
    unsigned attributes_;
    std::uint64_t next_, to_;
    bool erase_;
    std::size_t at_ = 0;
    abacus_key key_{};           // of the page
    std::uint64_t location_ = 0; // of the page
    std::optional<VertexPage<D>> page_;
    std::uint64_t copy_[ABACUS_MAX_PAGE_BYTES / 8];
};

} // namespace abacus
