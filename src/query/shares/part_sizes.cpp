#include "query/shares/part_sizes.hpp"

#include "query/shares/vertex_groups.hpp"
#include "sort/pacer.hpp"

namespace abacus {

namespace {

template <int D> class PartSizes {
public:
    PartSizes(const Host &host, const abacus_facts &facts, const Cut<D> &cut, std::size_t memory)
        : host_(host), facts_(facts), cut_(cut), memory_(memory), pacer_(host), sizes_(host),
          pairs_(host), shared_(host), shared_begin_(host), around_(host),
          rims_(host, 3, memory / 2), facets_(host, D + 1, D + 1, memory / 2) {
        sizes_.resize(cut.pieces());
        std::fill(sizes_.begin(), sizes_.end(), abacus_part{});
        for (std::size_t i = 0; i < cut.pieces(); ++i) {
            sizes_[i].part = cut.piece(i).part;
            sizes_[i].simplices = cut.piece(i).simplices;
        }
    }

    void count() {
        count_vertices();
        count_simplices();
        count_facets();
    }
    const abacus_part &of(std::size_t piece) const { return sizes_[piece]; }

private:
    /// A vertex of a page, and a piece with a simplex of that page at it.
    struct Pair {
        int vertex;
        std::size_t piece;
        bool operator<(const Pair &other) const {
            return vertex < other.vertex || (vertex == other.vertex && piece < other.piece);
        }
        bool operator==(const Pair &) const = default;
    };
    /// A piece at a vertex with simplices of several.
    struct Shared {
        std::size_t piece;
        std::uint64_t rim; // the number of the vertex among all such
    };

    /// Calls visit(page, place) for all pages; `place` is that of its first vertex.
    template <class Visit> void each_page(Visit visit) {
        PageScan<D> scan(host_, facts_);
        std::uint64_t place = 0, done = 0;
        pacer_.begin(ABACUS_PHASE_SCANNING, facts_.census.simplices + facts_.census.ghosts);
        while (scan.advance()) {
            visit(scan.page(), place);
            place += static_cast<std::uint64_t>(scan.page().vertices());
            pacer_.reached(done += static_cast<std::uint64_t>(scan.page().simplices()));
        }
    }
    /// Brings together which pieces have simplices at a vertex.
    void count_vertices() {
        VertexGroups<D> groups(host_, facts_, memory_ / 2);
        each_page([&](const PageView<D> &page, std::uint64_t place) {
            const auto range = cut_.range(page);
            pairs_.clear();
            for (int s = 0; s < page.simplices(); ++s) {
                if (page.is_ghost(s)) continue;
                const std::size_t piece = cut_.piece_of(page, range, s);
                for (int i = 0; i <= D; ++i) pairs_.push_back({page.corner(s, i), piece});
            }
            std::sort(pairs_.begin(), pairs_.end());
            const Pair *const end = std::unique(pairs_.begin(), pairs_.end());
            for (const Pair *p = pairs_.begin(); p < end; ++p)
                groups.add(page, p->vertex, place + static_cast<std::uint64_t>(p->vertex),
                           p->piece);
        });
        groups.finish();
        std::uint64_t rim = 0, done = 0;
        for (;;) {
            const auto &group = groups.next();
            if (group.empty()) break;
            if (++done % Pacer::stride == 0) host_.poll();
            around_.clear();
            for (const auto &word : group) around_.push_back(word.word);
            std::sort(around_.begin(), around_.end());
            const std::uint64_t *const end = std::unique(around_.begin(), around_.end());
            ++sizes_[around_[0]].vertices;
            if (end - around_.begin() == 1) continue;
            std::uint64_t last = ~std::uint64_t{0};
            for (const auto &word : group) {
                if (word.place == last) continue;
                last = word.place;
                for (const std::uint64_t *piece = around_.begin(); piece < end; ++piece) {
                    std::uint64_t *const record = rims_.add();
                    record[0] = word.place;
                    record[1] = *piece;
                    record[2] = rim;
                }
            }
            ++rim;
        }
        groups.close();
        rims_.rewind();
    }
    void count_simplices() {
        each_page([&](const PageView<D> &page, std::uint64_t place) {
            shared_.clear();
            shared_begin_.clear();
            for (int v = 0; v < page.vertices(); ++v) {
                shared_begin_.push_back(shared_.size());
                while (const auto *record = rims_.next(place + static_cast<std::uint64_t>(v)))
                    shared_.push_back({record[1], record[2]});
            }
            shared_begin_.push_back(shared_.size());
            if (shared_.empty()) return;
            const auto range = cut_.range(page);
            for (int s = 0; s < page.simplices(); ++s)
                if (!page.is_ghost(s)) add_simplex(page, s, range);
        });
        rims_.close();
    }
    void add_simplex(const PageView<D> &page, int simplex, const typename Cut<D>::Range &range) {
        std::array<std::span<const Shared>, D + 1> at;
        around_.clear();
        for (int i = 0; i <= D; ++i) {
            const auto v = static_cast<std::size_t>(page.corner(simplex, i));
            at[i] = {shared_.data() + shared_begin_[v], shared_.data() + shared_begin_[v + 1]};
            for (const Shared &shared : at[i]) around_.push_back(shared.piece);
        }
        if (around_.empty()) return;
        const std::size_t own = cut_.piece_of(page, range, simplex);
        std::sort(around_.begin(), around_.end());
        const std::uint64_t *const end = std::unique(around_.begin(), around_.end());
        for (const std::uint64_t *piece = around_.begin(); piece < end; ++piece)
            if (*piece != own) ++sizes_[*piece].halo;
        for (int i = 0; i <= D; ++i) add_facet(at, i, own);
    }
    /// The facet opposite a corner, if another piece may have it as well: it has all its corners.
    void add_facet(const std::array<std::span<const Shared>, D + 1> &at, int opposite,
                   std::size_t own) {
        std::array<std::span<const Shared>, D> corners;
        std::array<std::uint64_t, D> rims;
        for (int i = 0; i < D; ++i) {
            corners[i] = at[i + (i >= opposite)];
            if (corners[i].empty()) return;
            rims[i] = corners[i].front().rim;
        }
        const bool may_be =
            std::any_of(corners[0].begin(), corners[0].end(), [&](const Shared &first) {
                return first.piece != own &&
                       std::all_of(corners.begin() + 1, corners.end(), [&](const auto &others) {
                           return std::any_of(
                               others.begin(), others.end(),
                               [&](const Shared &other) { return other.piece == first.piece; });
                       });
            });
        if (!may_be) return;
        std::sort(rims.begin(), rims.end());
        std::uint64_t *const record = facets_.add();
        std::copy(rims.begin(), rims.end(), record);
        record[D] = own;
    }
    /// A facet between two pieces came from both.
    void count_facets() {
        facets_.finish();
        std::array<std::uint64_t, D + 1> last;
        last.fill(~std::uint64_t{0});
        std::uint64_t done = 0;
        while (const std::uint64_t *const record = facets_.next()) {
            if (++done % Pacer::stride == 0) host_.poll();
            if (std::equal(record, record + D, last.begin()) && record[D] != last[D]) {
                ++sizes_[record[D]].cut_facets;
                ++sizes_[last[D]].cut_facets;
            }
            std::copy_n(record, D + 1, last.begin());
        }
        facets_.close();
    }

    const Host &host_;
    const abacus_facts &facts_;
    const Cut<D> &cut_;
    const std::size_t memory_;
    Pacer pacer_;
    Arena<abacus_part> sizes_; // by piece
    Arena<Pair> pairs_;        // of a page
    Arena<Shared> shared_;     // of the vertices of a page, one after the other
    Arena<std::size_t> shared_begin_;
    Arena<std::uint64_t> around_; // pieces around a vertex or a simplex
    PlacedWords rims_;            // place, piece, number of the vertex
    RecordSort facets_;           // numbers of the corners, piece
};

} // namespace

template <int D>
void part_sizes(const Host &host, const abacus_facts &facts, const Cut<D> &cut, std::size_t memory,
                const std::function<void(const abacus_part &)> &visit) {
    PartSizes<D> sizes(host, facts, cut, memory);
    sizes.count();
    std::size_t piece = 0;
    for (std::uint32_t part = 0; part < cut.parts(); ++part) {
        if (part % Pacer::stride == 0) host.poll();
        abacus_part size{};
        size.part = part;
        if (piece < cut.pieces() && cut.piece(piece).part == part) size = sizes.of(piece++);
        visit(size);
    }
}

template void part_sizes<2>(const Host &, const abacus_facts &, const Cut<2> &, std::size_t,
                            const std::function<void(const abacus_part &)> &);
template void part_sizes<3>(const Host &, const abacus_facts &, const Cut<3> &, std::size_t,
                            const std::function<void(const abacus_part &)> &);

} // namespace abacus
