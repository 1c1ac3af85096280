// Takes new attributes for vertices of a loaded mesh that is not Delaunay.
//
// Walks need not arrive there, and the simplices around a vertex need not be connected. So where
// attributes are in the simplex pages, one run over the list of vertices (load.hpp) and one over
// all simplex pages serve as many rows as memory has room for. Attributes that are apart are found
// by place, like those of any mesh.
//
// Split nodes share their places: there a row means the vertex with its id, and no other one.
#pragma once

#include "change/workspace.hpp"
#include "points/vertex_page.hpp"
#include "sort/pacer.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <tuple>

namespace abacus {

template <int D> class ListedRevision final : public RecordSink, private OtherValues<D> {
public:
    /// The values of a record are those of the attributes `which`.
    ListedRevision(Workspace<D> &work, std::span<const std::uint32_t> which)
        : work_(work), which_(which), has_split_(work.facts->census.split > 0), wants_(work.host),
          values_(work.host) {}

    void add(const std::uint64_t *record) override {
        const Point<D> p = record_point<D>(record);
        const double *values = record_attributes<D>(record);
        if (work_.apart) {
            if (++done_ % 256 == 0) work_.host.poll();
            if (work_.apart->set(p, work_.domain.code(p), which_, values))
                ++changed_;
            else
                miss(record_id(record), p);
            return;
        }
        wants_.push_back({p, record_id(record), static_cast<std::uint32_t>(wants_.size())});
        std::copy_n(values, which_.size(), values_.extend(which_.size()));
        if (wants_.size() * (sizeof(Want) + 8 * which_.size()) >= work_.cache_bytes) apply();
    }
    void finish() override {
        if (!wants_.empty()) apply();
    }

    abacus_phase phase() const override { return ABACUS_PHASE_FLUSHING; }
    PagesMoved pages_moved() const override { return work_.pages_moved(); }

    /// How many records had a vertex in the mesh.
    std::uint64_t changed() const { return changed_; }
    /// Id and place of the first record that had none.
    const std::optional<std::array<std::uint64_t, 1 + D>> &missing() const { return missing_; }

private:
    struct Want {
        Point<D> point;
        std::int64_t id;
        std::uint32_t order;
        bool is_met = false;
    };

    void miss(std::int64_t id, const Point<D> &p) {
        if (!missing_) fill_record<D>(missing_.emplace().data(), id, p, nullptr, 0);
    }
    /// The id, where it decides which vertex is meant.
    std::int64_t deciding(std::int64_t id) const { return has_split_ ? id : 0; }

    /// The wants for a vertex; of several the last one counts.
    std::span<Want> wants_for(const Point<D> &p, std::int64_t id) {
        const auto before = [this](const Want &a, const Want &b) {
            return std::pair(a.point, deciding(a.id)) < std::pair(b.point, deciding(b.id));
        };
        const auto [first, last] =
            std::equal_range(wants_.begin(), wants_.end(), Want{p, id, 0}, before);
        return {first, last};
    }
    const double *values(const Want &want) const {
        return values_.data() + want.order * which_.size();
    }

    void apply() {
        std::sort(wants_.begin(), wants_.end(), [this](const Want &a, const Want &b) {
            return std::tuple(a.point, deciding(a.id), a.order) <
                   std::tuple(b.point, deciding(b.id), b.order);
        });
        change_list();
        std::uint64_t met = 0;
        const Want *first_missing = nullptr;
        for (const Want &want : wants_)
            if (want.is_met)
                ++met;
            else if (first_missing == nullptr || want.order < first_missing->order)
                first_missing = &want;
        if (first_missing != nullptr) miss(first_missing->id, first_missing->point);
        if (met > 0) change_simplices();
        changed_ += met;
        wants_.clear();
        values_.clear();
    }

    /// The pages of the list are written in place.
    void change_list() {
        const std::size_t stride = work_.record_size();
        std::uint64_t words[ABACUS_MAX_PAGE_BYTES / 8];
        for (std::uint64_t next = 0; next < work_.facts->census.staged;) {
            work_.host.poll();
            abacus_page page;
            if (!work_.host.find(ABACUS_STAGED_PAGES, {next, 0}, page) || page.size > sizeof words)
                throw_corrupted("A vertex page is missing or too large.");
            std::memcpy(words, page.bytes, page.size);
            const std::size_t count =
                VertexPage<D>(words, page.size, work_.attributes, page.key).size();
            if (page.key.code != next) throw_corrupted("A vertex page is missing.");
            next += count;
            std::uint64_t *record = words + VertexPageHeader::words;
            bool is_changed = false;
            for (std::size_t i = 0; i < count; ++i, record += stride) {
                const std::span<Want> wants = wants_for(record_point<D>(record), record_id(record));
                if (wants.empty()) continue;
                for (Want &want : wants) want.is_met = true;
                for (std::size_t k = 0; k < which_.size(); ++k)
                    record[1 + D + which_[k]] =
                        std::bit_cast<std::uint64_t>(values(wants.back())[k]);
                is_changed = true;
            }
            if (!is_changed) continue;
            page.bytes = reinterpret_cast<const unsigned char *>(words);
            work_.host.put(ABACUS_STAGED_PAGES, page);
        }
    }

    /// Pages are changed as they are loaded.
    void change_simplices() {
        Cache<D> cache(work_.host, work_.domain, static_cast<int>(work_.attributes),
                       work_.pass_options({}));
        cache.give_other_values(*this);
        Pacer pacer(work_.host);
        pacer.begin(ABACUS_PHASE_FLUSHING,
                    work_.facts->census.simplices + work_.facts->census.ghosts);
        std::uint64_t done = 0;
        for (Key page = first_key; page < end_key;) {
            cache.trim();
            pacer.reached(done);
            page = cache.visit(page, [&](Handle) { ++done; });
        }
        cache.flush();
        work_.core->cache.counters += cache.counters;
    }
    bool give(const Point<D> &p, std::int64_t id, double *now) override {
        const std::span<const Want> wants = wants_for(p, id);
        if (wants.empty()) return false;
        for (std::size_t k = 0; k < which_.size(); ++k) now[which_[k]] = values(wants.back())[k];
        return true;
    }

    Workspace<D> &work_;
    const std::span<const std::uint32_t> which_;
    const bool has_split_;
    Arena<Want> wants_; // by place
    Arena<double> values_;
    std::optional<std::array<std::uint64_t, 1 + D>> missing_;
    std::uint64_t changed_ = 0;
    std::uint64_t done_ = 0;
};

} // namespace abacus
