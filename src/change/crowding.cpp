#include "change/crowding.hpp"

#include "keys/domain_of.hpp"
#include "mesh/page_attributes.hpp"
#include "mesh/page_format.hpp"
#include "points/spread.hpp"

namespace abacus {

namespace {

constexpr int looks = 32;

/// A key as one number.
using Place = unsigned __int128;
constexpr int part_bits = 63;
Place place_of(const Key &key) { return Place{key.code} << part_bits | key.part; }
Key key_at(Place place) {
    return {static_cast<std::uint64_t>(place >> part_bits),
            static_cast<std::uint64_t>(place) & (key_word_end - 1)};
}

/// A part of the curve.
struct Stretch {
    Place from, to;
    bool operator<(const Stretch &other) const { return to - from < other.to - other.from; }
};

template <int D> class Look {
public:
    Look(const Host &host, const abacus_facts &facts)
        : host_(host), facts_(facts), spread_(host), unseen_(host) {}

    bool at_crowds() {
        unseen_.push_back({place_of(first_key), place_of(end_key)});
        for (int i = 0; i < looks && !unseen_.empty(); ++i)
            if (!next()) break;
        return 2 * crowded_ > pages_ && is_another_better();
    }

private:
    /// Reads a page of the widest stretch; false if there is none, or if it is not where it should
    /// be.
    bool next() {
        Stretch *widest = std::max_element(unseen_.begin(), unseen_.end());
        const Stretch stretch = *widest;
        *widest = unseen_.back();
        unseen_.pop_back();
        const Place middle = stretch.from + (stretch.to - stretch.from) / 2;
        abacus_page page{};
        host_.poll();
        if (!host_.find(ABACUS_SIMPLEX_PAGES, key_at(middle), page)) return false;
        view_.read(page.bytes, page.size, page_attributes(facts_.columns));
        const Place lower = place_of(view_.lower()), upper = place_of(view_.upper());
        if (middle < lower || upper <= middle) return false;
        if (stretch.from < lower) unseen_.push_back({stretch.from, lower});
        if (upper < stretch.to) unseen_.push_back({upper, stretch.to});
        ++pages_;
        if (view_.lower().part == 0 && view_.upper().part == 0) return true;
        ++crowded_;
        for (int vertex = 0; vertex < view_.vertices(); ++vertex) spread_.add(view_.point(vertex));
        return true;
    }
    bool is_another_better() {
        return spread_.is_better(spread_.choose(), domain_box<D>(facts_.form));
    }

    const Host &host_;
    const abacus_facts &facts_;
    Spread<D> spread_; // of the vertices of crowded pages
    Arena<Stretch> unseen_;
    PageView<D> view_;
    int pages_ = 0, crowded_ = 0;
};

} // namespace

template <int D> bool looks_crowded(const Host &host, const abacus_facts &facts) {
    if (facts.census.simplices == 0) return false;
    try {
        return Look<D>(host, facts).at_crowds();
    } catch (const Error &error) {
        if (error.kind != ABACUS_ERROR_CORRUPTED) throw;
        return false; // the next reader of the page says what is wrong with it
    }
}

template bool looks_crowded<2>(const Host &, const abacus_facts &);
template bool looks_crowded<3>(const Host &, const abacus_facts &);

} // namespace abacus
