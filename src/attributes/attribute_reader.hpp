// Attributes by owner: pages of attributes, read and kept.
//
// Who asks for one owner asks for its neighbours soon, which are near on the curve. So a few pages
// are kept, and one that has not been used for long makes room for another one. Each vertex that is
// asked for has attributes; so the page is known to be the right one if its last vertex does not
// come before, and nothing has to be known of the page that follows. Most simplices may have none;
// so of their pages it is known where they end.
#pragma once

#include "attributes/attribute_page.hpp"
#include "host/memory_resource.hpp"

#include <abacus/facts.h>

#include <deque>
#include <map>

namespace abacus {

template <int D, int K = 1> class AttributeReader {
public:
    using Name = Owner<D, K>;

    /// Keeps pages in about so many bytes, but one of each group at least.
    AttributeReader(const Host &host, const Domain<D> &domain, unsigned attributes,
                    std::size_t bytes, unsigned first = first_group<K>);
    AttributeReader(const AttributeReader &) = delete;
    AttributeReader &operator=(const AttributeReader &) = delete;

    /// An attribute of an owner. Throws an Error (corrupted) if it has none.
    double value(const Name &owner, unsigned attribute);
    /// All of them.
    void values(const Name &owner, double *values);
    /// The same; false, and all of them NULL, if the owner has none.
    bool values_if_any(const Name &owner, double *values);
    /// Whether all groups have the owner.
    bool contains(const Name &owner);

    std::uint64_t pages_read() const { return pages_read_; }

private:
    struct Held {
        explicit Held(const Memory &memory) : keys(memory) {}

        Key lower{}, last{};  ///< holds what is between; is in by_key_, unless it holds nothing
        bool is_used = false; ///< since the hand came by
        AttributePage<D, K> page;
        Arena<Key> keys;
        alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes;
    };
    /// Where an owner is found in a group.
    struct Found {
        Held *held;
        std::size_t row;
    };

    /// The owner that is asked for from now on.
    void begin(const Name &owner);
    /// In a group; `held` is null if it is not there.
    Found find(unsigned group);
    Held *page(const Key &key);
    /// A place for another page: a clock's hand finds it (Corbató, 1968).
    Held &make_room();
    void read(const Key &key, Held &held);
    unsigned columns(unsigned group) const { return groups_.columns(group - first_); }

    const Host &host_;
    const Domain<D> domain_;
    const AttributeGroups groups_;
    const unsigned first_; // of the groups
    HostMemory memory_;
    const std::size_t most_held_;
    std::pmr::deque<Held> pages_;
    std::pmr::map<Key, Held *, KeyBefore> by_key_; // those that hold a page, by its lower key
    std::size_t hand_ = 0;                         // the next of pages_ that may have to go
    std::uint64_t pages_read_ = 0;
    // The owner asked for last, and where it was found; many attributes of it may be asked for.
    Name owner_{};
    Key key_{};
    bool is_asked_ = false;
    unsigned found_group_ = 0;
    Found found_{};
};

extern template class AttributeReader<2>;
extern template class AttributeReader<3>;
extern template class AttributeReader<2, 3>;
extern template class AttributeReader<3, 4>;

/// All attribute pages of a kind, one after the other; checks that they are as they should be.
template <int D, int K = 1> class AttributeScan {
public:
    AttributeScan(const Host &host, const Domain<D> &domain, unsigned attributes,
                  unsigned first = first_group<K>)
        : host_(host), domain_(domain), groups_(attributes), first_(first), keys_(host) {}

    /// Goes to the next page; false after the last.
    bool fetch();
    /// Reads it, and compares it with the one before. Throws an Error (corrupted).
    void read();
    const Key &key() const { return key_; }
    /// Counted among the groups of the kind.
    unsigned group() const { return group_of(key_) - first_; }
    const AttributePage<D, K> &page() const { return page_; }

private:
    const Host &host_;
    const Domain<D> domain_;
    const AttributeGroups groups_;
    const unsigned first_; // of the groups
    bool started_ = false;
    Key key_{}, last_{};        // last_: the greatest of the owners so far
    unsigned last_group_ = ~0u; // of the page before
    std::size_t size_ = 0;
    AttributePage<D, K> page_;
    Arena<Key> keys_;
    alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes_;
};

extern template class AttributeScan<2>;
extern template class AttributeScan<3>;
extern template class AttributeScan<2, 3>;
extern template class AttributeScan<3, 4>;

} // namespace abacus
