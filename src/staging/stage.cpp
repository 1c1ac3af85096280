#include "staging/stage.hpp"

#include "keys/domain_of.hpp"
#include "points/canonical.hpp"
#include "points/vertex_page.hpp"
#include "staging/density.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {
// Vertices of a mesh for each point that is looked up there; a page has a hundred or more.
constexpr double vertices_a_sample = 32;
// Threads that distribute may take this share of the memory beside it.
constexpr std::size_t thread_share = 16;
} // namespace

template <int D>
Stage<D>::Stage(const Host &host, const abacus_facts &facts, std::size_t memory, bool with_rounds)
    : host_(host), stride_(record_words(D, facts.columns.attributes)), memory_(memory),
      with_rounds_(with_rounds), budget_(memory, 8 * stride_, D), pacer_(host),
      sample_(host, budget_.sampled), spread_(host), buffer_(host), room_(budget_.records),
      piles_(host) {
    if (facts.form.has_domain != 0) domain_ = domain_of<D>(facts.form);
    pacer_.begin(ABACUS_PHASE_READING, 0);
}

template <int D> void Stage<D>::add(const std::uint64_t *points, std::size_t count) {
    try {
        while (count > 0) {
            if (buffered_ == room_) spill();
            const std::size_t n = std::min({count, room_ - buffered_, Pacer::stride});
            threads_ ? hand_to_threads(points, n) : fill_buffer(points, n);
            points += n * stride_;
            count -= n;
            pacer_.reached(this->points());
        }
    } catch (...) {
        threads_.reset();
        throw;
    }
}

/// The buffer has room for them.
template <int D> void Stage<D>::fill_buffer(const std::uint64_t *points, std::size_t count) {
    const std::size_t needed = (buffered_ + count) * stride_;
    if (needed > buffer_.capacity())
        buffer_.reserve(std::min(room_ * stride_,
                                 std::max({needed, 2 * buffer_.capacity(), std::size_t{16384}})));
    buffer_.resize(needed);
    copy(points, count, buffer_.data() + buffered_ * stride_);
    buffered_ += count;
}

template <int D>
void Stage<D>::copy(const std::uint64_t *points, std::size_t count, std::uint64_t *to) {
    std::copy_n(points, count * stride_, to);
    for (std::size_t i = 0; i < count; ++i) make_canonical<D>(to + i * stride_);
    spread_.add(to, count, stride_);
    if (!domain_) return;
    const Box<D> inside(domain_->lower(), domain_->upper());
    if (inside.contains(spread_.box().lower) && inside.contains(spread_.box().upper)) return;
    for (std::size_t i = 0; i < count; ++i)
        outside_ += !inside.contains(record_point<D>(to + i * stride_));
}

/// Moves the buffer to spools. From the first time on, the buffer is small.
template <int D> void Stage<D>::spill() {
    for (std::size_t i = 0; i < buffered_; ++i)
        sample_.add(record_point<D>(buffer_.data() + i * stride_));
    if (spilled_ == 0)
        begin_to_distribute();
    else
        look_at_domain();
    for (std::size_t at = 0; at < buffered_;) {
        const std::size_t n = std::min(buffered_ - at, budget_.piece);
        const std::uint64_t *records = buffer_.data() + at * stride_;
        if (distributor_)
            distribute(records, n);
        else
            piles_.back().write(host_, records, n, stride_);
        at += n;
        pacer_.poll();
    }
    spilled_ += buffered_;
    buffered_ = 0;
    if (room_ == budget_.piece) return;
    buffer_.reset();
    room_ = budget_.piece;
}

template <int D> void Stage<D>::look_at_domain() {
    if (distributor_ && !domain_ && !(spread_.box() == distributed_) &&
        !is_distributed_over(domain_so_far()))
        stop_distributing();
}

template <int D> void Stage<D>::hand_to_threads(const std::uint64_t *points, std::size_t count) {
    std::uint64_t *const records = threads_->room(count);
    copy(points, count, records);
    threads_->fill(count);
    for (std::size_t i = 0; i < count; ++i) sample_.add(record_point<D>(records + i * stride_));
    spilled_ += count;
    look_at_domain();
}

template <int D> void Stage<D>::begin_to_distribute() {
    piles_.push_back(Spool());
    if (with_rounds_) {
        rounds_.emplace(buffered_);
        if (rounds_->size() == 1) return;
    }
    const Slice<D> slice{domain_ ? *domain_ : domain_so_far(), rounds_ ? &*rounds_ : nullptr};
    distributor_.emplace(host_, stride_, budget_.piece, slice, sample_,
                         budget_.parts(rounds_ ? rounds_->size() : 0), with_rounds_);
    using Threads = DistributorThreads<D>;
    const std::size_t bytes = Threads::bytes(host_.threads(), stride_, budget_.piece);
    if (host_.threads() == 1 || (bytes > memory_ / thread_share && !host_.has_tiny_intervals()))
        return;
    if (!threads_.emplace(host_, *distributor_, stride_, budget_.piece).begin()) threads_.reset();
}

template <int D> void Stage<D>::distribute(const std::uint64_t *records, std::size_t n) {
    if (threads_) return threads_->add(records, n);
    for (std::size_t i = 0; i < n; ++i) distributor_->add(records + i * stride_);
}

template <int D> Arena<Part<D>> Stage<D>::finish_distributing() {
    try {
        if (threads_) threads_->finish();
        Arena<Part<D>> parts = distributor_->finish();
        threads_.reset();
        return parts;
    } catch (...) {
        threads_.reset();
        throw;
    }
}

template <int D> void Stage<D>::stop_distributing() {
    for (const Part<D> &part : finish_distributing())
        if (part.spool.size() > 0) piles_.push_back(part.spool);
    distributor_.reset();
    piles_.push_back(Spool());
}

template <int D> Domain<D> Stage<D>::domain_so_far() {
    distributed_ = spread_.box();
    const Box<D> box = spread_.choose();
    return domain_around<D>(box.lower, box.upper);
}

template <int D> bool Stage<D>::is_distributed_over(const Domain<D> &domain) const {
    const Domain<D> &distributed = distributor_->slice().domain;
    return distributed.lower() == domain.lower() && distributed.upper() == domain.upper();
}

template <int D> bool Stage<D>::is_distributed_by(const Slice<D> &slice) const {
    const bool has_rounds = distributor_->slice().rounds != nullptr;
    return has_rounds == (slice.rounds != nullptr) && is_distributed_over(slice.domain);
}

template <int D> void Stage<D>::end(abacus_facts &facts) {
    if (facts.form.has_domain != 0)
        facts.census.outside += outside_;
    else if (points() > 0)
        set_domain(facts, spread_.choose());
}

/// Whether the mesh already has vertices where the points are, at least as many as an earlier round
/// would have brought.
template <int D> bool Stage<D>::mesh_stands_in(const abacus_facts &facts, const Domain<D> &domain) {
    if (facts.census.vertices == 0) return false;
    const double wanted = static_cast<double>(points()) * promotion<D>; // vertices
    const auto looked_up = static_cast<std::size_t>(std::ceil(wanted / vertices_a_sample));
    Arena<std::uint64_t> codes(host_);
    const auto take = [&](std::size_t n, auto point) {
        const std::size_t step = std::max<std::size_t>(1, n / looked_up);
        for (std::size_t i = 0; i < n; i += step) codes.push_back(domain.code(point(i)));
    };
    if (spilled_ > 0)
        take(sample_.size(), [&](std::size_t i) { return sample_.begin()[i]; });
    else
        take(buffered_,
             [&](std::size_t i) { return record_point<D>(buffer_.data() + i * stride_); });
    return is_dense(host_, codes, wanted / static_cast<double>(codes.size()));
}

template <int D> void Stage<D>::emit(RecordSink &sink, const abacus_facts &facts, bool reversed) {
    const std::uint64_t n = points();
    if (n == 0) return;
    const Rounds<D> rounds(n, reversed);
    const Domain<D> domain = domain_of<D>(facts.form);
    const bool in_rounds =
        with_rounds_ && rounds.size() > 1 && (reversed || !mesh_stands_in(facts, domain));
    const Slice<D> all{domain, in_rounds ? &rounds : nullptr};
    ExternalSort<D> sort(host_, stride_, budget_, sample_, pacer_, sink);
    if (spilled_ == 0) {
        sort.run(buffer_.data(), n, all);
    } else {
        spill();
        buffer_.reset();
        if (distributor_ && !is_distributed_by(all)) stop_distributing();
        if (distributor_) {
            Arena<Part<D>> parts = finish_distributing();
            // There may be more rounds now than before: they split the part that is promoted most
            // often.
            if (in_rounds) parts[0].slice = all;
            if (reversed) // inside a round the order is the same
                std::stable_sort(parts.begin(), parts.end(),
                                 [](const auto &a, const auto &b) { return a.round > b.round; });
            sort.run(parts);
        } else {
            sort.run(piles_, all);
        }
    }
    sink.finish();
    pacer_.end(n, sink.pages_moved());
}

template <int D> void Stage<D>::drop() {
    if (distributor_) stop_distributing();
    for (Spool &pile : piles_) pile.close(host_);
    piles_.reset();
    buffer_.reset();
    buffered_ = spilled_ = 0;
}

template <int D> void Stage<D>::finish(abacus_facts &facts) {
    const std::uint64_t n = points();
    if (n >= (std::uint64_t{1} << 63) - facts.census.staged)
        throw Error(ABACUS_ERROR_LIMIT, "a mesh cannot have that many points");
    end(facts);
    VertexPageWriter pages(host_, D, facts.columns.attributes, facts.census.staged);
    emit(pages, facts);
    facts.census.staged = pages.next();
}

template class Stage<2>;
template class Stage<3>;

} // namespace abacus
