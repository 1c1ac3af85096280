#include "thin/thinning.hpp"

#include "geometry/in_words.hpp"
#include "keys/domain_of.hpp"
#include "points/record.hpp"
#include "thin/batch.hpp"
#include "thin/extremes.hpp"

#include <limits>

namespace abacus {

namespace {

constexpr std::uint64_t without_limit = std::numeric_limits<std::uint64_t>::max();

unsigned carried_attributes(const abacus_facts &facts) {
    return static_cast<unsigned>(page_attributes(facts.columns));
}

} // namespace

template <int D>
Thinning<D>::Thinning(const Host &host, const abacus_facts &facts,
                      const abacus_thin_options &options)
    : host_(host), options_(options), domain_(domain_of<D>(facts.form)),
      attributes_(facts.columns.attributes),
      vertex_words_(Candidate<D>::vertex_words(carried_attributes(facts))),
      stride_(Candidate<D>::head_words + vertex_words_), due_(host, domain_),
      outside_(host, domain_), record_(host), kept_(host), is_known_(host) {
    record_.resize(record_words(D, attributes_));
}

template <int D> typename Finder<D>::Options Thinning<D>::finder_options() const {
    return {static_cast<int>(options_.attribute), options_.max_error, vertex_words_,
            options_.cache_bytes};
}

template <int D>
void Thinning<D>::add(const Source &source, const std::uint64_t *vertex, Stage<D> &stage) {
    record_[0] = vertex[0];
    std::copy_n(vertex + 1, D, record_.data() + 1);
    source.attributes_of(vertex, reinterpret_cast<double *>(record_.data() + 1 + D));
    stage.add(record_.data(), 1);
}

/// Its files end with it.
template <int D> void Thinning<D>::forget_chosen() {
    if (chosen_) chosen_->close();
    chosen_.reset();
}

template <int D> void Thinning<D>::begin_to_choose() {
    forget_chosen();
    chosen_.emplace(host_, chosen_head + stride_, chosen_head, options_.sort_bytes / 2);
}

template <int D> std::uint64_t *Thinning<D>::choose(const std::uint64_t *vertex, double error) {
    const Point<D> p = vertex_point<D>(vertex);
    std::uint64_t *const words = chosen_->add();
    words[0] = ~ordered(error); // the largest first
    words[1] = domain_.code(p);
    put_ordered(words + 2, p);
    std::copy_n(vertex, vertex_words_, words + chosen_head + Candidate<D>::head_words);
    return words + chosen_head;
}

template <int D>
std::uint64_t Thinning<D>::find(abacus_thin_step step, const Host &source_host,
                                const abacus_facts &source, const abacus_facts &facts,
                                Stage<D> &stage) {
    found_ = step;
    switch (step) {
    case ABACUS_THIN_START:
        return start(source_host, source, stage);
    case ABACUS_THIN_HULL:
        if (done_ != ABACUS_THIN_HULL) due_.fill();
        return rise(Finder<D>::Aim::outside, source_host, source, facts, stage);
    case ABACUS_THIN_BORDER:
    case ABACUS_THIN_LINES:
    case ABACUS_THIN_KEEP:
        return keep(step, source_host, source, facts, stage);
    case ABACUS_THIN_WORST:
        break;
    }
    if (done_ != ABACUS_THIN_WORST) due_.fill();
    return rise(Finder<D>::Aim::misfits, source_host, source, facts, stage);
}

template <int D> void Thinning<D>::inserted(const abacus_facts &facts) {
    done_ = found_;
    if (!chosen_) return;
    if (found_ == ABACUS_THIN_WORST) {
        due_.clear();
        Reader<D> reader(host_, facts, options_.cache_bytes);
        Cache<D> &cache = reader.cache();
        chosen_->rewind();
        while (const std::uint64_t *words = chosen_->next()) {
            host_.poll();
            reader.containing(point_from_ordered<D>(words + 2), [&](Handle h) {
                Box<D> box;
                for (const VertexIndex v : cache.simplex(h).vertex) box.extend(cache.point(v));
                due_.add(box);
            });
        }
    }
    forget_chosen();
}

// ---- Steps -------------------------------------------------------------------------------

template <int D>
std::uint64_t Thinning<D>::start(const Host &source_host, const abacus_facts &source,
                                 Stage<D> &stage) {
    Extremes<D> extremes(source_host, source, options_.attribute, vertex_words_);
    extremes.find();
    const Source vertices(source_host, source, options_.attribute);
    for (std::size_t i = 0; i < extremes.size(); ++i) add(vertices, extremes.vertex(i), stage);
    return extremes.size();
}

namespace {

bool is_on_border(const auto &page, int simplex, int corner) {
    return page.is_ghost(simplex) && page.corner(simplex, corner) != page.vertices();
}

template <int D> bool is_on_line(const PageView<D> &page, int simplex, int corner) {
    if (page.is_ghost(simplex)) return false;
    for (int facet = 0; facet <= D; ++facet)
        if (facet != corner && page.fixed(simplex).is_fixed(facet)) return true;
    return false;
}

/// Calls visit(vertex) for the vertices of a page on the border or on lines, some of them several
/// times.
template <int D, class Visit>
void each_at(abacus_thin_step step, const PageView<D> &page, Visit visit) {
    for (int s = 0; s < page.simplices(); ++s)
        for (int i = 0; i <= D; ++i)
            if (step == ABACUS_THIN_LINES ? is_on_line<D>(page, s, i) : is_on_border(page, s, i))
                visit(page.corner(s, i));
}

} // namespace

template <int D> void Thinning<D>::set_kept(const std::int64_t *ids, std::size_t count) {
    kept_.resize(count);
    std::copy_n(ids, count, kept_.data());
    std::sort(kept_.begin(), kept_.end());
    kept_.resize(static_cast<std::size_t>(std::unique(kept_.begin(), kept_.end()) - kept_.begin()));
    is_known_.resize(kept_.size());
    std::fill(is_known_.begin(), is_known_.end(), std::uint8_t{0});
}

template <int D> std::uint64_t Thinning<D>::unknown_ids() const {
    return static_cast<std::uint64_t>(std::count(is_known_.begin(), is_known_.end(), 0));
}

template <int D> bool Thinning<D>::is_kept_id(std::int64_t id) {
    const auto *const at = std::lower_bound(kept_.begin(), kept_.end(), id);
    if (at == kept_.end() || *at != id) return false;
    is_known_[static_cast<std::size_t>(at - kept_.begin())] = 1;
    return true;
}

template <int D>
std::uint64_t Thinning<D>::keep(abacus_thin_step step, const Host &source_host,
                                const abacus_facts &source, const abacus_facts &facts,
                                Stage<D> &stage) {
    begin_to_choose();
    Source vertices(source_host, source, options_.attribute);
    Arena<std::uint64_t> kept(host_);
    kept.resize(vertex_words_);
    const PageView<D> &page = vertices.page();
    const auto take = [&](int vertex) {
        if (!std::isnan(vertices.value(vertex))) {
            vertices.put(kept.data(), vertex);
            choose(kept.data(), 0);
        } else if (step == ABACUS_THIN_LINES) {
            throw Error(ABACUS_ERROR_STATE,
                        "the vertex at " + in_words(page.point(vertex)) +
                            " is on a line and has no value",
                        {},
                        "Give it a value with abacus_update(), or leave the lines out with keep => "
                        "'none'.");
        }
    };
    while (vertices.advance()) {
        if (step != ABACUS_THIN_KEEP) {
            each_at<D>(step, page, take);
            continue;
        }
        for (int v = 0; v < page.vertices(); ++v)
            if (is_kept_id(page.id(v))) take(v);
    }
    chosen_->finish();
    Reader<D> reader(host_, facts, options_.cache_bytes);
    return hand_out(source_host, source, without_limit, stage, &reader);
}

template <int D>
std::uint64_t Thinning<D>::rise(Aim aim, const Host &source_host, const abacus_facts &source,
                                const abacus_facts &facts, Stage<D> &stage) {
    const bool has_target = aim == Finder<D>::Aim::misfits && options_.target != 0;
    const std::uint64_t room = !has_target ? without_limit
                               : options_.target > facts.census.vertices
                                   ? options_.target - facts.census.vertices
                                   : 0;
    if (room == 0) return 0;
    RecordSort candidates(host_, stride_, Candidate<D>::key_words, options_.sort_bytes / 2);
    outside_.clear();
    look(aim, source_host, source, facts,
         [&](const std::uint64_t *words) { std::copy_n(words, stride_, candidates.add()); });
    due_.swap(outside_);
    candidates.finish();
    begin_to_choose();
    choose_worst(candidates, has_target);
    candidates.close();
    chosen_->finish();
    return hand_out(source_host, source, room, stage, nullptr);
}

/// Looks at the vertices in cells that are due; notes the cells of those outside.
template <int D>
template <class Found>
double Thinning<D>::look(Aim aim, const Host &source_host, const abacus_facts &source,
                         const abacus_facts &facts, Found found) {
    Batch<D> batch(host_, facts, finder_options(), aim);
    const auto look_at_batch = [&] {
        batch.look(
            [&](const std::uint64_t *vertex) {
                if (aim != Finder<D>::Aim::outside)
                    throw Error(ABACUS_ERROR_STATE, "a vertex lies outside of the thinned mesh", {},
                                "Drop the thinned mesh, and thin anew.");
                outside_.add(vertex_point<D>(vertex));
            },
            found);
    };
    Source vertices(source_host, source, options_.attribute);
    while (vertices.advance([&](const Box<D> &box) { return due_.meets(box); }))
        for (int v = 0; v < vertices.page().vertices(); ++v) {
            if (!due_.has(vertices.page().point(v)) || std::isnan(vertices.value(v))) continue;
            vertices.put(batch.add(), v);
            if (batch.is_full()) look_at_batch();
        }
    look_at_batch();
    batch.finish(found);
    return batch.greatest();
}

template <int D> void Thinning<D>::choose_worst(RecordSort &candidates, bool with_errors) {
    constexpr std::size_t key = Candidate<D>::key_words;
    Arena<std::uint64_t> worst(host_);
    const auto choose_it = [&] {
        const std::uint64_t *const vertex = Candidate<D>::vertex(worst.data());
        const double error =
            with_errors ? exact::misfit<D>(Candidate<D>::piece(worst.data()),
                                           vertex_point<D>(vertex), vertex_value<D>(vertex))
                        : 0;
        std::copy_n(worst.data(), Candidate<D>::head_words, choose(vertex, error));
    };
    while (const std::uint64_t *words = candidates.next()) {
        host_.poll();
        if (!worst.empty() && std::equal(words, words + key, worst.data())) {
            if (!comes_first<D>(Candidate<D>::piece(words), Candidate<D>::is_ghost(words),
                                Candidate<D>::vertex(words), Candidate<D>::vertex(worst.data())))
                continue;
        } else if (!worst.empty()) {
            choose_it();
        }
        worst.resize(stride_);
        std::copy_n(words, stride_, worst.data());
    }
    if (!worst.empty()) choose_it();
}

// ---- Chosen vertices ---------------------------------------------------------------------

namespace {

/// Chosen vertices with the same error as a double, in the exact order, each once.
template <int D> class Equals {
public:
    Equals(const Host &host, std::size_t stride, std::size_t head)
        : stride_(stride), head_(head), words_(host), order_(host) {}

    void add(const std::uint64_t *words) { std::copy_n(words, stride_, words_.extend(stride_)); }
    bool empty() const { return words_.empty(); }
    std::uint64_t error() const { return words_[0]; }
    void clear() { words_.clear(); }
    std::size_t size() const { return words_.size() / stride_; }
    /// Calls visit(words) for each.
    template <class Visit> void each(Visit visit) {
        order_.clear();
        for (std::size_t i = 0; i < size(); ++i) order_.push_back(words_.data() + i * stride_);
        std::sort(order_.begin(), order_.end(),
                  [&](const std::uint64_t *a, const std::uint64_t *b) { return is_before(a, b); });
        for (const std::uint64_t *words : order_) visit(words);
    }

private:
    bool is_before(const std::uint64_t *a, const std::uint64_t *b) const {
        const std::uint64_t *const v = Candidate<D>::vertex(a + head_), *const w =
                                                                            Candidate<D>::vertex(
                                                                                b + head_);
        const Point<D> p = vertex_point<D>(v), q = vertex_point<D>(w);
        const int order =
            exact::compare_misfits<D>(Candidate<D>::piece(a + head_), p, vertex_value<D>(v),
                                      Candidate<D>::piece(b + head_), q, vertex_value<D>(w));
        return order != 0 ? order > 0 : lexicographically_less<D>(p, q);
    }

    const std::size_t stride_, head_;
    Arena<std::uint64_t> words_;
    Arena<const std::uint64_t *> order_;
};

} // namespace

template <int D>
std::uint64_t Thinning<D>::hand_out(const Host &source_host, const abacus_facts &source,
                                    std::uint64_t room, Stage<D> &stage, Reader<D> *without) {
    const Source vertices(source_host, source, options_.attribute);
    std::uint64_t added = 0;
    std::optional<Point<D>> before;
    const auto add_once = [&](const std::uint64_t *words) {
        const Point<D> p = point_from_ordered<D>(words + 2);
        if (before == p || added == room) return;
        before = p;
        if (without != nullptr && without->vertex_at(p)) return;
        add(vertices, Candidate<D>::vertex(words + chosen_head), stage);
        ++added;
    };
    if (room == without_limit || chosen_->size() <= room) {
        while (const std::uint64_t *words = chosen_->next()) {
            host_.poll();
            add_once(words);
        }
        return added;
    }
    Equals<D> equals(host_, chosen_head + stride_, chosen_head);
    while (const std::uint64_t *words = chosen_->next()) {
        host_.poll();
        if (!equals.empty() && equals.error() != words[0]) {
            equals.each(add_once);
            equals.clear();
            if (added == room) break;
        }
        equals.add(words);
    }
    equals.each(add_once);
    return added;
}

// ---- The proof ---------------------------------------------------------------------------

template <int D>
typename Thinning<D>::Greatest Thinning<D>::greatest(const Host &source_host,
                                                     const abacus_facts &source,
                                                     const abacus_facts &facts) {
    forget_chosen();
    done_.reset();
    due_.fill();
    const double error =
        look(Finder<D>::Aim::greatest, source_host, source, facts, [](const std::uint64_t *) {});
    return {error, count_without_value(source_host, source)};
}

template <int D>
std::uint64_t Thinning<D>::count_without_value(const Host &source_host,
                                               const abacus_facts &source) {
    RecordSort places(host_, D, D, options_.sort_bytes / 2);
    Source vertices(source_host, source, options_.attribute);
    while (vertices.advance())
        for (int v = 0; v < vertices.page().vertices(); ++v)
            if (std::isnan(vertices.value(v))) put_ordered(places.add(), vertices.page().point(v));
    places.finish();
    std::uint64_t count = 0;
    std::array<std::uint64_t, D> before;
    before.fill(~std::uint64_t{0});
    while (const std::uint64_t *words = places.next()) {
        host_.poll();
        count += std::equal(before.begin(), before.end(), words) ? 0 : 1;
        std::copy_n(words, D, before.begin());
    }
    places.close();
    return count;
}

template class Thinning<2>;
template class Thinning<3>;

} // namespace abacus
