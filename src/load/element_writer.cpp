#include "load/element_writer.hpp"

#include <algorithm>

namespace abacus {

template <int D>
ElementWriter<D>::ElementWriter(const Host &host, const LoadLayout<D> &layout,
                                const Domain<D> &domain, int attributes, bool linked_ghosts,
                                bool split_nodes)
    : host_(host), layout_(layout),
      cache_(host_, domain, attributes,
             CacheOptions{.linked_ghosts = linked_ghosts, .split_nodes = split_nodes}),
      least_capacity_(cache_.capacity()), crowded_(host), waiting_(host), loose_(host) {}

template <int D> void ElementWriter<D>::write(RecordSort &elements, Pacer &pacer) {
    find_crowded(elements);
    elements.rewind();
    waiting_.resize((block_slots<D> + 1) * layout_.element);
    std::uint64_t done = 0;
    while (const Word *record = elements.next()) {
        std::copy_n(record, layout_.element, waiting_.data() + count_++ * layout_.element);
        if (count_ > capacity()) {
            write_page(false);
            pacer.reached(done, {0, cache_.counters.stores});
        }
        ++done;
    }
    while (count_ > 0) write_page(true);
}

template <int D> void ElementWriter<D>::find_crowded(RecordSort &elements) {
    std::uint64_t code = 0;
    std::size_t n = 0;
    while (const Word *record = elements.next()) {
        n = record[0] == code ? n + 1 : 1;
        code = record[0];
        if (n == least_capacity_ / 2) crowded_.push_back(code);
    }
}

template <int D> bool ElementWriter<D>::is_crowded(std::uint64_t code) const {
    return std::binary_search(crowded_.begin(), crowded_.end(), code);
}

/// Returns how many of the waiting elements make a page: at most `most`, and not all of them. The
/// cut is at a change of code in the upper half, or else at a change of key.
template <int D> std::size_t ElementWriter<D>::cut(std::size_t most) const {
    for (std::size_t n = most; n > most / 2; --n)
        if (key(n - 1).code != key(n).code) return n;
    for (std::size_t n = most; n > 0; --n)
        if (!(key(n - 1) == key(n))) return n;
    throw Error(ABACUS_ERROR_LIMIT, "too many simplices share one key",
                "More simplices than fit on a page have the same place on the curve.");
}

template <int D> void ElementWriter<D>::write_page(bool last) {
    for (std::size_t most = last ? count_ : capacity();; most = most * 3 / 4) {
        const bool all = last && most == count_;
        const std::size_t n = all ? count_ : cut(std::max<std::size_t>(most, 1));
        Key upper = end_key;
        if (!all) upper = key(n - 1).code != key(n).code ? Key{key(n).code, 0} : key(n);
        loose_.clear();
        for (std::size_t i = 0; i < n; ++i) {
            const Word *record = element(i);
            LooseSimplex<D> simplex;
            for (int k = 0; k <= D; ++k) {
                Key &beyond = simplex.beyond[k];
                beyond = {record[2 + 2 * k], record[3 + 2 * k]};
                if (!is_crowded(beyond.code)) beyond.part = 0;
                simplex.vertex[k] = record + 3 + 2 * (D + 1) + k * layout_.vertex;
            }
            if (record[2 + 2 * (D + 1)] != 0) simplex.vertex[D] = nullptr;
            loose_.push_back(simplex);
        }
        if (!cache_.append(lower_, upper, loose_.data(), loose_.size())) continue;
        lower_ = upper;
        std::copy(element(n), element(count_), waiting_.data());
        count_ -= n;
        return;
    }
}

template class ElementWriter<2>;
template class ElementWriter<3>;

} // namespace abacus
