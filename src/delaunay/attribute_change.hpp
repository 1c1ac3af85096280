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
//
// A mesh whose attributes are apart keeps them apart as long as it has any. Any other mesh follows
// the same rule as a new one.
#pragma once

#include "attributes/rewriting.hpp"
#include "blocks/counters.hpp"
#include "delaunay/build.hpp"
#include "points/vertex_page.hpp"
#include "sort/pacer.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"
#include "traverse/own_vertices.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace abacus {

template <int D> class Build<D>::Attributes {
public:
    Attributes(Build &build, std::span<const std::uint32_t> source, std::size_t memory)
        : build_(build), source_(source), host_(build.host_), memory_(memory),
          count_(static_cast<unsigned>(source.size())), values_(host_), record_(host_) {
        values_.resize(build.attributes_);
        record_.resize(record_words(D, count_));
    }

    /// Writes everything; the header is as it was.
    void change(bool was_apart, bool will_be_apart) {
        if (build_.has_waiting()) change_waiting();
        if (build_.facts_->census.duplicates > 0) change_repeated();
        if (!build_.has_simplices()) return build_.apart_.reset();
        if (will_be_apart)
            move_apart();
        else if (was_apart)
            erase_apart();
        if (!was_apart && will_be_apart)
            rewrite_simplices(0);
        else if (!was_apart && count_ != build_.attributes_)
            rewrite_simplices(static_cast<int>(count_));
    }

private:
    static constexpr std::uint64_t report_every = 256; // vertices
    /// Each page is loaded once, and the pages written show how much the next ones may hold. So a
    /// cache for a few pages does better than a large one.
    static constexpr std::size_t pass_bytes = std::size_t{1} << 20;

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
        abacus_facts &facts = *build_.facts_;
        VertexReader<D> reader(host_, build_.attributes_, facts.census.inserted,
                               facts.census.staged, true);
        VertexPageWriter pages(host_, D, count_, facts.census.staged);
        while (reader.advance()) pages.add(converted(reader.record()));
        pages.finish();
        facts.census.inserted = facts.census.staged;
        facts.census.staged = pages.next();
    }

    void change_repeated() {
        RecordSpool spool(host_, 1 + record_words(D, count_));
        RepeatedReader<D> reader(host_, build_.domain_, build_.attributes_, true);
        while (reader.advance()) {
            std::uint64_t *const to = spool.add();
            to[0] = reader.serial();
            std::copy_n(converted(reader.record()), record_words(D, count_), to + 1);
        }
        spool.rewind();
        build_.repeated_.emplace(host_, build_.domain_, count_);
        while (const std::uint64_t *record = spool.next())
            build_.repeated_->add(record[0], record + 1);
        spool.close();
    }

    /// Writes the attributes of vertices to attribute pages, wherever they have been.
    void move_apart() {
        RecordSort sort(host_, 1 + D + count_, 1, memory_); // code, coordinates, attributes
        collect(sort);
        erase_apart();
        build_.apart_.emplace(host_, build_.domain_, count_);
        sort.finish();
        Pacer pacer(host_);
        pacer.begin(ABACUS_PHASE_FLUSHING, sort.size());
        std::uint64_t done = 0;
        while (const std::uint64_t *record = sort.next()) {
            build_.apart_->put(record_point<D>(record), record[0], record_attributes<D>(record));
            if (++done % report_every == 0) pacer.reached(done);
        }
        sort.close();
    }

    /// Adds the new attributes of vertices to the sort.
    void collect(RecordSort &sort) {
        Cache<D> &cache = build_.core_->cache;
        OwnVertices<D> own(cache);
        Arena<VertexIndex> vertices(host_);
        Pacer pacer(host_);
        pacer.begin(ABACUS_PHASE_SORTING, build_.facts_->census.vertices);
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
                std::uint64_t *const to = sort.add();
                to[0] = vertex.code;
                std::memcpy(to + 1, vertex.point.data(), sizeof vertex.point);
                convert(attributes_of(v), to + 1 + D);
            }
        }
    }

    /// The old attributes.
    const double *attributes_of(VertexIndex v) {
        const VertexHeap<D> &vertices = build_.core_->cache.vertices();
        if (!build_.apart_) return vertices.attributes(v);
        build_.apart_->get(vertices[v].point, vertices[v].code, values_.data());
        return values_.data();
    }

    void erase_apart() {
        if (!build_.apart_) return;
        build_.apart_->forget();
        build_.core_->cache.counters += build_.apart_->take_counters();
        build_.apart_.reset();
        erase_attributes(host_, first_group<1>);
    }

    /// With this many attributes in the simplex pages.
    void rewrite_simplices(int attributes) {
        Cache<D> cache(host_, build_.domain_, attributes,
                       CacheOptions{.budget = std::min(build_.cache_bytes_, pass_bytes),
                                    .former = {static_cast<int>(build_.attributes_), source_}});
        Pacer pacer(host_);
        pacer.begin(ABACUS_PHASE_FLUSHING,
                    build_.facts_->census.simplices + build_.facts_->census.ghosts);
        std::uint64_t done = 0;
        for (Key page = first_key; page < end_key;) {
            cache.trim();
            pacer.reached(done);
            page = cache.visit(page, [&](Handle) { ++done; }); // once loaded, it is to be written
        }
        cache.flush();
        build_.core_->cache.counters += cache.counters;
    }

    Build &build_;
    const std::span<const std::uint32_t> source_;
    const Host &host_;
    const std::size_t memory_;
    const unsigned count_;
    Arena<double> values_;
    Arena<std::uint64_t> record_;
};

} // namespace abacus
