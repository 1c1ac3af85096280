#include "staging/stage.hpp"

#include "cache/domain_of.hpp"
#include "staging/canonical.hpp"
#include "staging/vertex_page.hpp"

#include <algorithm>

namespace abacus {

template <int D>
Stage<D>::Stage(const Host &host, const abacus_header &header, std::size_t memory)
    : host_(host), stride_(record_words(D, header.attributes)),
      budget_(memory, 8 * stride_, D),
      pacer_(host), sample_(host, budget_.sampled), buffer_(host), room_(budget_.records) {
    pacer_.begin(ABACUS_PHASE_READING, 0);
}

template <int D> void Stage<D>::add(const std::uint64_t *points, std::size_t count) {
    while (count > 0) {
        if (buffered_ == room_) spill();
        const std::size_t n = std::min({count, room_ - buffered_, Pacer::stride});
        copy(points, n);
        points += n * stride_;
        count -= n;
        pacer_.reached(this->points());
    }
}

/// Copies records to the buffer, which has room for them, in canonical form.
template <int D> void Stage<D>::copy(const std::uint64_t *points, std::size_t count) {
    const std::size_t needed = (buffered_ + count) * stride_;
    if (needed > buffer_.capacity())
        buffer_.reserve(std::min(room_ * stride_,
                                 std::max({needed, 2 * buffer_.capacity(), std::size_t{16384}})));
    std::uint64_t *to = buffer_.data() + buffered_ * stride_;
    for (std::size_t i = 0; i < count; ++i, points += stride_, to += stride_) {
        for (std::size_t word = 0; word < stride_; ++word) to[word] = points[word];
        make_canonical<D>(to);
        box_.extend(record_point<D>(to));
    }
    buffered_ += count;
}

/// Moves the buffer to the spool. From the first time on, the buffer is small.
template <int D> void Stage<D>::spill() {
    for (std::size_t at = 0; at < buffered_;) {
        const std::size_t n = std::min(buffered_ - at, budget_.piece);
        const std::uint64_t *records = buffer_.data() + at * stride_;
        for (std::size_t i = 0; i < n; ++i) sample_.add(record_point<D>(records + i * stride_));
        spool_.write(host_, records, n, stride_);
        at += n;
        pacer_.poll();
    }
    buffered_ = 0;
    if (room_ == budget_.piece) return;
    buffer_.reset();
    room_ = budget_.piece;
}

template <int D> void Stage<D>::end(abacus_header &header) {
    if (header.has_domain != 0 || points() == 0) return;
    header.has_domain = 1;
    std::copy_n(box_.lower.begin(), D, header.lower);
    std::copy_n(box_.upper.begin(), D, header.upper);
}

template <int D>
void Stage<D>::emit(RecordSink &sink, const abacus_header &header, bool reversed) {
    const std::uint64_t n = points();
    if (n == 0) return;
    const Rounds<D> rounds(n, reversed);
    const Slice<D> all{domain_of<D>(header), rounds.size() > 1 ? &rounds : nullptr};
    ExternalSort<D> sort(host_, stride_, budget_, sample_, pacer_, sink);
    if (spool_.size() == 0) {
        sort.run(buffer_.data(), n, all);
    } else {
        spill();
        buffer_.reset();
        sort.run(spool_, all);
    }
    sink.finish();
    pacer_.end(n, sink.pages_moved());
}

template <int D> void Stage<D>::finish(abacus_header &header) {
    const std::uint64_t n = points();
    if (n >= (std::uint64_t{1} << 63) - header.staged)
        throw Error(ABACUS_ERROR_LIMIT, "a mesh cannot have that many points");
    end(header);
    VertexPageWriter pages(host_, D, header.attributes, header.staged);
    emit(pages, header);
    header.staged = pages.next();
}

template class Stage<2>;
template class Stage<3>;

} // namespace abacus
