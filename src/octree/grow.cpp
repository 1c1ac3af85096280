#include "octree/grow.hpp"

#include "octree/outside.hpp"

#include <limits>
#include <optional>

namespace abacus {

template <int D> void create_root(const Host &host, abacus_header &header) {
    LeafWriter<D> writer(host, header);
    Arena<double> values(host);
    values.resize(header.attributes);
    std::fill(values.begin(), values.end(), std::numeric_limits<double>::quiet_NaN());
    writer.begin(0, 0);
    writer.add({}, values.data(), true);
    writer.end(key_word_end);
    header.leaves = 1;
}

template <int D> void Growth<D>::add(const Point<D> &place, std::int64_t level) {
    Cell<D> cell;
    if (!grid_.find(place, cell)) throw_outside<D>(place);
    if (level < 0 || level > levels_) throw_no_level(level, levels_);
    std::uint64_t *const record = places_.add();
    if (places_.size() % (16 * Pacer::stride) == 1)
        host_.progress({ABACUS_PHASE_READING, places_.size(), 0, 0, 0, 0});
    record[0] = morton<D>(cell);
    record[1] = static_cast<std::uint64_t>(level);
}

template <int D> void Growth<D>::read(SplitOctants<D> &octants) {
    LeafScan<D> leaves(host_, header_);
    while (leaves.next()) octants.split_to(leaves.leaf().code, leaves.leaf().level);
    octants.rewind();
}

template <int D> void Growth<D>::to_levels(abacus_header &header) {
    places_.finish();
    if (places_.size() < header_.leaves / leaves_a_place) {
        split_in_place(header);
        return;
    }
    SplitOctants<D> wanted(host_);
    while (const std::uint64_t *place = places_.next())
        wanted.split_to(place[0], static_cast<int>(place[1]));
    places_.close();
    grow(wanted, header);
}

template <int D> void Growth<D>::split_in_place(abacus_header &header) {
    OctreeCache<D> cache(host_, header_, memory_ / 2); // the sort has the other half
    while (const std::uint64_t *place = places_.next()) {
        for (;;) {
            const Handle h = cache.find(place[0]);
            if (cache.octant(h).level >= static_cast<int>(place[1])) break;
            cache.split(h);
            header.leaves += Octant<D>::children - 1;
        }
        host_.poll();
    }
    places_.close();
    cache.flush();
    add_counters(cache.counters, header);
}

template <int D> void Growth<D>::to_points(std::uint64_t most, abacus_header &header) {
    // An octant has too many points if it has one and the one that comes `most` later.
    SplitOctants<D> wanted(host_);
    RecordSpool ahead(host_, 1);
    places_.finish();
    while (const std::uint64_t *place = places_.next()) *ahead.add() = place[0];
    ahead.rewind();
    places_.rewind();
    bool is_there = true;
    for (std::uint64_t i = 0; i < most && is_there; ++i) is_there = ahead.next() != nullptr;
    while (is_there) {
        const std::uint64_t *const last = ahead.next();
        if (last == nullptr) break;
        const std::uint64_t cell = places_.next()[0];
        const int crowded = nearest_common<D>(cell, *last).level;
        wanted.split_to(cell, std::min(crowded + 1, levels_));
    }
    ahead.close();
    places_.close();
    grow(wanted, header);
}

template <int D> void Growth<D>::to_balance(int across, abacus_header &header) {
    places_.close();
    SplitOctants<D> octants(host_), balanced(host_);
    read(octants);
    balance<D>(host_, octants, std::min(across, D), memory_, balanced);
    balanced.rewind();
    rewrite(balanced, header);
}

template <int D> void Growth<D>::grow(SplitOctants<D> &wanted, abacus_header &header) {
    SplitOctants<D> octants(host_), united(host_);
    read(octants);
    wanted.rewind();
    unite(octants, wanted, united);
    united.rewind();
    rewrite(united, header);
}

template <int D> void Growth<D>::rewrite(SplitOctants<D> &octants, abacus_header &header) {
    LeafScan<D> before(host_, header_);
    LeafWriter<D> writer(host_, header_);
    std::uint64_t leaves = 0;
    const auto turn_page = [&] {
        if (before.pages() > 0) writer.end(before.upper());
        if (!before.next_page()) return false;
        if (before.pages() % 64 == 1)
            host_.progress({ABACUS_PHASE_FLUSHING, leaves, 0, before.pages(), writer.pages(), 0});
        writer.begin(before.lower(), before.location());
        return true;
    };
    while (turn_page())
        while (before.has_more() && before.next()) {
            const Octant<D> old = before.leaf();
            const double *const values = before.values();
            Octant<D> leaf;
            do {
                if (!octants.next_leaf(leaf) || !old.contains(leaf.code))
                    throw_octree_corrupted("Leaves have changed while they were read.");
                // Of leaves merged across a border: some of its children begin on later pages.
                while (leaf.code >= before.upper()) turn_page();
                writer.add(leaf, values, !(leaf == old));
                ++leaves;
            } while (leaf.end() < old.end());
        }
    octants.close();
    header.leaves = leaves;
    header.counters.loads += before.pages();
    header.counters.stores += writer.pages();
    header.counters.bytes_written += writer.bytes();
}

// ---- Sizes ---------------------------------------------------------------------

/// Octants that are asked for together, and those among them that are to be split.
template <int D> struct Growth<D>::Asker {
    static constexpr std::size_t at_once = 4096;

    Asker(const Host &host) : codes(host), centers(host), edges(host), sizes(host) {
        centers.resize(D * at_once);
        edges.resize(at_once);
        sizes.resize(at_once);
    }

    Arena<std::uint64_t> codes;
    Arena<double> centers, edges, sizes;
};

template <int D>
void Growth<D>::to_sizes(abacus_octree_sizes sizes, void *context, abacus_header &header) {
    places_.close();
    SplitOctants<D> leaves(host_), wanted(host_);
    {
        LeafScan<D> scan(host_, header_);
        while (scan.next())
            if (scan.leaf().level < levels_) leaves.add(scan.leaf().level, scan.leaf().code);
    }
    leaves.rewind();
    Asker asker(host_);
    RecordSpool *children_to = nullptr;
    const auto ask = [&](int level) {
        const std::size_t n = asker.codes.size();
        if (n == 0) return;
        const double *centers[D];
        for (int i = 0; i < D; ++i) centers[i] = asker.centers.data() + i * Asker::at_once;
        for (std::size_t k = 0; k < n; ++k) {
            const Point<D> center = grid_.center({asker.codes[k], level});
            for (int i = 0; i < D; ++i) asker.centers[i * Asker::at_once + k] = center[i];
            asker.edges[k] = grid_.edge(level);
        }
        host::require(sizes(context, n, centers, asker.edges.data(), asker.sizes.data()));
        for (std::size_t k = 0; k < n; ++k)
            if (asker.edges[k] > asker.sizes[k]) {
                wanted.add(level, asker.codes[k]);
                *children_to->add() = asker.codes[k];
            }
        asker.codes.clear();
        host_.poll();
    };
    // Level by level: the leaves that there were, and the children of what was split.
    std::array<std::optional<RecordSpool>, 2> splits; // of even and odd levels
    splits[1].emplace(host_, 1);
    for (int level = 0; level < levels_; ++level) {
        RecordSpool &split = splits[1 - level % 2].value();
        children_to = &splits[level % 2].emplace(host_, 1);
        split.rewind();
        const std::uint64_t *parent = split.next();
        Octant<D> family = parent != nullptr ? Octant<D>{*parent, level - 1} : Octant<D>{};
        int child = 0;
        for (;;) {
            const std::uint64_t made =
                parent != nullptr ? family.child(child).code : SplitOctants<D>::none;
            const std::uint64_t code = std::min(made, leaves.head(level));
            if (code == SplitOctants<D>::none) break;
            if (code == made && ++child == Octant<D>::children) {
                parent = split.next();
                if (parent != nullptr) family.code = *parent;
                child = 0;
            } else if (code != made) {
                leaves.pop(level);
            }
            asker.codes.push_back(code);
            if (asker.codes.size() == Asker::at_once) ask(level);
        }
        ask(level);
        leaves.close(level);
        split.close();
    }
    for (std::optional<RecordSpool> &split : splits)
        if (split) split->close();
    grow(wanted, header);
}

template void create_root<2>(const Host &, abacus_header &);
template void create_root<3>(const Host &, abacus_header &);
template class Growth<2>;
template class Growth<3>;

} // namespace abacus
