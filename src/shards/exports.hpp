// The vertices that a shard has to send to others: one round of the exchange by which the
// triangulations of all shards become parts of one (docs/design/servers.md has the proof).
//
// A shard's mesh is the triangulation of its own points and of guests, which others own. For each
// simplex of it
//
//   1. all corners go to the shards that own one of them, and
//   2. if the shard itself owns a corner, they go to each shard whose region the circumsphere may
//      meet; a ghost's is its half-space, and
//   3. if it owns a corner of a facet, they go to the shard that owns the simplex beyond.
//
// A shard without simplices sends its own points to all others. A shard sends no vertex to its
// owner. When no shard has anything to send that the receiver does not have, each simplex with a
// corner of the shard's own belongs to the triangulation of all points, and so do all neighbours
// of a simplex that the shard owns.
//
// All these simplices lie near the regions of other shards, or beside such a one
// (border_pages.hpp): only their pages are read.
#pragma once

#include "mesh/inner_links.hpp"
#include "points/vertex_reader.hpp"
#include "query/locate/reader.hpp"
#include "query/pages/vertex_values.hpp"
#include "shards/border_pages.hpp"

#include <abacus/shards.h>

namespace abacus {

template <int D> class Exports {
public:
    Exports(const Host &host, const abacus_facts &facts, std::span<const std::uint64_t> borders,
            std::uint32_t shard, const abacus_box &extent);

    /// Throws an Error (argument) at a point that the extent does not contain.
    ///
    /// The next vertex to be sent, and the shard that needs it; false after the last. A page names
    /// each pair once; several pages may name the same. The attributes are valid until the next
    /// call.
    bool next(std::uint32_t &to, abacus_vertex &vertex);
    /// In place of all vertices: how many simplices of the mesh the shard owns. It owns those whose
    /// greatest vertex it does.
    std::uint64_t count_owned();

    /// What the simplices with a vertex at p say, of a shard that has any: calls visit(to, vertex).
    /// After a change these are enough for all its new vertices, and all that had a simplex with
    /// one that has gone.
    using Visit = std::function<void(std::uint32_t to, const abacus_vertex &vertex)>;
    void around(const Point<D> &p, const Visit &visit);

private:
    /// The pages near other shards' regions; they are searched for once needed.
    BorderPages<D> &pages();
    /// Goes to the next page; false after the last.
    bool advance();
    void collect();
    void collect(int simplex);
    void collect_beyond();
    std::uint32_t owner_of(int simplex) const;
    void send(int simplex, std::uint32_t to);
    void send_across(int simplex, int facet, std::uint32_t beyond);
    bool next_waiting(std::uint32_t &to, abacus_vertex &vertex);
    std::uint32_t owner(const Point<D> &p, std::int64_t id) const;
    /// Rules 1 and 2 for a simplex: calls send(to) where all its corners go.
    template <class Send>
    void each_receiver(const Corners<D> &corners, const std::array<std::uint32_t, D + 1> &owners,
                       bool is_ghost, Send send) const;
    void collect_around(const Point<D> &p, Handle first);
    void send_cached(Handle h, std::uint32_t to);
    std::uint32_t owner_cached(Handle h);

    const Host &host_;
    const abacus_facts facts_;
    const std::uint32_t shard_;
    const Box<D> extent_;
    const ShardRegions<D> regions_;
    const unsigned attributes_;
    std::optional<BorderPages<D>> pages_; // once needed
    VertexReader<D> waiting_;
    std::uint32_t next_receiver_; // of the point that waits
    VertexValues<D> values_;
    Arena<double> of_vertex_;         // its attributes
    InnerLinks<D> links_;             // of a page across a border
    Arena<Simplex<D>> slots_;         //
    Arena<Link> border_;              //
    Arena<bool> on_border_;           //
    Arena<std::uint32_t> owners_;     // of the page's vertices
    Arena<std::uint64_t> to_send_;    // from the page: shards, and vertices by number
    std::size_t at_ = 0;              // in it
    std::optional<Reader<D>> reader_; // once places are asked for
};

extern template class Exports<2>;
extern template class Exports<3>;

} // namespace abacus
