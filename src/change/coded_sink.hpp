// A sink of points that takes their codes along: threads find them while they bring the points into
// order (staging/external_sort.hpp).
#pragma once

#include "change/workspace.hpp"
#include "points/record_sink.hpp"

namespace abacus {

template <int D> class CodedSink : public RecordSink {
public:
    using RecordSink::add;
    bool takes_codes() const final { return true; }
    void find_codes(const std::uint64_t *records, std::size_t n, std::size_t stride,
                    std::uint64_t *codes) const final {
        work_.find_codes(records, n, stride, codes);
    }
    PagesMoved pages_moved() const final { return work_.pages_moved(); }

protected:
    explicit CodedSink(Workspace<D> &work) : work_(work) {}
    ~CodedSink() = default;

    Workspace<D> &work_;
};

} // namespace abacus
