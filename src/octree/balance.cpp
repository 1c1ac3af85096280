#include "octree/balance.hpp"

#include "sort/record_sort.hpp"

#include <array>
#include <optional>

namespace abacus {
namespace {

/// The requests of a level's octants to the level above, family by family: siblings follow one
/// another and request almost the same.
template <int D> class Requests {
public:
    Requests(int across, RecordSort &asked, int level) : asked_(asked), level_(level) {
        recent_.fill(SplitOctants<D>::none);
        for (int n = 0; n < ways; ++n) {
            Way &way = ways_[n];
            int moved = 0;
            for (int i = 0, rest = n; i < D; ++i, rest /= 3) {
                way.direction[i] = rest % 3 - 1;
                moved += way.direction[i] != 0;
            }
            // The children that touch a neighbour of the parent in this direction.
            for (int child = 0; child < Octant<D>::children; ++child) {
                bool touches = moved <= across;
                for (int i = 0; i < D; ++i)
                    touches = touches &&
                              (way.direction[i] == 0 || (child >> i & 1) == (way.direction[i] > 0));
                way.children |= touches << child;
            }
        }
    }

    /// Adds the next split octant of the level.
    void add(std::uint64_t code) {
        const Octant<D> octant{code, level_};
        if (octant.parent().code != parent_) {
            ask();
            parent_ = octant.parent().code;
        }
        siblings_ |= 1u << octant.number();
    }
    /// The family has no more octants.
    void ask() {
        if (siblings_ == 0) return;
        const Octant<D> parent{parent_, level_ - 1};
        for (const Way &way : ways_)
            if ((way.children & siblings_) != 0)
                if (const auto neighbour = parent.neighbour(way.direction))
                    ask_for(neighbour->code);
        siblings_ = 0;
    }

private:
    struct Way {
        Direction<D> direction{};
        unsigned children = 0;
    };
    static constexpr int ways = D == 2 ? 9 : 27;
    static constexpr std::size_t remembered = 1024;

    void ask_for(std::uint64_t code) {
        const std::uint64_t mixed =
            (code >> (D * (finest_level<D> - level_ + 1))) * 0x9e3779b97f4a7c15ull;
        std::uint64_t &recent = recent_[mixed >> 54];
        if (recent == code) return;
        recent = code;
        *asked_.add() = code;
    }

    RecordSort &asked_;
    const int level_;
    std::array<Way, ways> ways_{};
    std::uint64_t parent_ = SplitOctants<D>::none;
    unsigned siblings_ = 0; // siblings of the family that are split
    std::array<std::uint64_t, remembered> recent_;
};

} // namespace

template <int D>
void balance(const Host &host, SplitOctants<D> &octants, int across, std::size_t memory,
             SplitOctants<D> &balanced) {
    const std::size_t share = memory / 2;
    Pacer pacer(host);
    pacer.begin(ABACUS_PHASE_SORTING, 0);
    std::uint64_t done = 0;
    std::array<std::optional<RecordSort>, 2> sorts; // of even and odd levels
    for (int level = octants.depth() - 1; level >= 0; --level) {
        std::optional<RecordSort> &asked = sorts[level % 2], &asks = sorts[1 - level % 2];
        asks.emplace(host, 1, 1, share);
        Requests<D> requests(across, *asks, level);
        const std::uint64_t *next = asked ? asked->next() : nullptr;
        std::uint64_t last = SplitOctants<D>::none;
        for (;;) {
            const std::uint64_t wanted = next != nullptr ? *next : SplitOctants<D>::none;
            const std::uint64_t code = std::min(octants.head(level), wanted);
            if (code == SplitOctants<D>::none) break;
            if (octants.head(level) == code) octants.pop(level);
            if (wanted == code) next = asked->next();
            if (code == last) continue;
            last = code;
            balanced.add(level, code);
            if (level > 0) requests.add(code);
            if (++done % Pacer::stride == 0) pacer.reached(done);
        }
        requests.ask();
        octants.close(level);
        if (asked) asked->close();
        asks->finish();
    }
    for (std::optional<RecordSort> &sort : sorts)
        if (sort) sort->close();
}

template void balance<2>(const Host &, SplitOctants<2> &, int, std::size_t, SplitOctants<2> &);
template void balance<3>(const Host &, SplitOctants<3> &, int, std::size_t, SplitOctants<3> &);

} // namespace abacus
