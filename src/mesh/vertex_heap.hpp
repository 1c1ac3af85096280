// The vertices of the cached simplices (dissertation §4.4.1-2, §4.5.1).
//
// What the geometry reads is kept apart from what only pages need (the user's id
// and attributes). Vertices are identified by their coordinates; where a mesh has several
// at one place, by their ids besides. Only those that
// a page outside the cache may name as well are `shared` and entered in the hash
// table: the vertices on the border of evicted or loaded blocks. A vertex made by
// an insertion and surrounded by cached simplices is never hashed.
#pragma once

#include "host/arena.hpp"
#include "host/free_numbers.hpp"
#include "host/hash_slots.hpp"
#include "keys/locational_code.hpp"
#include "mesh/simplex.hpp"

#include <bit>
#include <cstring>
#include <limits>

namespace abacus {

template <int D> struct Vertex {
    Point<D> point;
    std::uint64_t code;       // of the point: keys are computed from it
    std::uint32_t references; // cached simplices that use the vertex; top bit: shared
    std::uint32_t number;     // in the Numbering at hand, if any
};

template <int D> class VertexHeap {
public:
    /// `by_id`: several vertices may be at one place.
    VertexHeap(const Host &host, int attributes, bool by_id = false)
        : attributes_(attributes), by_id_(by_id), vertices_(host), ids_(host), values_(host),
          free_(host), slots_(host) {
        // Vertex 0 is the point at infinity; NaN fails every floating-point filter.
        Point<D> nowhere;
        nowhere.fill(std::numeric_limits<double>::quiet_NaN());
        create(nowhere, 0, 0, nullptr); // the code is below all others
    }

    const Vertex<D> &operator[](VertexIndex v) const { return vertices_[v]; }
    const Point<D> &point(VertexIndex v) const { return vertices_[v].point; }
    std::int64_t id(VertexIndex v) const { return ids_[v]; }
    const double *attributes(VertexIndex v) const {
        return attributes_ == 0 ? nullptr : &values_[std::size_t(v) * attributes_];
    }
    int attribute_count() const { return attributes_; }

    /// Vertices in use, the one at infinity included; the bytes they take.
    std::size_t count() const { return vertices_.size() - free_.size(); }
    std::size_t bytes() const {
        return count() * (sizeof(Vertex<D>) + sizeof(std::int64_t) + Slots::slot_bytes +
                          attributes_ * sizeof(double));
    }
    /// Above every vertex index in use.
    std::size_t end() const { return vertices_.size(); }

    /// A new vertex without references. `attributes` may be null when there are none.
    VertexIndex create(const Point<D> &p, std::uint64_t code, std::int64_t id,
                       const double *attributes) {
        VertexIndex v;
        if (!free_.empty()) {
            v = VertexIndex{free_.take()};
        } else {
            const std::size_t size = vertices_.size() + 1;
            v = VertexIndex{static_cast<std::uint32_t>(size - 1)};
            vertices_.resize(size);
            ids_.resize(size);
            values_.resize(size * attributes_);
        }
        vertices_[v] = {p, code, 0, 0};
        rename(v, id, attributes);
        return v;
    }
    /// Another id, other attributes.
    void rename(VertexIndex v, std::int64_t id, const double *attributes) {
        ids_[v] = id;
        if (attributes_ != 0 && attributes != nullptr)
            std::memcpy(&values_[std::size_t(v) * attributes_], attributes,
                        attributes_ * sizeof(double));
    }

    /// A list of distinct vertices, each of which knows its place in it: a sparse set
    /// (Briggs and Torczon, 1993), empty at once whatever the vertices still hold. One
    /// at a time is valid.
    class Numbering {
    public:
        explicit Numbering(const Host &host) : list_(host) {}

        void clear() { list_.clear(); }
        std::size_t size() const { return list_.size(); }
        VertexIndex operator[](std::size_t number) const { return list_[number]; }

        bool contains(const VertexHeap &heap, VertexIndex v) const {
            const std::uint32_t number = heap.vertices_[v].number;
            return number < list_.size() && list_[number] == v;
        }
        /// The vertex's number, the next one if it had none.
        std::uint32_t number(VertexHeap &heap, VertexIndex v) {
            std::uint32_t &number = heap.vertices_[v].number;
            if (!(number < list_.size() && list_[number] == v)) {
                number = static_cast<std::uint32_t>(list_.size());
                list_.push_back(v);
            }
            return number;
        }
        /// The same without branches, for where no processor can foresee whether a vertex is
        /// new; reserve() has made room for it.
        std::uint32_t number_in_room(VertexHeap &heap, VertexIndex v) {
            std::uint32_t &number = heap.vertices_[v].number;
            const auto next = static_cast<std::uint32_t>(list_.size());
            const std::uint32_t old = std::min(number, next);
            list_.data()[next] = free_mark; // no vertex
            const bool is_new = list_.data()[old] != v;
            number = is_new ? next : old;
            list_.data()[next] = v;
            list_.resize(next + is_new);
            return number;
        }
        void reserve(std::size_t n) { list_.reserve(n); }
        /// Numbers the vertices anew, in this order.
        template <class Less> void sort(VertexHeap &heap, Less less) {
            std::sort(list_.begin(), list_.end(), less);
            renew(heap);
        }
        /// Makes it the valid one again.
        void renew(VertexHeap &heap) const {
            for (std::size_t i = 0; i < list_.size(); ++i)
                heap.vertices_[list_[i]].number = static_cast<std::uint32_t>(i);
        }

    private:
        Arena<VertexIndex> list_;
    };

    void acquire(VertexIndex v) { ++vertices_[v].references; }
    void acquire(VertexIndex v, std::uint32_t times) { vertices_[v].references += times; }
    /// Does not free the vertex, even without references: an insertion takes all
    /// references away before it makes new ones.
    void release(VertexIndex v) { --vertices_[v].references; }
    void release(VertexIndex v, std::uint32_t times) { vertices_[v].references -= times; }
    /// So many simplices have the vertex.
    std::uint32_t references(VertexIndex v) const { return vertices_[v].references & ~shared; }
    bool in_use(VertexIndex v) const { return references(v) != 0; }
    bool is_shared(VertexIndex v) const { return (vertices_[v].references & shared) != 0; }

    void destroy(VertexIndex v) {
        if (vertices_[v].references & shared) slots_.remove(hash(point(v)), to_number(v));
        vertices_[v].references = 0;
        free_.add(to_number(v));
    }

    /// Makes the vertex known to find_shared().
    void share(VertexIndex v) {
        if (vertices_[v].references & shared) return;
        vertices_[v].references |= shared;
        slots_.add(hash(point(v)), to_number(v));
    }

    /// The shared vertex at p, or infinite_vertex; where it takes an id, too, the one with this.
    VertexIndex find_shared(const Point<D> &p, std::int64_t id) const {
        return VertexIndex{slots_.find(hash(p), [&](std::uint32_t number) {
            const VertexIndex v{number};
            return point(v) == p && (!by_id_ || ids_[v] == id);
        })};
    }

    void prefetch_id(VertexIndex v) const {
        __builtin_prefetch(&ids_[v]);
        if (attributes_ != 0) __builtin_prefetch(attributes(v));
    }
    /// Two steps of find_shared() or share() in advance, for many points at once.
    void prefetch_slot(const Point<D> &p) const { slots_.prefetch(hash(p)); }
    void prefetch_vertex(const Point<D> &p) const {
        __builtin_prefetch(&vertices_[VertexIndex{slots_.first(hash(p))}]);
    }

private:
    static constexpr std::uint32_t shared = 0x80000000u;

    using Slots = HashSlots<to_number(infinite_vertex)>;

    std::uint32_t hash(const Point<D> &p) const {
        std::uint64_t h = 0;
        for (const double x : p) {
            h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ull;
            h ^= h >> 32;
        }
        return static_cast<std::uint32_t>(h);
    }

    int attributes_;
    bool by_id_;
    Arena<Vertex<D>, VertexIndex> vertices_;
    Arena<std::int64_t, VertexIndex> ids_;
    Arena<double> values_;
    FreeNumbers free_;
    Slots slots_; // of the shared vertices, by their points
};

} // namespace abacus
