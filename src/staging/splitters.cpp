#include "staging/splitters.hpp"

namespace abacus {
namespace {

struct Place {
    unsigned round;
    std::uint64_t code;
};

bool operator<(const Place &a, const Place &b) {
    return a.round < b.round || (a.round == b.round && a.code < b.code);
}

} // namespace

template <int D>
Splitters<D>::Splitters(const Host &host, const Slice<D> &slice, const Sample<D> &sample,
                        unsigned parts, bool more_rounds)
    : slice_(slice), rounds_(slice.rounds == nullptr ? 1 : slice.rounds->size()), lower_(host),
      cell_shift_(
          std::max<int>(0, std::bit_width(slice.upper - slice.lower) - std::countr_zero(cells))),
      first_in_cell_(host) {
    Arena<Place> places(host);
    places.reserve(sample.size());
    for (const Point<D> &p : sample)
        places.push_back({rounds_ == 1 ? 0 : slice.rounds->round(p), slice.domain.code(p)});
    std::sort(places.begin(), places.end());

    Arena<std::uint64_t> codes(host);
    std::size_t at = 0;
    for (unsigned round = 0; round < rounds_; ++round) {
        codes.clear();
        for (; at < places.size() && places[at].round == round; ++at)
            codes.push_back(places[at].code);
        const double share = static_cast<double>(codes.size()) / static_cast<double>(places.size());
        // A slice of several rounds is at least cut between them.
        const unsigned least = rounds_ == 1 ? 2 : 1;
        const bool whole = more_rounds && round == 0;
        cut_round(codes.data(), codes.size(),
                  whole ? 1 : std::max(least, static_cast<unsigned>(std::ceil(parts * share))));
        first_part_[round + 1] = static_cast<unsigned>(lower_.size());
    }
    list_cells();
}

template <int D> void Splitters<D>::list_cells() {
    std::uint16_t *at = first_in_cell_.extend(rounds_ * (cells + 1));
    for (unsigned round = 0; round < rounds_; ++round) {
        unsigned part = first_part_[round];
        for (unsigned cell = 0; cell <= cells; ++cell) {
            while (part + 1 < first_part_[round + 1] && cell_of(lower_[part + 1] - 1) < cell)
                ++part; // it begins at or before the beginning of the cell
            *at++ = static_cast<std::uint16_t>(part);
        }
    }
}

template <int D>
void Splitters<D>::cut_round(const std::uint64_t *codes, std::size_t n, unsigned parts) {
    std::uint64_t last = slice_.lower;
    lower_.push_back(last);
    if (n == 0) return;
    for (unsigned i = 1; i < parts; ++i) {
        std::uint64_t cut = codes[n * i / parts];
        if (cut == last && cut < slice_.upper) ++cut;
        if (cut <= last) continue;
        lower_.push_back(cut);
        last = cut;
    }
}

template <int D> Slice<D> Splitters<D>::slice(unsigned part) const {
    Slice<D> result{slice_.domain};
    result.lower = lower_[part];
    const bool last_of_round =
        std::find(first_part_, first_part_ + rounds_ + 1, part + 1) != first_part_ + rounds_ + 1;
    result.upper = last_of_round ? slice_.upper : lower_[part + 1] - 1;
    return result;
}

template class Splitters<2>;
template class Splitters<3>;

} // namespace abacus
