#include "octree/grow.hpp"

#include "blocks/counters.hpp"
#include "octree/outside.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

namespace abacus {

template <int D> void create_root(const Host &host, abacus_header &header) {
    LeafWriter<D> writer(host, header);
    Arena<double> values(host);
    values.resize(header.facts.columns.attributes);
    std::fill(values.begin(), values.end(), std::numeric_limits<double>::quiet_NaN());
    writer.begin(0, 0);
    writer.add({}, values.data(), true);
    writer.end(key_word_end);
    header.facts.census.leaves = 1;
    header.counters += writer.counters();
}

template <int D> void Growth<D>::add(const Point<D> &place, std::int64_t level) {
    Cell<D> cell;
    if (!grid_.find(place, cell)) throw_outside<D>(place);
    if (level < 0 || level > levels_) throw_no_level(level, levels_);
    std::uint64_t *const record = places_.add();
    record[0] = morton<D>(cell);
    record[1] = static_cast<std::uint64_t>(level);
}

template <int D>
template <class Visit>
void Growth<D>::read(SplitOctants<D> &octants, abacus_header &header, Visit visit) {
    pacer_.begin(ABACUS_PHASE_SCANNING, facts_.census.leaves);
    LeafScan<D> leaves(host_, facts_);
    std::uint64_t done = 0;
    while (leaves.next()) {
        octants.split_to(leaves.leaf().code, leaves.leaf().level);
        visit(leaves.leaf());
        if (++done % Pacer::stride == 0) pacer_.reached(done, {leaves.pages(), 0});
    }
    header.counters.loads += leaves.pages();
    header.counters.bytes_read += leaves.bytes();
}

template <int D> void Growth<D>::expect(double wanted_bytes) const {
    // Memory has room for some of each level.
    constexpr double in_memory = static_cast<double>(finest_level<D> * RecordSpool::piece_bytes);
    const double split = static_cast<double>(facts_.census.leaves - 1) / (Octant<D>::children - 1);
    host_.spool_expect(std::max(0.0, 8 * split - in_memory) + wanted_bytes);
}

template <int D> template <class Each> void Growth<D>::expect_places(Each each) {
    const double most = 8.0 * static_cast<double>(places_.size()) * levels_;
    if (host_.spool_fits(most)) return expect(0);
    LastSplit<D> last;
    std::array<double, finest_level<D>> wanted{};
    each([&](std::uint64_t cell, int level) {
        last.split_to(cell, level, [&](int at, std::uint64_t) { ++wanted[at]; });
    });
    double bytes = 0;
    for (const double octants : wanted) bytes += SplitOctants<D>::spool_bytes(octants);
    expect(bytes);
}

template <int D> template <class SplitTo> void Growth<D>::each_place(SplitTo split_to) {
    places_.rewind();
    while (const std::uint64_t *place = places_.next())
        split_to(place[0], static_cast<int>(place[1]));
}

template <int D> void Growth<D>::to_levels(abacus_header &header) {
    places_.finish();
    if (places_.size() < facts_.census.leaves / leaves_a_place) {
        split_in_place(header);
        return;
    }
    SplitOctants<D> octants(host_), wanted(host_);
    expect_places([this](auto split_to) { this->each_place(split_to); });
    each_place([&](std::uint64_t cell, int level) { wanted.split_to(cell, level); });
    places_.close();
    read(octants, header);
    grow(octants, wanted, header);
}

template <int D> void Growth<D>::split_in_place(abacus_header &header) {
    OctreeCache<D> cache(host_, facts_, memory_ / 2); // the sort has the other half
    pacer_.begin(ABACUS_PHASE_LOCATING, places_.size());
    std::uint64_t done = 0;
    while (const std::uint64_t *place = places_.next()) {
        for (;;) {
            const Handle h = cache.find(place[0]);
            if (cache.octant(h).level >= static_cast<int>(place[1])) break;
            cache.split(h);
            header.facts.census.leaves += Octant<D>::children - 1;
        }
        pacer_.reached(++done, {cache.counters.loads, cache.counters.stores});
    }
    places_.close();
    cache.flush();
    header.counters += cache.counters;
}

template <int D>
template <class SplitTo>
void Growth<D>::each_crowded(RecordSpool &ahead, std::uint64_t most, SplitTo split_to) {
    // An octant has too many points if it has both a point and the one `most` places later.
    ahead.rewind();
    places_.rewind();
    bool is_there = true;
    for (std::uint64_t i = 0; i < most && is_there; ++i) is_there = ahead.next() != nullptr;
    while (is_there) {
        const std::uint64_t *const last = ahead.next();
        if (last == nullptr) break;
        const std::uint64_t cell = places_.next()[0];
        const int crowded = nearest_common<D>(cell, *last).level;
        split_to(cell, std::min(crowded + 1, levels_));
    }
}

template <int D> void Growth<D>::to_points(std::uint64_t most, abacus_header &header) {
    SplitOctants<D> octants(host_), wanted(host_);
    RecordSpool ahead(host_, 1);
    places_.finish();
    host_.spool_expect(ahead.spool_bytes(static_cast<double>(places_.size())));
    while (const std::uint64_t *place = places_.next()) *ahead.add() = place[0];
    expect_places([&](auto split_to) { each_crowded(ahead, most, split_to); });
    each_crowded(ahead, most, [&](std::uint64_t cell, int level) { wanted.split_to(cell, level); });
    ahead.close();
    places_.close();
    read(octants, header);
    grow(octants, wanted, header);
}

template <int D> void Growth<D>::to_balance(int across, abacus_header &header) {
    places_.close();
    SplitOctants<D> octants(host_), balanced(host_);
    expect(0);
    read(octants, header);
    octants.rewind();
    balance<D>(host_, octants, std::min(across, D), memory_, balanced);
    rewrite(balanced, header, [](const Octant<D> &) {});
}

template <int D>
template <class Visit>
void Growth<D>::grow(SplitOctants<D> &octants, SplitOctants<D> &wanted, abacus_header &header,
                     Visit visit) {
    SplitOctants<D> united(host_);
    octants.rewind();
    wanted.rewind();
    unite(octants, wanted, united);
    rewrite(united, header, visit);
}

template <int D>
template <class Visit>
void Growth<D>::rewrite(SplitOctants<D> &octants, abacus_header &header, Visit visit) {
    const std::uint64_t all = 1 + (Octant<D>::children - 1) * octants.size();
    octants.rewind();
    pacer_.begin(ABACUS_PHASE_FLUSHING, all);
    LeafScan<D> before(host_, facts_);
    LeafWriter<D> writer(host_, facts_);
    std::uint64_t leaves = 0;
    const auto turn_page = [&] {
        if (before.pages() > 0) {
            writer.end(before.upper());
            before.pass_page();
        }
        if (!before.next_page()) return false;
        pacer_.reached(leaves, {before.pages(), writer.counters().stores});
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
                    throw_octree_corrupted("Leaves changed while they were being read.");
                // If leaves were merged across a border, some children of a leaf begin on later
                // pages.
                while (leaf.code >= before.upper()) turn_page();
                writer.add(leaf, values, !(leaf == old));
                visit(leaf);
                ++leaves;
            } while (leaf.end() < old.end());
            header.counters.deleted += !(leaf == old);
        }
    octants.close();
    header.facts.census.leaves = leaves;
    header.counters.loads += before.pages();
    header.counters.bytes_read += before.bytes();
    header.counters += writer.counters();
}

// ---- Sizes ---------------------------------------------------------------------

/// Counts the leaves that are longer than a size that was given for a place in them: a thin layer
/// that a large octant has met may lie between the places of smaller ones.
template <int D> class Growth<D>::LongLeaves {
public:
    explicit LongLeaves(Growth &growth)
        : growth_(growth), small_(growth.host_, 2, 1, growth.memory_ / 2) {}

    /// A place in an octant of this level that is split. A leaf there is half as long, or less.
    void add(const Point<D> &place, int level, double size) {
        Cell<D> cell;
        if (!(growth_.grid_.edge(level + 1) > size) || !growth_.grid_.find(place, cell)) return;
        std::uint64_t *const record = small_.add();
        record[0] = morton<D>(cell);
        record[1] = std::bit_cast<std::uint64_t>(size);
    }
    void end() {
        small_.finish();
        next_ = small_.next();
    }
    /// The next leaf along the curve.
    void see(const Octant<D> &leaf) {
        bool is_longer = false;
        for (; next_ != nullptr && next_[0] < leaf.end(); next_ = small_.next())
            is_longer |= growth_.grid_.edge(leaf.level) > std::bit_cast<double>(next_[1]);
        count_ += is_longer;
    }
    std::uint64_t count() {
        small_.close();
        return count_;
    }

private:
    Growth &growth_;
    RecordSort small_; // cell of a place, size
    const std::uint64_t *next_ = nullptr;
    std::uint64_t count_ = 0;
};

/// Asks for the sizes of octants, many at once, and collects the octants to split.
template <int D> class Growth<D>::Asker {
public:
    Asker(Growth &growth, abacus_octree_sizes sizes, void *context, int samples,
          SplitOctants<D> &wanted, LongLeaves &longer)
        : growth_(growth), ask_(sizes), context_(context), samples_(samples), wanted_(wanted),
          longer_(longer), codes_(growth.host_), places_(growth.host_), edges_(growth.host_),
          sizes_(growth.host_) {
        for (int i = 0; i < D; ++i) each_ *= static_cast<std::size_t>(samples);
        places_.resize(D * at_once);
        edges_.resize(at_once);
        sizes_.resize(at_once);
        growth.pacer_.begin(ABACUS_PHASE_READING, 0);
    }

    /// Begins a level, with a spool for its octants that are split.
    void begin(int level, RecordSpool &split) {
        level_ = level;
        split_ = &split;
    }
    void add(std::uint64_t code) {
        const Box<D> box = growth_.grid_.box({code, level_});
        for (std::size_t k = 0; k < each_; ++k, ++count_) {
            std::size_t number = k;
            for (int i = 0; i < D; ++i, number /= samples_) {
                const double share = static_cast<double>(2 * (number % samples_) + 1) /
                                     static_cast<double>(2 * samples_);
                places_[i * at_once + count_] =
                    box.lower[i] + (box.upper[i] - box.lower[i]) * share;
            }
            edges_[count_] = growth_.grid_.edge(level_);
        }
        codes_.push_back(code);
        if (count_ + each_ > at_once) ask();
    }
    /// The level has no more octants.
    void ask();

private:
    static constexpr std::size_t at_once = 4096; // places
    static_assert(ABACUS_MAX_SAMPLES * ABACUS_MAX_SAMPLES * ABACUS_MAX_SAMPLES <= at_once);

    void split(std::size_t octant);

    Growth &growth_;
    abacus_octree_sizes ask_;
    void *context_;
    const std::size_t samples_;
    SplitOctants<D> &wanted_;
    LongLeaves &longer_;
    std::size_t each_ = 1, count_ = 0; // places of an octant, and in all
    Arena<std::uint64_t> codes_;
    Arena<double> places_, edges_, sizes_; // places_ axis by axis
    int level_ = 0;
    RecordSpool *split_ = nullptr;
    std::uint64_t asked_ = 0;
};

template <int D> void Growth<D>::Asker::split(std::size_t octant) {
    wanted_.add(level_, codes_[octant]);
    *split_->add() = codes_[octant];
    for (std::size_t at = octant * each_; at < (octant + 1) * each_; ++at) {
        Point<D> place;
        for (int i = 0; i < D; ++i) place[i] = places_[i * at_once + at];
        longer_.add(place, level_, sizes_[at]);
    }
}

template <int D> void Growth<D>::Asker::ask() {
    const std::size_t n = codes_.size();
    if (n == 0) return;
    const double *places[D];
    for (int i = 0; i < D; ++i) places[i] = places_.data() + i * at_once;
    host::require(ask_(context_, count_, places, edges_.data(), sizes_.data()));
    for (std::size_t k = 0; k < n; ++k) {
        const double *const sizes = sizes_.data() + k * each_;
        if (std::any_of(sizes, sizes + each_,
                        [&](double size) { return edges_[k * each_] > size; }))
            split(k);
    }
    codes_.clear();
    count_ = 0;
    growth_.pacer_.reached(asked_ += n);
}

template <int D>
std::uint64_t Growth<D>::to_sizes(abacus_octree_sizes sizes, void *context, int samples,
                                  abacus_header &header) {
    places_.close();
    SplitOctants<D> octants(host_), leaves(host_), wanted(host_);
    read(octants, header, [&](const Octant<D> &leaf) {
        if (leaf.level < levels_) leaves.add(leaf.level, leaf.code);
    });
    leaves.rewind();
    LongLeaves longer(*this);
    Asker asker(*this, sizes, context, samples, wanted, longer);
    // Level by level: the leaves of the octree, and the children of octants that were split.
    std::array<std::optional<RecordSpool>, 2> splits; // of even and odd levels
    splits[1].emplace(host_, 1);
    for (int level = 0; level < levels_; ++level) {
        RecordSpool &split = splits[1 - level % 2].value();
        asker.begin(level, splits[level % 2].emplace(host_, 1));
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
            asker.add(code);
        }
        asker.ask();
        leaves.close(level);
        split.close();
    }
    for (std::optional<RecordSpool> &split : splits)
        if (split) split->close();
    longer.end();
    grow(octants, wanted, header, [&](const Octant<D> &leaf) { longer.see(leaf); });
    return longer.count();
}

template void create_root<2>(const Host &, abacus_header &);
template void create_root<3>(const Host &, abacus_header &);
template class Growth<2>;
template class Growth<3>;

} // namespace abacus
