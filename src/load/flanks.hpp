// Neighbours found by sorting, which brings the two sides of a facet next to each other.
#pragma once

#include "load/records.hpp"
#include "sort/record_sort.hpp"

#include <algorithm>

namespace abacus {

/// The side of facet `facet` of a simplex: what lies next to it is its neighbour. K ids: for
/// simplices D; for ghosts D - 1, the point at infinity being understood as the last.
template <int D, int K> struct Flank {
    std::array<Word, K> ids;
    Word place; // number << 3 | facet << 1 | odd
    Word opposite;
    Key key;
    Point<D> point; // of the opposite vertex

    static constexpr std::size_t words = LoadLayout<D>::flank(K);
    static_assert(sizeof(std::array<Word, K>) + 4 * sizeof(Word) + sizeof(Point<D>) ==
                  words * sizeof(Word));

    bool odd() const { return place & 1; }

    static Flank read(const Word *record) {
        Flank flank;
        std::memcpy(&flank, record, sizeof flank);
        return flank;
    }
    void write(Word *record) const { std::memcpy(record, this, sizeof *this); }

    /// `vertex` gives the record of each vertex of the simplex; those of the facet are the
    /// first K + 1 without `facet`.
    template <class VertexOf>
    Flank(Word number, int facet, const Key &key, VertexOf vertex)
        : key(key), point(point_in<D>(vertex(facet))) {
        bool odd = facet & 1;
        for (int i = 0, n = 0; i <= K; ++i) {
            if (i == facet) continue;
            int at = n++;
            const Word id = vertex(i)[0];
            for (; at > 0 && ids[at - 1] > id; --at, odd = !odd) ids[at] = ids[at - 1];
            ids[at] = id;
        }
        place = number << 3 | static_cast<Word>(facet) << 1 | odd;
        opposite = vertex(facet)[0];
    }

private:
    Flank() = default;
};

/// Adds to `links` that across the facet of `from` lies `to`.
template <int D, int K>
void add_link(RecordSort &links, const Flank<D, K> &from, const Flank<D, K> &to) {
    Word *link = links.add();
    link[0] = from.place >> 1;
    link[1] = to.key.code;
    link[2] = to.key.part;
    link[3] = to.opposite;
    std::memcpy(link + 4, &to.point, sizeof to.point);
}

/// Calls group(flanks, n) for each facet with the first three of its n flanks.
template <int D, int K, class Group> void each_facet(RecordSort &sorted, Group group) {
    const Word *record = sorted.next();
    while (record != nullptr) {
        std::array<Flank<D, K>, 3> flanks{Flank<D, K>::read(record), Flank<D, K>::read(record),
                                          Flank<D, K>::read(record)};
        std::uint64_t n = 1;
        while ((record = sorted.next()) != nullptr &&
               std::equal(flanks[0].ids.begin(), flanks[0].ids.end(), record)) {
            if (n < 3) flanks[n] = Flank<D, K>::read(record);
            ++n;
        }
        group(flanks, n);
    }
}

/// Links in the order of their places, read beside what they belong to.
template <int D> class LinkReader {
public:
    struct Link {
        Key key;
        Word opposite;
        Point<D> point;
    };

    explicit LinkReader(RecordSort &links) : links_(links), at_(links.next()) {}

    /// The link of this facet, null if it has none; facets are asked for in order.
    const Link *of(Word number, int facet) {
        if (at_ == nullptr || at_[0] != (number << 2 | static_cast<Word>(facet))) return nullptr;
        link_ = {{at_[1], at_[2]}, at_[3], point_in<D>(at_ + 3)};
        at_ = links_.next();
        return &link_;
    }

private:
    RecordSort &links_;
    const Word *at_;
    Link link_{};
};

} // namespace abacus
