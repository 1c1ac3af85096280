// Attributes by place: pages of attributes, read and kept.
//
// Who asks for one vertex asks for its neighbours soon, which are near on the curve. So a few pages
// are kept, and one that has not been used for long makes room for another one. Each vertex that is
// asked for has attributes; so the page is known to be the right one if its last vertex does not
// come before, and nothing has to be known of the page that follows.
#pragma once

#include "attributes/attribute_page.hpp"
#include "host/memory_resource.hpp"

#include <abacus/header.h>

#include <deque>
#include <map>

namespace abacus {

template <int D> class AttributeReader {
public:
    /// Keeps pages in about so many bytes, but one of each group at least.
    AttributeReader(const Host &host, const Domain<D> &domain, unsigned attributes,
                    std::size_t bytes);
    AttributeReader(const AttributeReader &) = delete;
    AttributeReader &operator=(const AttributeReader &) = delete;

    /// An attribute of the vertex at p. Throws an Error (corrupted) if there is no such vertex.
    double value(const Point<D> &p, unsigned attribute);
    /// All of them.
    void values(const Point<D> &p, double *values);
    /// Whether all groups have the vertex.
    bool contains(const Point<D> &p);

    std::uint64_t pages_read() const { return pages_read_; }

private:
    struct Held {
        explicit Held(const Memory &memory) : keys(memory) {}

        Key lower{}, last{};  ///< holds what is between; is in by_key_, unless it holds nothing
        bool is_used = false; ///< since the hand came by
        AttributePage<D> page;
        Arena<Key> keys;
        alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes;
    };
    /// Where a vertex is found in a group.
    struct Found {
        Held *held;
        std::size_t vertex;
    };

    /// The vertex that is asked for from now on.
    void begin(const Point<D> &p);
    /// In a group; `held` is null if it is not there.
    Found find(unsigned group);
    Held *page(const Key &key);
    /// A place for another page: a clock's hand finds it (Corbató, 1968).
    Held &make_room();
    void read(const Key &key, Held &held);

    const Host &host_;
    const Domain<D> domain_;
    const AttributeGroups groups_;
    HostMemory memory_;
    const std::size_t most_held_;
    std::pmr::deque<Held> pages_;
    std::pmr::map<Key, Held *, KeyBefore> by_key_; // those that hold a page, by its lower key
    std::size_t hand_ = 0;                         // the next of pages_ that may have to go
    std::uint64_t pages_read_ = 0;
    // The vertex asked for last, and where it was found; many attributes of it may be asked for.
    Point<D> p_{};
    Key key_{};
    bool is_asked_ = false;
    unsigned found_group_ = 0;
    Found found_{};
};

extern template class AttributeReader<2>;
extern template class AttributeReader<3>;

/// All attribute pages, one after the other; checks that they are as they should be.
template <int D> class AttributeScan {
public:
    AttributeScan(const Host &host, const Domain<D> &domain, unsigned attributes)
        : host_(host), domain_(domain), groups_(attributes), keys_(host) {}

    /// Goes to the next page; false after the last.
    bool fetch();
    /// Reads it, and compares it with the one before. Throws an Error (corrupted).
    void read();
    const Key &key() const { return key_; }
    unsigned group() const { return group_of(key_); }
    std::size_t vertices() const { return page_.vertices(); }

private:
    const Host &host_;
    const Domain<D> domain_;
    const AttributeGroups groups_;
    bool started_ = false;
    Key key_{}, last_{};        // last_: the greatest of the vertices so far
    unsigned last_group_ = ~0u; // of the page before
    std::size_t size_ = 0;
    AttributePage<D> page_;
    Arena<Key> keys_;
    alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes_;
};

extern template class AttributeScan<2>;
extern template class AttributeScan<3>;

} // namespace abacus
