// Writes leaves that come along the curve as full pages: of a new octree, or in place of a page.
#pragma once

#include "blocks/page_capacity.hpp"
#include "host/host.hpp"
#include "octree/octree_cache.hpp"

#include <algorithm>

namespace abacus {

template <int D> class LeafWriter {
public:
    LeafWriter(const Host &host, const abacus_facts &facts)
        : host_(host), attributes_(facts.columns.attributes),
          capacity_(octant_pages(static_cast<int>(facts.columns.attributes))),
          writer_(host, static_cast<int>(facts.columns.attributes)), octants_(host), values_(host) {
    }

    /// From here on leaves come whose pages begin there. The first takes the place of the one
    /// stored at `location`, unless that is 0.
    void begin(std::uint64_t lower, std::uint64_t location) {
        lower_ = lower;
        location_ = location;
        changed_ = false;
        octants_.clear();
        values_.clear();
    }
    /// `is_new`: not one of the page in whose place it comes. Without any that page stays.
    void add(const Octant<D> &octant, const double *values, bool is_new) {
        changed_ = changed_ || is_new;
        counters_.created += is_new;
        // Two pages are kept, so that the last is not a crumb.
        while (changed_ && octants_.size() >= 2 * static_cast<std::size_t>(capacity_.usual()))
            put_first(capacity_.usual());
        octants_.push_back(octant);
        std::copy_n(values, attributes_, values_.extend(attributes_));
    }
    /// No more leaves come before there.
    void end(std::uint64_t upper) {
        if (!changed_) return;
        while (octants_.size() > capacity_.usual())
            put_first(std::min<std::size_t>(capacity_.usual(), (octants_.size() + 1) / 2));
        put(0, octants_.size(), upper);
    }

    /// Pages and leaves that were written.
    const abacus_counters &counters() const { return counters_; }

private:
    void put(std::size_t from, std::size_t to, std::uint64_t upper) {
        const bool fits = writer_.write(
            lower_, upper, to - from, [&](std::size_t i) { return octants_[from + i]; },
            [&](std::size_t i) { return values_.data() + (from + i) * attributes_; });
        capacity_.learn(static_cast<std::uint32_t>(to - from), writer_.size());
        if (!fits) {
            const std::size_t middle = from + (to - from) / 2;
            put(from, middle, octants_[middle].code);
            put(middle, to, upper);
            return;
        }
        abacus_page page{{lower_, 0}, writer_.bytes(), writer_.size(), location_};
        host_.put(ABACUS_OCTANT_PAGES, page);
        host_.poll();
        ++counters_.stores;
        counters_.rewrites += location_ != 0;
        counters_.bytes_written += page.size;
        lower_ = upper;
        location_ = 0;
    }
    /// Writes so many of the leaves, and forgets them.
    void put_first(std::size_t n) {
        put(0, n, octants_[n].code);
        std::copy(octants_.begin() + n, octants_.end(), octants_.begin());
        octants_.resize(octants_.size() - n);
        std::copy(values_.begin() + n * attributes_, values_.end(), values_.begin());
        values_.resize(values_.size() - n * attributes_);
    }

    const Host &host_;
    std::size_t attributes_;
    PageCapacity capacity_;
    OctantPageWriter<D> writer_;
    Arena<Octant<D>> octants_;
    Arena<double> values_;
    std::uint64_t lower_ = 0, location_ = 0;
    bool changed_ = false;
    abacus_counters counters_{};
};

} // namespace abacus
