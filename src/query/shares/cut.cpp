#include "query/shares/cut.hpp"

#include "query/shares/page_set.hpp"
#include "sort/pacer.hpp"
#include "sort/record_spool.hpp"

#include <cstring>

namespace abacus {

namespace {

/// A page in the spool: its key, how many simplices it has, and what they weigh.
struct PageSum {
    Key key;
    std::uint64_t simplices;
    ExactSum weights;

    static constexpr std::size_t words(bool is_weighed) {
        return (is_weighed ? sizeof(PageSum) : offsetof(PageSum, weights)) / sizeof(std::uint64_t);
    }
};
static_assert(std::is_trivially_copyable_v<PageSum> && sizeof(PageSum) % 8 == 0);

// How far along the curve one is, and which part the next simplex belongs to. A weight is a sum of
// doubles. reaches(part, weight): whether the middle of the next simplex is not before a part's
// begin. has_reached(part): whether the place before it is not; then no simplex before it reaches
// more.

using Weight = std::span<const double>;

/// By numbers of simplices.
class Counted {
public:
    Counted(std::uint32_t parts, std::uint64_t all) : parts_(parts), all_(all) {}

    bool reaches(std::uint32_t part, Weight) const {
        return (2 * before_ + 1) * parts_ >= Wide{2} * all_ * part;
    }
    bool has_reached(std::uint32_t part) const { return before_ * parts_ >= Wide{all_} * part; }
    void pass(Weight) { ++before_; }
    void pass_page(const PageSum &page) { before_ += page.simplices; }

private:
    using Wide = unsigned __int128;
    std::uint32_t parts_;
    std::uint64_t all_;
    Wide before_ = 0;
};

/// By sums of weights.
class Weighed {
public:
    Weighed(std::uint32_t parts, const ExactSum &all) : parts_(parts), twice_all_(all) {
        twice_all_.add(all);
    }

    bool reaches(std::uint32_t part, Weight weight) const {
        ExactSum middle = before_;
        middle.add(before_);
        for (const double term : weight) middle.add(term);
        return !(middle.times(parts_) < twice_all_.times(part));
    }
    bool has_reached(std::uint32_t part) const { return reaches(part, {}); }
    void pass(Weight weight) {
        for (const double term : weight) before_.add(term);
    }
    void pass_page(const PageSum &page) { before_.add(page.weights); }

private:
    std::uint32_t parts_;
    ExactSum twice_all_, before_;
};

} // namespace

template <int D>
Cut<D>::Cut(const Host &host, const abacus_facts &facts, const abacus_cut &cut, std::size_t memory)
    : host_(host), facts_(facts), cut_(cut), domain_(domain_of<D>(facts.form)),
      weight_(std::in_place, host, facts, cut), pieces_(host), placed_(host) {
    const std::uint64_t most = std::min<std::uint64_t>(cut.parts, facts.census.simplices);
    if (most * (sizeof(Piece) + sizeof(abacus_part)) > memory)
        throw Error(ABACUS_ERROR_LIMIT,
                    "the memory of a query is too small for " + std::to_string(cut.parts) +
                        " parts",
                    "What is known of " + std::to_string(most) + " parts takes " +
                        std::to_string(most * (sizeof(Piece) + sizeof(abacus_part)) >> 10) + " kB.",
                    "Cut the mesh into fewer parts, or increase work_mem.");
    const bool is_weighed = cut.weight != ABACUS_WEIGHT_ONE;
    const std::size_t words = PageSum::words(is_weighed);
    RecordSpool spool(host, words);
    Pacer pacer(host);
    pacer.begin(ABACUS_PHASE_SCANNING, facts.census.simplices);
    std::uint64_t simplices = 0;
    ExactSum weights;
    boxes_.emplace(host, facts, box_bytes, [&](const PageView<D> &page) {
        PageSum sum{page.lower(), 0, {}};
        weight_->enter(page);
        for (int s = 0; s < page.simplices(); ++s) {
            if (page.is_ghost(s)) continue;
            ++sum.simplices;
            if (is_weighed)
                for (const double term : weight_->of(s)) sum.weights.add(term);
        }
        std::memcpy(spool.add(), &sum, words * sizeof(std::uint64_t));
        weights.add(sum.weights);
        pacer.reached(simplices += sum.simplices);
    });
    if (simplices != facts.census.simplices)
        throw_corrupted("The header counts more or fewer simplices than the pages hold.");
    spool.rewind();
    // Without any weight, simplices count.
    if (is_weighed && !weights.is_zero()) {
        Weighed course(cut.parts, weights);
        cut_pages(spool, words, course);
    } else {
        Counted course(cut.parts, simplices);
        cut_pages(spool, words, course);
    }
    spool.close();
    weight_.reset();
    placed_.reset();
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        pieces_[i].simplices =
            (i + 1 < pieces_.size() ? pieces_[i + 1].first : simplices) - pieces_[i].first;
}

template <int D>
template <class Course>
void Cut<D>::cut_pages(RecordSpool &spool, std::size_t words, Course course) {
    std::uint64_t before = 0;
    while (const std::uint64_t *const record = spool.next()) {
        PageSum page{};
        std::memcpy(static_cast<void *>(&page), record, words * sizeof *record);
        Course end = course;
        end.pass_page(page);
        const std::uint32_t next = pieces_.empty() ? 0 : pieces_.back().part + 1;
        if (page.simplices > 0 && next < cut_.parts && end.has_reached(next))
            cut_page(page.key, before, course);
        course = end;
        before += page.simplices;
    }
}

/// A page in which parts may begin.
template <int D>
template <class Course>
void Cut<D>::cut_page(const Key &key, std::uint64_t before, Course course) {
    const PageRead<D> read(host_, facts_, key);
    const PageView<D> &page = read.page();
    weight_->enter(page);
    placed_.clear();
    for (int s = 0; s < page.simplices(); ++s)
        if (!page.is_ghost(s)) placed_.push_back({place_of(page, s, domain_), s});
    std::sort(placed_.begin(), placed_.end(),
              [](const Placed &a, const Placed &b) { return a.place < b.place; });
    for (const Placed &placed : placed_) {
        const Weight weight = weight_->of(placed.simplex);
        const std::uint32_t next = pieces_.empty() ? 0 : pieces_.back().part + 1;
        if (next < cut_.parts && (next == 0 || course.reaches(next, weight))) {
            std::uint32_t part = next, above = cut_.parts; // the greatest that it reaches
            while (above - part > 1) {
                const std::uint32_t middle = part + (above - part) / 2;
                (course.reaches(middle, weight) ? part : above) = middle;
            }
            pieces_.push_back({part, before, 0, placed.place});
        }
        course.pass(weight);
        ++before;
    }
}

template <int D> std::optional<std::size_t> Cut<D>::piece_of(std::uint32_t part) const {
    const Piece *const found = std::partition_point(
        pieces_.begin(), pieces_.end(), [part](const Piece &piece) { return piece.part < part; });
    if (found == pieces_.end() || found->part != part) return {};
    return static_cast<std::size_t>(found - pieces_.begin());
}

/// The last piece that begins before a key.
template <int D> std::size_t Cut<D>::last_before(const Key &key) const {
    const Piece *const found =
        std::partition_point(pieces_.begin() + 1, pieces_.end(),
                             [&key](const Piece &piece) { return piece.begin.key < key; });
    return static_cast<std::size_t>(found - pieces_.begin()) - 1;
}

template <int D> typename Cut<D>::Range Cut<D>::range(const PageView<D> &page) const {
    return {last_before(page.lower()), last_before(page.upper())};
}

template <int D>
std::size_t Cut<D>::piece_of(const PageView<D> &page, const Range &range, int simplex) const {
    if (range.first == range.last) return range.first;
    const CurvePlace<D> place = place_of(page, simplex, domain_);
    const Piece *const found =
        std::partition_point(pieces_.begin() + static_cast<std::ptrdiff_t>(range.first + 1),
                             pieces_.begin() + static_cast<std::ptrdiff_t>(range.last + 1),
                             [&place](const Piece &piece) { return !(place < piece.begin); });
    return static_cast<std::size_t>(found - pieces_.begin()) - 1;
}

template <int D> typename Cut<D>::Range Cut<D>::boxes_of(std::size_t piece) const {
    const std::size_t next = piece + 1;
    return {piece == 0 ? 0 : boxes_->of(pieces_[piece].begin.key),
            next < pieces_.size() ? boxes_->of(pieces_[next].begin.key) : boxes_->size() - 1};
}

template class Cut<2>;
template class Cut<3>;

} // namespace abacus
