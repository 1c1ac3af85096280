// Takes the points of a stage and inserts them at once.
//
// Until the points span a simplex there is no mesh to insert them into. A few points are held in
// memory until then. If there are more, or others wait already, all go to vertex pages and are
// inserted from there.
#pragma once

#include "change/coded_sink.hpp"
#include "change/inserting.hpp"
#include "points/vertex_page.hpp"

#include <optional>

namespace abacus {

template <int D> class Intake final : public CodedSink<D> {
public:
    /// At most this many points come.
    Intake(Inserting<D> &inserting, std::uint64_t points)
        : CodedSink<D>(inserting.work()), inserting_(inserting), stride_(work_.record_size()),
          held_(work_.host) {
        inserting_.begin(points);
        if (work_.has_waiting() && !work_.has_simplices()) stage();
    }

    void add(const std::uint64_t *record) override {
        if (work_.has_simplices()) {
            inserting_.add(record, 1);
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
        for (; n > 0 && !work_.has_simplices(); --n, records += stride) add(records);
        inserting_.add(records, n);
    }
    void add(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n,
             std::size_t stride) override {
        for (; n > 0 && !work_.has_simplices(); --n, records += stride, ++codes) add(records);
        inserting_.add(records, codes, n);
    }
    void finish() override {
        if (work_.has_simplices()) return inserting_.finish();
        if (!pages_) stage();
        pages_->finish();
        work_.facts->census.staged = pages_->next();
    }

    void meanwhile() override { inserting_.meanwhile(); }
    std::size_t held_back() const override { return inserting_.held_back(); }
    abacus_phase phase() const override { return ABACUS_PHASE_INSERTING; }

private:
    using CodedSink<D>::work_;
    static constexpr std::size_t most_held = 4096;

    std::size_t held() const { return held_.size() / stride_; }
    const std::uint64_t *held(std::size_t i) const { return held_.data() + i * stride_; }

    void start() {
        std::array<const std::uint64_t *, D + 1> corners;
        for (int i = 0; i <= D; ++i) corners[i] = held(first_.number(i));
        inserting_.start(corners);
        for (std::size_t i = 0; i < held(); ++i)
            if (!first_.contains(i)) inserting_.add(held(i), 1);
        held_.reset();
    }
    void stage() {
        pages_.emplace(work_.host, D, work_.attributes, work_.facts->census.staged);
        for (std::size_t i = 0; i < held(); ++i) pages_->add(held(i));
        held_.reset();
    }

    Inserting<D> &inserting_;
    const std::size_t stride_;
    FirstSimplex<D> first_; // of the points held
    Arena<std::uint64_t> held_;
    std::optional<VertexPageWriter> pages_;
};

} // namespace abacus
