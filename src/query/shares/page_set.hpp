// Some pages of a mesh, found by their boxes, and read in key order.
#pragma once

#include "query/pages/page_boxes.hpp"

namespace abacus {

/// A page read by its key. It is a copy, so that its visitor may call the host.
template <int D> class PageRead {
public:
    PageRead(const Host &host, const abacus_facts &facts)
        : host_(host), attributes_(page_attributes(facts.columns)) {}
    PageRead(const Host &host, const abacus_facts &facts, const Key &key) : PageRead(host, facts) {
        read(key);
    }

    void read(const Key &key) {
        host_.poll();
        abacus_page page{};
        if (!host_.find(ABACUS_SIMPLEX_PAGES, key, page)) throw_corrupted(unowned);
        std::memcpy(bytes_, page.bytes, std::min(page.size, sizeof bytes_));
        view_.read(bytes_, page.size, attributes_);
        if (!(view_.lower() == key && key < view_.upper())) throw_corrupted(unowned);
    }
    const PageView<D> &page() const { return view_; }

private:
    static constexpr const char *unowned = "No page owns a part of the curve.";

    const Host &host_;
    const int attributes_;
    PageView<D> view_;
    alignas(8) unsigned char bytes_[ABACUS_PAGE_BYTES];
};

template <int D> class PageSet {
public:
    PageSet(const Host &host, const abacus_facts &facts, const PageBoxes<D> &boxes)
        : host_(host), facts_(facts), boxes_(boxes), has_(host) {
        has_.resize(boxes.size());
        std::fill(has_.begin(), has_.end(), false);
    }

    /// Pages are in the set by their box, which may be around several.
    bool has(std::size_t box) const { return has_[box]; }
    void add(std::size_t box) { has_[box] = true; }
    void add_all(const PageSet &other) {
        for (std::size_t i = 0; i < has_.size(); ++i) has_[i] |= other.has_[i];
    }
    /// Whether it has all pages whose boxes meet this one.
    bool has_all(const Box<D> &box) const {
        return boxes_.numbers(box, [this](std::size_t i) { return has_[i]; });
    }
    /// Adds them.
    void add_around(const Box<D> &box) {
        boxes_.numbers(box, [this](std::size_t i) {
            has_[i] = true;
            return true;
        });
    }

    /// Calls visit(page, box) for all of them. The page is valid during the call.
    template <class Visit> void each(Visit visit) const {
        PageRead<D> page(host_, facts_);
        for (std::size_t i = 0; i < has_.size(); ++i) {
            if (!has_[i]) continue;
            for (Key key = boxes_.begin(i); key < boxes_.begin(i + 1); key = page.page().upper()) {
                page.read(key);
                visit(page.page(), i);
            }
        }
    }

private:
    const Host &host_;
    const abacus_facts &facts_;
    const PageBoxes<D> &boxes_;
    Arena<bool> has_;
};

} // namespace abacus
