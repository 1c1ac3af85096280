#include "delaunay/interval.hpp"

#include "keys/domain_of.hpp"
#include "mesh/counters.hpp"
#include "mesh/page_attributes.hpp"
#include "points/record.hpp"

namespace abacus {

namespace {
constexpr std::size_t report_every = 256; // points
} // namespace

template <int D>
Interval<D>::Interval(const Host &host, const abacus_header &header, std::uint64_t first,
                      std::uint64_t last, std::size_t cache_bytes)
    : host_(host), simplices_(static_cast<std::int64_t>(header.simplices)),
      ghosts_(static_cast<std::int64_t>(header.ghosts)),
      cache_(host, domain_of<D>(header), page_attributes(header),
             CacheOptions{.budget = cache_bytes}),
      mesh_(host, cache_, simplices_, ghosts_), insertion_(mesh_) {
    cache_.keep_within(first, last);
    cache_.expect_last_pass(true);
}

template <int D>
void Interval<D>::insert(const Batch &batch, std::size_t from, std::size_t to, bool counts_crowded,
                         std::atomic<std::uint64_t> &done, Results &results) {
    std::size_t put_off = to; // the last one
    try {
        for (std::size_t i = from; i < to; ++i) {
            if ((i - from) % report_every == 0) {
                host_.poll();
                done.fetch_add(std::min(report_every, to - i), std::memory_order_relaxed);
            }
            const std::uint64_t *const record = batch.record(i);
            const Point<D> p = record_point<D>(record);
            Inserted inserted = Inserted::put_off;
            if (put_off == to || !(record_point<D>(batch.record(put_off)) == p))
                inserted = insertion_.insert_within(p, batch.code(i), record_id(record),
                                                    record_attributes<D>(record));
            switch (inserted) {
            case Inserted::as_vertex:
                ++results.vertices;
                if (counts_crowded) results.crowded += mesh_.is_crowded();
                break;
            case Inserted::is_vertex:
                results.is_vertex.push_back(i);
                break;
            case Inserted::put_off:
                results.put_off.push_back(put_off = i);
                break;
            }
        }
        cache_.flush();
    } catch (const Foreign &) { // from a place where sound pages lead to none
        throw_corrupted("A simplex lies in a page that does not own its key.");
    }
    results.simplices += mesh_.simplices() - simplices_;
    results.ghosts += mesh_.ghosts() - ghosts_;
    results.counters += cache_.counters;
}

template class Interval<2>;
template class Interval<3>;

} // namespace abacus
