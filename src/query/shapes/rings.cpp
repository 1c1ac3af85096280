#include "query/shapes/rings.hpp"

#include "blocks/bit_column.hpp"
#include "query/locate/hull_ghost.hpp"
#include "query/scan/extent_pages.hpp"

namespace abacus {

Rings::Rings(Reader<2> &reader, const Kept &kept, std::size_t memory)
    : host_(reader.cache().host()), reader_(reader), cache_(reader.cache()), kept_(kept),
      border_(cache_, kept), share_(memory / 4), rows_(host_, words, 2, share_) {
    RecordSort starts(host_, 6, 4, share_), by_place(host_, 4, 4, share_);
    RecordSpool visits(host_, words);
    find_starts(starts);
    walk(starts, visits, by_place);
    starts.close();
    RecordSort pieces(host_, 3, 2, share_), rings(host_, words, 2, share_);
    find_pieces(by_place, pieces);
    by_place.close();
    split(visits, pieces, rings);
    visits.close();
    pieces.close();
    RecordSort least(host_, least_words, 2, share_), numbers(host_, 5, 1, share_);
    find_least(rings, least);
    least.finish();
    number_rings(least, numbers);
    least.close();
    put_in_order(rings, numbers);
    rings.close();
    numbers.close();
}

bool Rings::next(Visit &visit) {
    const std::uint64_t *const record = rows_.next();
    if (record == nullptr) return false;
    visit = {record[0],
             record[1],
             static_cast<std::int64_t>(record[2]),
             point_from_ordered<2>(record + 3),
             {record[5], record[6]},
             record[7] != 0};
    return true;
}

// ---- Walks ------------------------------------------------------------------------------

void Rings::add_start(RecordSort &starts, const Border::Edge &edge) {
    std::uint64_t *const record = starts.add();
    put_ordered(record, edge.from);
    put_ordered(record + 2, edge.to);
    record[4] = edge.page.code;
    record[5] = edge.page.part;
}

/// Finds only the hull: no other page is read.
void Rings::find_hull(RecordSort &starts) {
    const Link inside = cache_.cross(hull_ghost<2>(reader_), 2);
    const Border::Edge edge = border_.edge(link_simplex(inside), link_facet(inside));
    Border::Edge at = edge, first = edge;
    do {
        ++edges_;
        at = border_.next(at);
        if (at.comes_before(first)) first = at;
        border_.make_room<1>({&at});
    } while (!at.is(edge));
    add_start(starts, first);
}

std::size_t Rings::find_starts_of_page(const Key &page, Arena<Border::Edge> &edges) {
    Arena<Handle> triangles(host_);
    cache_.trim();
    cache_.visit(page, [&](Handle h) { triangles.push_back(h); });
    for (const Handle h : triangles) {
        if (!border_.is_kept(h)) continue;
        for (int facet = 0; facet < 3; ++facet)
            if (border_.is_border(h, facet)) edges.push_back(border_.edge(h, facet));
    }
    return triangles.size();
}

template <class Look> void Rings::each_page(Look look) {
    const std::optional<Box<2>> box = box_of(kept_.extent);
    if (!box) {
        for (Key page = first_key; page < end_key;) {
            look(page);
            page = cache_.visit(page, [](Handle) {});
        }
        return;
    }
    if (box->upper[0] < box->lower[0]) return;
    RecordSort keys(host_, 2, 2, share_);
    const BoxRegion<2> region(*box);
    RangeScan<2> pages(host_, reader_.facts(), &region, pages_in<2>(kept_.extent));
    while (pages.advance()) {
        std::uint64_t *const record = keys.add();
        record[0] = pages.page().lower().code;
        record[1] = pages.page().lower().part;
    }
    keys.finish();
    while (const std::uint64_t *const record = keys.next()) look(Key{record[0], record[1]});
    keys.close();
}

void Rings::find_starts(RecordSort &starts) {
    if (!reader_.is_empty() && kept_.is_all() && reader_.is_convex()) {
        find_hull(starts);
    } else if (!reader_.is_empty()) {
        Arena<Border::Edge> edges(host_);
        Pacer pacer(host_);
        pacer.begin(ABACUS_PHASE_SCANNING, reader_.size());
        std::uint64_t seen = 0;
        each_page([&](const Key &page) {
            edges.clear();
            pacer.reached(seen += find_starts_of_page(page, edges));
            edges_ += edges.size();
            for (Border::Edge edge : edges) {
                border_.find(edge);
                if (border_.is_first_of_ring(edge)) add_start(starts, edge);
                cache_.trim();
            }
        });
    }
    starts.finish();
}

void Rings::walk(RecordSort &starts, RecordSpool &visits, RecordSort &by_place) {
    const auto edges = static_cast<double>(edges_);
    host_.spool_expect(visits.spool_bytes(edges) + by_place.spool_bytes(edges));
    for (std::uint64_t ring = 0; const std::uint64_t *start = starts.next(); ++ring) {
        Border::Edge first{point_from_ordered<2>(start),
                           point_from_ordered<2>(start + 2),
                           {start[4], start[5]},
                           no_handle,
                           0};
        border_.find(first);
        Border::Edge at = first;
        std::uint64_t position = 0;
        do {
            std::uint64_t *const visit = visits.add(), *const place = by_place.add();
            visit[0] = place[0] = ring;
            visit[1] = place[3] = position++;
            visit[2] = static_cast<std::uint64_t>(border_.id(at));
            put_ordered(visit + 3, at.from);
            put_ordered(place + 1, at.from);
            visit[5] = at.page.code;
            visit[6] = at.page.part;
            visit[7] = 0;
            at = border_.next(at);
            border_.make_room<1>({&at});
        } while (!at.is(first));
    }
    visits.rewind();
    by_place.finish();
}

// ---- Pieces -----------------------------------------------------------------------------

void Rings::find_pieces(RecordSort &by_place, RecordSort &pieces) {
    std::array<std::uint64_t, 4> before{};
    bool is_first = true;
    while (const std::uint64_t *record = by_place.next()) {
        if (!is_first && std::equal(record, record + 3, before.begin())) {
            std::uint64_t *const piece = pieces.add();
            piece[0] = record[0];
            piece[1] = before[3];
            piece[2] = record[3];
        }
        std::copy_n(record, 4, before.begin());
        is_first = false;
    }
    pieces.finish();
}

void Rings::split(RecordSpool &visits, RecordSort &pieces, RecordSort &rings) {
    struct Open {
        std::uint64_t end, ring;
    };
    Arena<Open> open(host_);
    std::uint64_t walked = ~0ull; // the ring before it is split
    std::array<std::uint64_t, 3> piece{};
    bool is_piece = false;
    const auto read_piece = [&] {
        const std::uint64_t *const record = pieces.next();
        is_piece = record != nullptr;
        if (is_piece) std::copy_n(record, 3, piece.begin());
    };
    read_piece();
    while (const std::uint64_t *visit = visits.next()) {
        if (visit[0] != walked) {
            walked = visit[0];
            open.clear();
            open.push_back({~0ull, count_++});
        }
        while (open.back().end <= visit[1]) open.pop_back();
        if (is_piece && piece[0] == walked && piece[1] == visit[1]) {
            open.push_back({piece[2], count_++});
            read_piece();
        }
        std::uint64_t *const to = rings.add();
        std::copy_n(visit, words, to);
        to[0] = open.back().ring;
    }
    rings.finish();
}

// ---- Order ------------------------------------------------------------------------------

void Rings::find_least(RecordSort &rings, RecordSort &least) const {
    std::uint64_t ring = 0, size = 0, begin = 0;
    Point<2> first{}, last{}, point{}, before{}, after{}; // `point` is the least so far
    bool is_after_open = false;
    const auto end_ring = [&] {
        if (size < 3) return; // empty, or both sides of one edge of a fault
        if (begin == 0) before = last;
        if (is_after_open) after = first;
        std::uint64_t *const record = least.add();
        put_ordered(record, point);
        put_ordered(record + 2, after);
        record[4] = ring;
        record[5] = begin;
        record[6] = size;
        record[7] = orientation(before, point, after) < 0;
    };
    while (const std::uint64_t *record = rings.next()) {
        if (size == 0 || record[0] != ring) {
            end_ring();
            ring = record[0];
            size = 0;
        }
        const Point<2> p = point_from_ordered<2>(record + 3);
        if (size == 0) first = p;
        if (is_after_open && size > 0) after = p;
        is_after_open = size == 0 || lexicographically_less<2>(p, point);
        if (is_after_open) {
            point = p;
            before = last;
            begin = size;
        }
        last = p;
        ++size;
    }
    end_ring();
}

void Rings::number_rings(RecordSort &least, RecordSort &numbers) const {
    using Record = std::array<std::uint64_t, least_words>;
    Arena<Record> group(host_); // of one vertex
    std::uint64_t number = 0;
    const auto end_group = [&] {
        std::sort(group.begin(), group.end(), [](const Record &a, const Record &b) {
            return orientation(point_from_ordered<2>(a.data()), point_from_ordered<2>(&a[2]),
                               point_from_ordered<2>(&b[2])) > 0;
        });
        for (const Record &record : group) {
            std::uint64_t *const to = numbers.add();
            to[0] = record[4]; // its present number
            to[1] = number++;
            std::copy_n(&record[5], 3, to + 2); // where it begins, its size, whether it is a hole
        }
        group.clear();
    };
    while (const std::uint64_t *record = least.next()) {
        if (!group.empty() && !std::equal(record, record + 2, group.back().begin())) end_group();
        std::copy_n(record, least_words, group.extend(1)->begin());
    }
    end_group();
}

void Rings::put_in_order(RecordSort &rings, RecordSort &numbers) {
    numbers.finish();
    rings.rewind();
    const std::uint64_t *number = numbers.next();
    std::uint64_t position = 0;
    while (const std::uint64_t *visit = rings.next()) {
        while (number != nullptr && number[0] < visit[0]) {
            number = numbers.next();
            position = 0;
        }
        if (number == nullptr || number[0] != visit[0]) continue; // it has no number
        const std::uint64_t begin = number[2], size = number[3];
        std::uint64_t *const row = rows_.add();
        std::copy_n(visit, words, row);
        row[0] = number[1];
        row[1] = position >= begin ? position - begin : position + size - begin;
        row[7] = number[4];
        ++position;
    }
    rows_.finish();
}

} // namespace abacus
