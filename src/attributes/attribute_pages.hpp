// The attributes of a mesh that is changed: attribute_page.hpp tells how they are stored.
//
// Of each group one page is held in memory, and written back when another one is needed. Points
// come and go along the curve, so the next one nearly always belongs to the same page, and a round
// of insertions writes each page once. A page that gets too many owners is cut where it is full:
// what lies before the owner that has come is finished in this round, and leaves full pages
// behind. A page that loses most of its owners takes in the next one.
#pragma once

#include "attributes/attribute_page.hpp"
#include "host/memory_resource.hpp"

#include <abacus/mesh_counters.h>

#include <deque>
#include <span>
#include <utility>

namespace abacus {

/// Those of a group; K points name an owner (attribute_key.hpp).
template <int D, int K = 1> class AttributeGroup {
public:
    using Name = Owner<D, K>;

    /// Holds about so many bytes before pages are cut. Counts pages that it moves in `counters`.
    AttributeGroup(const Host &host, const Domain<D> &domain, unsigned group, unsigned columns,
                   std::size_t held_bytes, abacus_counters &counters);

    /// Sets what the owner has. `key` is its attribute_key().
    void put(const Key &key, const Name &owner, const double *values);
    /// Sets the attributes `which` of the owner, all of this group, whose first one is `first`;
    /// false if there is no such owner.
    bool set(const Key &key, const Name &owner, unsigned first,
             std::span<const std::uint32_t> which, const double *values);
    /// Takes it away; false if there is no such owner.
    bool erase(const Key &key, const Name &owner);
    /// Reads it; false if there is no such owner.
    bool get(const Key &key, const Name &owner, double *values);
    bool contains(const Key &key, const Name &owner);
    /// Writes the current page.
    void flush();
    /// All pages have gone, or may lie elsewhere.
    void forget() { at_page_ = dirty_ = shrunk_ = grown_ = false; }

private:
    static constexpr std::size_t none = ~std::size_t{0};
    /// Makes the page that owns the key the current one.
    void go_to(const Key &key);
    Key end_of_page(const Key &lower);
    void find_end();
    void append(const abacus_page &page, const Key &upper);
    void assign(std::uint64_t &to, double value);
    std::size_t lower_bound(const Key &key) const;
    std::size_t find(const Key &key, const Name &owner) const;
    std::size_t insert(const Key &key);
    void remove_rows(std::size_t begin, std::size_t end);
    /// Writes full pages of what lies before the row; whether there were any.
    bool write_before(std::size_t row);
    bool goes_on_to(const Key &key);
    /// How many of the first n rows go to the next page.
    std::size_t rows_of_page(std::size_t n);
    /// Writes the first n rows, and goes on with the others as a page that has not been stored.
    void write_rows(std::size_t n);
    void absorb_next();

    std::size_t count() const { return keys_.size(); }
    std::uint64_t *row(std::size_t i) { return rows_.data() + i * stride_; }
    const std::uint64_t *row(std::size_t i) const { return rows_.data() + i * stride_; }

    const Host &host_;
    const Domain<D> domain_;
    const unsigned group_, columns_;
    const std::size_t stride_; // words of a row
    const std::size_t held_bytes_;
    abacus_counters &counters_;
    AttributePageWriter writer_;
    AttributePage<D, K> view_;
    bool at_page_ = false;       // otherwise what follows says nothing
    bool dirty_ = false;         // since it was stored
    bool shrunk_ = false;        // has lost rows
    bool grown_ = false;         // has left full pages behind
    Key lower_{}, upper_{};      // interval of the current page
    std::uint64_t location_ = 0; // where it is stored; 0 = not yet
    std::size_t most_ = 0;       // rows held
    Arena<Key> keys_, page_keys_;
    Arena<std::uint64_t> rows_; // ranks: coordinates, attributes
};

/// Those of all owners of a kind.
template <int D, int K = 1> class AttributePages {
public:
    using Name = Owner<D, K>;

    /// In groups from `first` on.
    AttributePages(const Host &host, const Domain<D> &domain, unsigned attributes,
                   unsigned first = first_group<K>);

    /// Sets the attributes of an owner, which has this code.
    void put(const Name &owner, std::uint64_t code, const double *values);
    /// The same for an owner that has none yet; whether it had none.
    bool put_new(const Name &owner, std::uint64_t code, const double *values);
    /// Sets some attributes of an owner, which are `which`; false if it has none. Reads and writes
    /// only pages that have one of these.
    bool set(const Name &owner, std::uint64_t code, std::span<const std::uint32_t> which,
             const double *values);
    /// Takes them away; false if there are none.
    bool erase(const Name &owner, std::uint64_t code);
    /// The same of a vertex; throws an Error (corrupted) if there are none.
    void drop(const Name &owner, std::uint64_t code) {
        if (!erase(owner, code)) throw_no_attributes<D, K>();
    }
    /// Throws an Error (corrupted) if the owner has none.
    void get(const Name &owner, std::uint64_t code, double *values);
    /// Whether the owner has any; reads a page of the first group.
    bool contains(const Name &owner, std::uint64_t code);
    void flush() {
        for (AttributeGroup<D, K> &group : pages_) group.flush();
    }
    void forget() {
        for (AttributeGroup<D, K> &group : pages_) group.forget();
    }
    /// Pages moved since it was last asked; nothing else is counted.
    abacus_counters take_counters() { return std::exchange(counters_, {}); }

private:
    /// Rows that are held: of a group, and about as much of many groups together.
    static constexpr std::size_t most_held = std::size_t{64} << 10,
                                 least_held = std::size_t{16} << 10,
                                 held_together = std::size_t{256} << 10;

    const AttributeGroups groups_;
    abacus_counters counters_{};
    HostMemory memory_;
    std::pmr::deque<AttributeGroup<D, K>> pages_; // of each group
};

extern template class AttributePages<2>;
extern template class AttributePages<3>;
extern template class AttributePages<2, 3>;
extern template class AttributePages<3, 4>;

} // namespace abacus
