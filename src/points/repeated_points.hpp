// The points that equal a vertex of the mesh.
//
// Equal points are one vertex, with the id and attributes of the first. The others are
// kept beside the mesh. So none is lost, each can be traced to its vertex, and the next
// one takes over when the first is deleted.
//
// Their pages partition the order (code, serial number) as simplex pages do that of
// keys: the first page begins at (0, 0), a full one is cut in two. A page is
//
//   header    what is in it
//   records   in order; each a serial number, then the record of the point
//
// One page is held in memory, and written back when another is needed. Points come
// along the curve, so the next one nearly always belongs to the same page.
#pragma once

#include "host/arena.hpp"
#include "keys/key.hpp"
#include "keys/locational_code.hpp"
#include "points/leaving.hpp"
#include "points/record.hpp"

#include <abacus/facts.h>

namespace abacus {

template <int D> class RepeatedPoints {
public:
    RepeatedPoints(const Host &host, const Domain<D> &domain, unsigned attributes);

    /// Adds a point; `serial` is above that of every equal one.
    void add(std::uint64_t serial, const std::uint64_t *record);
    /// Whether there is a point equal to p.
    bool contains(const Point<D> &p);
    /// Offers the points equal to p, until the others make no difference.
    void offer(const Point<D> &p, Leaving &leaving);
    /// Calls change(record, is_changed) for the points equal to p, in their order, until it returns
    /// false. It sets is_changed if it has changed the attributes of the record.
    template <class Change> void change(const Point<D> &p, Change change) {
        find(p, [&](std::uint64_t *entry) {
            bool is_changed = false;
            const bool goes_on = change(entry + 1, is_changed);
            dirty_ |= is_changed;
            return !goes_on;
        });
    }
    /// Takes away those that leave, in the order of their pages; each page is read and
    /// written once. Returns how many there were.
    std::uint64_t take(const Point<D> &p, const Leaving &leaving);
    /// Takes away the first point equal to p; its record, valid until the next call, or
    /// nullptr if there is none.
    const std::uint64_t *take_first(const Point<D> &p);
    /// Takes away all points equal to p; returns how many there were.
    std::uint64_t take_all(const Point<D> &p);
    /// Writes the current page.
    void flush();
    /// All pages have gone, or may lie elsewhere.
    void forget() { at_page_ = dirty_ = false; }

private:
    /// Makes the page that owns the key the current one; false if there are no pages.
    bool go_to(Key key);
    /// Goes on to the page after the current one, if that can have points of this code.
    bool go_on(std::uint64_t code);
    void create_first_page();
    void split();
    void remove(std::size_t i);
    /// The first entry of a point equal to p that matches is on the current page then: its
    /// number, or none.
    static constexpr std::size_t none = ~std::size_t{0};
    template <class Matches> std::size_t find(const Point<D> &p, Matches matches);

    std::size_t count() const { return records_.size() / stride_; }
    std::uint64_t *entry(std::size_t i) { return records_.data() + i * stride_; }
    static const std::uint64_t *record_of(const std::uint64_t *entry) { return entry + 1; }
    Key key_of(const std::uint64_t *entry) const {
        return {domain_.code(record_point<D>(record_of(entry))), entry[0]};
    }
    /// The first entry whose key is not below this one.
    std::size_t lower_bound(const Key &key);

    const Host &host_;
    const Domain<D> domain_;
    const unsigned attributes_;
    const std::size_t stride_;   // words of an entry
    const std::size_t capacity_; // entries of a page
    bool at_page_ = false;       // otherwise what follows says nothing
    bool dirty_ = false;
    Key lower_{}, upper_{};        // interval of the current page
    std::uint64_t location_ = 0;   // where it is stored; 0 = not yet
    Arena<std::uint64_t> records_; // its entries
    Arena<std::uint64_t> taken_;   // the record that was taken last
};

template <int D>
template <class Matches>
std::size_t RepeatedPoints<D>::find(const Point<D> &p, Matches matches) {
    const Key from{domain_.code(p), 0};
    if (!go_to(from)) return none;
    do {
        for (std::size_t i = lower_bound(from); i < count(); ++i) {
            if (record_point<D>(record_of(entry(i))) == p) {
                if (matches(entry(i))) return i;
            } else if (key_of(entry(i)).code != from.code) {
                return none;
            }
        }
        host_.poll();
    } while (go_on(from.code));
    return none;
}

/// Reads the pages one after the other; checks that they are as they should be.
template <int D> class RepeatedReader {
public:
    /// `erase`: pages are erased once they are read.
    RepeatedReader(const Host &host, const Domain<D> &domain, unsigned attributes,
                   bool erase = false)
        : host_(host), domain_(domain), attributes_(attributes), erase_(erase), entries_(host) {}

    /// Goes to the next point; false after the last.
    bool advance();
    const std::uint64_t *record() const { return entries_.data() + at_ + 1; }
    std::uint64_t serial() const { return entries_[at_]; }
    /// Of the current page.
    const Key &key() const { return key_; }

private:
    const Host &host_;
    const Domain<D> domain_;
    const unsigned attributes_;
    const bool erase_;
    bool started_ = false;
    Key key_{};
    Key last_{}; // of the points so far, the greatest key
    Arena<std::uint64_t> entries_;
    std::size_t at_ = 0;
};

extern template class RepeatedPoints<2>;
extern template class RepeatedPoints<3>;
extern template class RepeatedReader<2>;
extern template class RepeatedReader<3>;

} // namespace abacus
