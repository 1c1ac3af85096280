// Gives all points of a mesh other attributes: more, fewer, or the same in another place.
//
// The simplices, their labels and their places on the curve stay as they are. Everything that has
// attributes is rewritten, one kind of pages after the other:
//
//   points that wait    behind the others, in their order
//   repeated points     by way of a spool, since they keep their keys
//   vertices            If their attributes are apart, these are sorted along the curve, and their
//                       pages rebuilt. If they are in the simplex pages, each of these is loaded
//                       with the new attributes of its vertices, and written again. If they become
//                       apart, both is done.
//   listed vertices     of a loaded mesh that is not Delaunay: by way of a spool. There the
//   simplices
//                       around a vertex need not be connected, so attributes that become apart are
//                       taken from the list.
//
// A mesh whose attributes are apart keeps them apart as long as it has any. Any other mesh follows
// the same rule as a new one.
#pragma once

#include "attributes/rewriting.hpp"
#include "blocks/counters.hpp"
#include "change/workspace.hpp"
#include "points/vertex_page.hpp"
#include "points/vertex_reader.hpp"
#include "sort/pacer.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"
#include "traverse/own_vertices.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

namespace abacus {

template <int D> class AttributeChange {
public:
    AttributeChange(Workspace<D> &work, std::span<const std::uint32_t> source, std::size_t memory)
        : work_(work), source_(source), host_(work.host), memory_(memory),
          count_(static_cast<unsigned>(source.size())), values_(host_), record_(host_) {
        values_.resize(work.attributes);
        record_.resize(record_words(D, count_));
    }

    /// Writes everything; the header is as it was.
    void change(bool was_apart, bool will_be_apart) {
        if (work_.has_waiting()) change_waiting();
        if (work_.facts->census.duplicates > 0) change_repeated();
        if (!work_.has_simplices()) return work_.apart.reset();
        if (will_be_apart)
            move_apart();
        else if (was_apart)
            erase_apart();
        if (!was_apart && will_be_apart)
            rewrite_simplices(0);
        else if (!was_apart && count_ != work_.attributes)
            rewrite_simplices(static_cast<int>(count_));
        if (work_.lists_vertices() && !was_apart) rewrite_list(will_be_apart ? 0 : count_);
    }

private:
    static constexpr std::uint64_t report_every = 256; // vertices

    void convert(const double *from, std::uint64_t *to) const {
        for (const std::uint32_t source : source_)
            *to++ = std::bit_cast<std::uint64_t>(value_from(source, from));
    }
    /// A record with its new attributes.
    const std::uint64_t *converted(const std::uint64_t *record) {
        std::copy_n(record, 1 + D, record_.data());
        convert(record_attributes<D>(record), record_.data() + 1 + D);
        return record_.data();
    }

    void change_waiting() {
        abacus_facts &facts = *work_.facts;
        VertexReader<D> reader(host_, work_.attributes, facts.census.inserted, facts.census.staged,
                               true);
        VertexPageWriter pages(host_, D, count_, facts.census.staged);
        while (reader.advance()) pages.add(converted(reader.record()));
        pages.finish();
        facts.census.inserted = facts.census.staged;
        facts.census.staged = pages.next();
    }

    void change_repeated() {
        RecordSpool spool(host_, 1 + record_words(D, count_));
        RepeatedReader<D> reader(host_, work_.domain, work_.attributes, true);
        while (reader.advance()) {
            std::uint64_t *const to = spool.add();
            to[0] = reader.serial();
            std::copy_n(converted(reader.record()), record_words(D, count_), to + 1);
        }
        spool.rewind();
        work_.repeated.emplace(host_, work_.domain, count_);
        while (const std::uint64_t *record = spool.next())
            work_.repeated->add(record[0], record + 1);
        spool.close();
    }

    /// Writes the attributes of vertices to attribute pages, wherever they have been.
    void move_apart() {
        RecordSort sort(host_, 1 + D + count_, 1, memory_); // code, coordinates, attributes
        if (work_.lists_vertices())
            collect_listed(sort);
        else
            collect(sort);
        erase_apart();
        work_.apart.emplace(host_, work_.domain, count_);
        sort.finish();
        Pacer pacer(host_);
        pacer.begin(ABACUS_PHASE_FLUSHING, sort.size());
        std::uint64_t done = 0;
        while (const std::uint64_t *record = sort.next()) {
            work_.apart->put(record_point<D>(record), record[0], record_attributes<D>(record));
            if (++done % report_every == 0) pacer.reached(done);
        }
        sort.close();
    }

    /// Adds the new attributes of a vertex to the sort.
    void add(RecordSort &sort, const Point<D> &p, std::uint64_t code, const double *attributes) {
        std::uint64_t *const to = sort.add();
        to[0] = code;
        std::memcpy(to + 1, p.data(), sizeof p);
        convert(attributes, to + 1 + D);
    }

    /// Those of listed vertices.
    void collect_listed(RecordSort &sort) {
        VertexReader<D> list(host_, work_.apart ? 0 : work_.attributes, 0,
                             work_.facts->census.staged);
        while (list.advance()) {
            const Point<D> p = list.point();
            const std::uint64_t code = work_.domain.code(p);
            if (work_.apart) work_.apart->get(p, code, values_.data());
            add(sort, p, code, work_.apart ? values_.data() : list.attributes());
        }
    }

    /// The list of vertices, with so many of the new attributes.
    void rewrite_list(unsigned attributes) {
        const std::uint64_t count = work_.facts->census.staged;
        RecordSpool spool(host_, record_words(D, attributes));
        VertexReader<D> list(host_, work_.attributes, 0, count, true);
        while (list.advance())
            std::copy_n(converted(list.record()), record_words(D, attributes), spool.add());
        spool.rewind();
        VertexPageWriter pages(host_, D, attributes, 0);
        while (const std::uint64_t *record = spool.next()) pages.add(record);
        pages.finish();
        spool.close();
    }

    /// Adds the new attributes of vertices to the sort.
    void collect(RecordSort &sort) {
        Cache<D> &cache = work_.core->cache;
        OwnVertices<D> own(cache);
        Arena<VertexIndex> vertices(host_);
        Pacer pacer(host_);
        pacer.begin(ABACUS_PHASE_SORTING, work_.facts->census.vertices);
        for (Key page = first_key; page < end_key;) {
            cache.trim();
            pacer.reached(sort.size());
            page = own.collect(page);
            // Nearly along the curve, so that neighbours share a page of attributes.
            vertices.clear();
            for (const VertexIndex v : own.list()) vertices.push_back(v);
            std::sort(vertices.begin(), vertices.end(), [&](VertexIndex a, VertexIndex b) {
                return cache.vertices()[a].code < cache.vertices()[b].code;
            });
            for (const VertexIndex v : vertices) {
                const Vertex<D> &vertex = cache.vertices()[v];
                add(sort, vertex.point, vertex.code, attributes_of(v));
            }
        }
    }

    /// The old attributes.
    const double *attributes_of(VertexIndex v) {
        const VertexHeap<D> &vertices = work_.core->cache.vertices();
        if (!work_.apart) return vertices.attributes(v);
        work_.apart->get(vertices[v].point, vertices[v].code, values_.data());
        return values_.data();
    }

    void erase_apart() {
        if (!work_.apart) return;
        work_.apart->forget();
        work_.core->cache.counters += work_.apart->take_counters();
        work_.apart.reset();
        erase_attributes(host_, first_group<1>);
    }

    /// With this many attributes in the simplex pages.
    void rewrite_simplices(int attributes) {
        Cache<D> cache(host_, work_.domain, attributes,
                       work_.pass_options({static_cast<int>(work_.attributes), source_}));
        Pacer pacer(host_);
        pacer.begin(ABACUS_PHASE_FLUSHING,
                    work_.facts->census.simplices + work_.facts->census.ghosts);
        std::uint64_t done = 0;
        for (Key page = first_key; page < end_key;) {
            cache.trim();
            pacer.reached(done);
            page = cache.visit(page, [&](Handle) { ++done; }); // once loaded, it is to be written
        }
        cache.flush();
        work_.core->cache.counters += cache.counters;
    }

    Workspace<D> &work_;
    const std::span<const std::uint32_t> source_;
    const Host &host_;
    const std::size_t memory_;
    const unsigned count_;
    Arena<double> values_;
    Arena<std::uint64_t> record_;
};

} // namespace abacus
