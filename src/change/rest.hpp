// The points that are left when many leave, to be triangulated again. The places of the points that
// leave are noted first; the vertices follow when all places are known. Both go into one stage,
// which brings points of one place together. A vertex that comes in a pair does not belong to the
// rest. So the rest may be larger than memory, like any points to be triangulated.
#pragma once

#include "points/record.hpp"
#include "points/record_sink.hpp"
#include "staging/stage.hpp"

#include <abacus/facts.h>

#include <algorithm>
#include <array>
#include <optional>

namespace abacus {

template <int D> class Rest {
public:
    /// Of a mesh of which these are the facts.
    Rest(const Host &host, const abacus_facts &facts, std::size_t memory)
        : host_(host), facts_(without_vertices(facts)), points_(host, facts_, memory) {}

    /// The vertex at p leaves.
    void leave_out(const Point<D> &p) {
        std::array<std::uint64_t, record_words(D, ABACUS_MAX_ATTRIBUTES)> record;
        std::fill_n(record.data(), record_words(D, facts_.columns.attributes), 0);
        fill_record<D>(record.data(), 0, p, nullptr, 0);
        points_.add(record.data(), 1);
        last_ = p;
    }
    /// Whether p is the last one that left.
    bool has_left_out(const Point<D> &p) const { return last_ == p; }
    /// Adds a vertex of the mesh; after all that leave.
    void add(const std::uint64_t *record) { points_.add(record, 1); }
    /// Passes the rest on.
    void emit(RecordSink &sink) {
        Unpaired unpaired(host_, sink, record_words(D, facts_.columns.attributes));
        points_.emit(unpaired, facts_);
    }

private:
    /// Passes on records that have a place of their own.
    class Unpaired final : public RecordSink {
    public:
        Unpaired(const Host &host, RecordSink &sink, std::size_t stride)
            : sink_(sink), stride_(stride), held_(host) {}

        void add(const std::uint64_t *record) override {
            if (held() > 0 && record_point<D>(last()) == record_point<D>(record)) {
                held_.resize(held_.size() - stride_);
                return;
            }
            if (held() == most) pass_on();
            std::copy_n(record, stride_, held_.extend(stride_));
        }
        void finish() override {
            pass_on();
            sink_.finish();
        }
        void meanwhile() override { sink_.meanwhile(); }
        std::size_t held_back() const override { return held() + sink_.held_back(); }
        abacus_phase phase() const override { return sink_.phase(); }
        PagesMoved pages_moved() const override { return sink_.pages_moved(); }

    private:
        static constexpr std::size_t most = 256;

        std::size_t held() const { return held_.size() / stride_; }
        const std::uint64_t *last() const { return held_.end() - stride_; }
        void pass_on() {
            if (held() > 0) sink_.add(held_.data(), held(), stride_);
            held_.clear();
        }

        RecordSink &sink_;
        const std::size_t stride_;
        Arena<std::uint64_t> held_;
    };

    /// None are where the points go.
    static abacus_facts without_vertices(abacus_facts facts) {
        facts.census.vertices = 0;
        return facts;
    }

    const Host &host_;
    const abacus_facts facts_;
    Stage<D> points_;
    std::optional<Point<D>> last_;
};

} // namespace abacus
