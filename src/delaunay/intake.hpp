// Takes the points of a stage and inserts them at once.
//
// Until the points span a simplex there is no mesh to insert them into. A few points are held in
// memory until then. If there are more, or others wait already, all go to vertex pages and are
// inserted from there.
#pragma once

#include "delaunay/build.hpp"
#include "points/vertex_page.hpp"

#include <optional>

namespace abacus {

template <int D> class Build<D>::Intake final : public RecordSink {
public:
    /// At most this many points come.
    Intake(Build &build, std::uint64_t points)
        : build_(build), stride_(record_words(D, build.attributes_)), held_(build.host_) {
        build_.begin_to_gather(points, stride_);
        if (build_.has_waiting() && !build_.has_simplices()) stage();
    }

    void add(const std::uint64_t *record) override {
        if (build_.has_simplices()) {
            build_.add(record, 1);
        } else if (pages_) {
            pages_->add(record);
        } else {
            first_.offer(record_point<D>(record), held());
            std::copy_n(record, stride_, held_.extend(stride_));
            if (first_.is_complete())
                start();
            else if (held() == most_held)
                stage();
        }
    }
    void add(const std::uint64_t *records, std::size_t n, std::size_t stride) override {
        for (; n > 0 && !build_.has_simplices(); --n, records += stride) add(records);
        build_.add(records, n);
    }
    void finish() override {
        if (build_.has_simplices()) return build_.change_gathered();
        if (!pages_) stage();
        pages_->finish();
        build_.facts_->census.staged = pages_->next();
    }

    std::size_t held_back() const override { return build_.gathered_.size(); }
    abacus_phase phase() const override { return ABACUS_PHASE_INSERTING; }
    PagesMoved pages_moved() const override {
        return {build_.core_->cache.counters.loads, build_.core_->cache.counters.stores};
    }

private:
    static constexpr std::size_t most_held = 4096;

    std::size_t held() const { return held_.size() / stride_; }
    const std::uint64_t *held(std::size_t i) const { return held_.data() + i * stride_; }

    void start() {
        std::array<VertexIndex, D + 1> vertices;
        for (int i = 0; i <= D; ++i) vertices[i] = build_.create(held(first_.number(i)));
        build_.start(vertices);
        for (std::size_t i = 0; i < held(); ++i)
            if (!first_.contains(i)) build_.add(held(i), 1);
        held_.reset();
    }
    void stage() {
        pages_.emplace(build_.host_, D, build_.attributes_, build_.facts_->census.staged);
        for (std::size_t i = 0; i < held(); ++i) pages_->add(held(i));
        held_.reset();
    }

    Build &build_;
    const std::size_t stride_;
    FirstSimplex<D> first_; // of the points held
    Arena<std::uint64_t> held_;
    std::optional<VertexPageWriter> pages_;
};

} // namespace abacus
