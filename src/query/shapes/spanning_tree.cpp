#include "query/shapes/spanning_tree.hpp"

#include "blocks/bit_column.hpp"
#include "query/shapes/disjoint_sets.hpp"

#include <bit>

namespace abacus {

namespace {

/// Memory for each vertex of a chunk: two sets, and a word that says whether it is closed, or is
/// its new number.
constexpr std::size_t bytes_per_vertex = 2 * sizeof(std::uint32_t) + sizeof(std::uint64_t);

constexpr std::uint64_t least_room = 16, most_room = std::uint64_t{1} << 31;

void put(RecordSort &sort, std::initializer_list<std::uint64_t> words) {
    std::copy(words.begin(), words.end(), sort.add());
}

} // namespace

template <int D>
SpanningTree<D>::SpanningTree(const Host &host, const abacus_facts &facts, std::size_t memory,
                              std::size_t cache_bytes, const Report &report)
    : host_(host), share_(memory / 4),
      room_(std::clamp<std::uint64_t>(share_ / bytes_per_vertex, least_room, most_room)),
      details_(host, detail_words), tree_(host, 1, 1, share_) {
    {
        LightEdges<D> light(host, facts, cache_bytes);
        RecordSort ends(host_, end_words, D + 2, share_);
        // As many edges as join all places of vertices.
        rank(light, ends,
             static_cast<double>(facts.census.vertices) - static_cast<double>(facts.census.split) -
                 1);
        number(ends);
        ends.close();
    }
    while (vertices_ > room_) contract();
    finish();
    this->report(report);
}

template <int D> void SpanningTree<D>::rank(LightEdges<D> &edges, RecordSort &ends, double least) {
    // Vertices at one place count as one, so the ids decide which edge comes first.
    RecordSort by_length(host_, length_words, length_words, share_);
    host_.spool_expect(by_length.spool_bytes(least) + ends.spool_bytes(2 * least) +
                       details_.spool_bytes(least));
    edges.each([&](const typename LightEdges<D>::Edge &edge) {
        std::uint64_t *const record = by_length.add();
        const LengthKey key = length_key<D>(edge.point[0], edge.point[1]);
        std::copy(key.begin(), key.end(), record);
        for (int i = 0; i < 2; ++i) {
            put_ordered(record + key.size() + i * D, edge.point[i]);
            record[key.size() + 2 * D + i] = static_cast<std::uint64_t>(edge.id[i]);
        }
    });
    by_length.finish();
    std::array<std::uint64_t, length_words> before{};
    std::uint64_t rank = 0;
    while (const std::uint64_t *record = by_length.next()) {
        if (rank > 0 && std::equal(record, record + length_words - 2, before.begin())) continue;
        std::copy_n(record, length_words, before.begin());
        LengthKey key;
        std::copy_n(record, key.size(), key.begin());
        const Point<D> a = point_from_ordered<D>(record + length_words - 2 - 2 * D);
        const Point<D> b = point_from_ordered<D>(record + length_words - 2 - D);
        for (const Point<D> &end : {a, b}) {
            std::uint64_t *const to = ends.add();
            to[0] = edges.domain().code(end);
            put_ordered(to + 1, end);
            to[D + 1] = rank;
        }
        std::uint64_t *const detail = details_.add();
        detail[0] = record[length_words - 2];
        detail[1] = record[length_words - 1];
        detail[2] = std::bit_cast<std::uint64_t>(length_of(key));
        ++rank;
    }
    by_length.close();
    ends.finish();
    details_.rewind();
}

template <int D> void SpanningTree<D>::number(RecordSort &ends) {
    RecordSort numbered(host_, 2, 2, share_);
    std::array<std::uint64_t, end_words> before{};
    while (const std::uint64_t *end = ends.next()) {
        if (vertices_ == 0 || !std::equal(end, end + D + 1, before.begin())) ++vertices_;
        std::copy_n(end, end_words, before.begin());
        put(numbered, {end[D + 1], vertices_ - 1});
    }
    numbered.finish();
    edges_.emplace(host_, ends_words, 1, share_);
    while (const std::uint64_t *end = numbered.next()) {
        const std::uint64_t rank = end[0], a = end[1];
        put(*edges_, {rank, a, numbered.next()[1]});
    }
    numbered.close();
    edges_->finish();
}

// ---- Fewer vertices ---------------------------------------------------------------------

template <int D> void SpanningTree<D>::contract() {
    const std::uint64_t before = vertices_;
    RecordSort by_chunk(host_, chunk_words, 2, share_), left(host_, renumber_words, 1, share_);
    RecordSpool numbers(host_, 1);
    sort_by_chunk(by_chunk);
    contract_chunks(by_chunk, left, numbers);
    by_chunk.close();
    RecordSort other(host_, renumber_words, 1, share_);
    renumber(left, numbers, other);
    left.close();
    RecordSort renumbered(host_, renumber_words, 1, share_);
    renumber(other, numbers, renumbered);
    other.close();
    numbers.close();
    edges_.emplace(host_, ends_words, 1, share_);
    while (const std::uint64_t *edge = renumbered.next()) put(*edges_, {edge[1], edge[0], edge[2]});
    edges_->finish();
    renumbered.close();
    shift_ = room_ / 2 - shift_;
    if (vertices_ > room_ && vertices_ > before - before / 16)
        throw Error(ABACUS_ERROR_LIMIT, "the memory of a query is too small for this tree",
                    "Even along the curve, the vertices are connected from one end to the other.",
                    "Increase work_mem to 64 bytes per vertex.");
}

template <int D> void SpanningTree<D>::sort_by_chunk(RecordSort &by_chunk) {
    while (const std::uint64_t *edge = edges_->next()) {
        const std::uint64_t of_a = chunk_of(edge[1]), of_b = chunk_of(edge[2]);
        put(by_chunk, {of_a, edge[0], edge[1], edge[2]});
        if (of_a != of_b) put(by_chunk, {of_b, edge[0], edge[1], edge[2]});
    }
    edges_->close();
    by_chunk.finish();
}

template <int D>
void SpanningTree<D>::contract_chunks(RecordSort &by_chunk, RecordSort &left,
                                      RecordSpool &numbers) {
    DisjointSets parts(host_), joined(host_);
    Arena<std::uint64_t> note(host_); // whether a part is closed; then its new number
    std::uint64_t next = 0;           // new number
    const std::uint64_t *edge = by_chunk.next();
    std::uint64_t end = 0; // of a chunk
    for (std::uint64_t first = 0; first < vertices_; first = end) {
        end = std::min((chunk_of(first) + 1) * room_ - shift_, vertices_);
        const auto size = static_cast<std::uint32_t>(end - first);
        parts.reset(size);
        joined.reset(size);
        note.resize(size);
        std::fill(note.begin(), note.end(), 0);
        const auto is_here = [&](std::uint64_t v) { return v >= first && v < end; };
        for (; edge != nullptr && edge[0] == chunk_of(first); edge = by_chunk.next()) {
            if (!is_here(edge[2]) || !is_here(edge[3])) {
                const std::uint64_t here = is_here(edge[2]) ? edge[2] : edge[3];
                note[parts.find(static_cast<std::uint32_t>(here - first))] = 1;
                if (is_here(std::min(edge[2], edge[3]))) put(left, {edge[2], edge[1], edge[3]});
                continue;
            }
            const auto a = static_cast<std::uint32_t>(edge[2] - first);
            const auto b = static_cast<std::uint32_t>(edge[3] - first);
            if (!joined.join(a, b)) continue;
            const std::uint32_t one = parts.find(a), two = parts.find(b);
            if (note[one] != 0 && note[two] != 0) {
                put(left, {edge[2], edge[1], edge[3]});
                continue;
            }
            const std::uint64_t is_closed = note[one] | note[two];
            parts.join(one, two);
            note[parts.find(one)] = is_closed;
            put(tree_, {edge[1]});
        }
        // A part is named after its least vertex, so that one gets its number first.
        for (std::uint32_t i = 0; i < size; ++i) {
            const std::uint32_t part = parts.find(i);
            if (part == i) note[i] = next++;
            *numbers.add() = note[part];
        }
    }
    vertices_ = next;
    left.finish();
}

template <int D>
void SpanningTree<D>::renumber(RecordSort &from, RecordSpool &numbers, RecordSort &to) const {
    numbers.rewind();
    std::uint64_t at = 0, number = 0;
    bool is_any = false;
    while (const std::uint64_t *edge = from.next()) {
        for (; !is_any || at < edge[0]; is_any = true) {
            at += is_any;
            number = *numbers.next();
        }
        put(to, {edge[2], edge[1], number});
    }
    to.finish();
}

// ---- The end ----------------------------------------------------------------------------

template <int D> void SpanningTree<D>::finish() {
    DisjointSets parts(host_);
    parts.reset(vertices_);
    while (const std::uint64_t *edge = edges_->next())
        if (parts.join(static_cast<std::uint32_t>(edge[1]), static_cast<std::uint32_t>(edge[2])))
            put(tree_, {edge[0]});
    edges_->close();
    tree_.finish();
}

template <int D> void SpanningTree<D>::report(const Report &report) {
    const std::uint64_t *detail = nullptr;
    std::uint64_t read = 0; // details
    while (const std::uint64_t *rank = tree_.next()) {
        for (; read <= *rank; ++read) detail = details_.next();
        std::int64_t ids[2] = {static_cast<std::int64_t>(detail[0]),
                               static_cast<std::int64_t>(detail[1])};
        if (ids[1] < ids[0]) std::swap(ids[0], ids[1]);
        report(ids, std::bit_cast<double>(detail[2]));
    }
    tree_.close();
    details_.close();
}

template class SpanningTree<2>;
template class SpanningTree<3>;

} // namespace abacus
