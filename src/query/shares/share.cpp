#include "query/shares/share.hpp"

#include "query/pages/page_simplex.hpp"
#include "sort/dense_ranks.hpp"

namespace abacus {

template <int D>
Share<D>::Share(const Host &host, const abacus_facts &facts, const Cut<D> &cut, std::size_t own,
                std::uint32_t halo, std::size_t memory)
    : host_(host), facts_(facts), cut_(cut), own_(own), halo_(halo), memory_(memory), names_(facts),
      vertex_values_(host, facts), reached_(host, facts_, cut.boxes()),
      known_(host, facts_, cut.boxes()) {
    const auto boxes = cut.boxes_of(own);
    for (std::size_t i = boxes.first; i <= boxes.last; ++i) reached_.add(i);
    known_.add_all(reached_);
    for (;; ++layer_) {
        reach();
        const bool is_larger = join();
        if (layer_ == halo || !is_larger) break;
        former_ = is_in; // of the answers so far, for the next layer
    }
    former_ = was_in;
}

template <int D> template <class Visit> void Share<D>::each_known(Visit visit) {
    place_ = 0;
    if (answers_) answers_->rewind();
    known_.each([&](const PageView<D> &page, std::size_t box) {
        enter(page, box);
        visit(page);
    });
}

template <int D> void Share<D>::enter(const PageView<D> &page, std::size_t box) {
    range_ = cut_.range(page);
    std::fill_n(answer_.begin(), page.vertices(), 0);
    if (!answers_ || !known_.has(box)) return;
    for (int v = 0; v < page.vertices(); ++v)
        if (const auto *record = answers_->next(place_ + static_cast<std::uint64_t>(v)))
            answer_[v] = record[1];
    place_ += static_cast<std::uint64_t>(page.vertices());
}

/// The simplices at a vertex of V(k - 1); for k = 0, those of the part.
template <int D> bool Share<D>::is_member(const PageView<D> &page, int simplex) const {
    if (page.is_ghost(simplex)) return false;
    if (layer_ == 0) return cut_.piece_of(page, range_, simplex) == own_;
    for (int i = 0; i <= D; ++i)
        if ((answer_[page.corner(simplex, i)] & former_) != 0) return true;
    return false;
}

template <int D> void Share<D>::find_members(const PageView<D> &page) {
    std::fill_n(in_.begin(), page.vertices(), false);
    for (int s = 0; s < page.simplices(); ++s)
        if (is_member(page, s))
            for (int i = 0; i <= D; ++i) in_[page.corner(s, i)] = true;
}

template <int D> void Share<D>::reach() {
    each_known([&](const PageView<D> &page) {
        find_members(page);
        Box<D> box;
        for (int v = 0; v < page.vertices(); ++v)
            if (in_[v]) box.extend(page.point(v));
        if (reached_.has_all(box)) return; // as in the middle of a part
        for (int v = 0; v < page.vertices(); ++v)
            if (in_[v]) reached_.add_around({page.point(v), page.point(v)});
    });
}

template <int D> bool Share<D>::join() {
    VertexGroups<D> groups(host_, facts_, memory_ / 2);
    std::uint64_t place = 0;
    place_ = 0;
    if (answers_) answers_->rewind();
    std::array<std::uint64_t, page_vertices<D> + 1> piece;
    reached_.each([&](const PageView<D> &page, std::size_t box) {
        enter(page, box);
        find_members(page);
        std::fill_n(piece.begin(), page.vertices(), no_piece);
        for (int s = 0; s < page.simplices(); ++s) {
            if (page.is_ghost(s)) continue;
            const std::uint64_t here = cut_.piece_of(page, range_, s);
            for (int i = 0; i <= D; ++i) {
                std::uint64_t &least = piece[page.corner(s, i)];
                least = std::min(least, here);
            }
        }
        for (int v = 0; v < page.vertices(); ++v, ++place) {
            if (piece[v] == no_piece) continue; // of ghosts alone
            groups.add(page, v, place,
                       piece[v] << piece_shift | ((answer_[v] & is_in) != 0 ? was_in : 0) |
                           (in_[v] ? is_in : 0));
        }
    });
    groups.finish();
    if (answers_) answers_->close();
    answers_.emplace(host_, 2, memory_ / 4);
    std::uint64_t done = 0;
    bool is_larger = false;
    for (;;) {
        const auto &group = groups.next();
        if (group.empty()) break;
        if (++done % Pacer::stride == 0) host_.poll();
        std::uint64_t flags = 0, least = no_piece;
        for (const auto &word : group) {
            flags |= word.word & (is_in | was_in);
            least = std::min(least, word.word >> piece_shift);
        }
        if ((flags & is_in) == 0) continue;
        is_larger |= (flags & was_in) == 0;
        bool first = true;
        for (const auto &word : group) {
            std::uint64_t *const record = answers_->add();
            record[0] = word.place;
            record[1] = least << piece_shift | flags | (first ? is_first : 0);
            first = false;
        }
    }
    groups.close();
    known_.add_all(reached_);
    return is_larger;
}

template <int D>
void Share<D>::vertices(const std::function<void(const abacus_share_vertex &)> &visit) {
    const std::size_t name = 1 + names_.words();
    const std::size_t values = vertex_values_.are_elsewhere() ? 0 : vertex_values_.count();
    RecordSort sort(host_, name + 1 + values, name, memory_ / 2);
    each_known([&](const PageView<D> &page) {
        for (int v = 0; v < page.vertices(); ++v) {
            if ((answer_[v] & is_first) == 0) continue;
            std::uint64_t *const record = sort.add();
            record[0] = rank_of(answer_[v]);
            names_.write(page, v, record + 1);
            record[name] = static_cast<std::uint64_t>(page.id(v));
            if (values > 0)
                vertex_values_.all(page, v, reinterpret_cast<double *>(record + name + 1));
        }
    });
    answers_->close();
    sort.finish();
    Arena<double> apart(host_);
    apart.resize(vertex_values_.count());
    abacus_share_vertex vertex{};
    for (const std::uint64_t *record; (record = sort.next()) != nullptr; ++vertex.local) {
        if (vertex.local % Pacer::stride == 0) host_.poll();
        vertex.owner =
            cut_.piece(record[0] == 0 ? own_ : static_cast<std::size_t>(record[0] - 1)).part;
        vertex.id = static_cast<std::int64_t>(record[name]);
        Point<D> p;
        for (int axis = 0; axis < D; ++axis) p[axis] = from_ordered(record[2 + axis]);
        std::copy_n(p.begin(), D, vertex.point);
        vertex.attributes = reinterpret_cast<const double *>(record + name + 1);
        if (vertex_values_.are_elsewhere()) {
            vertex_values_.all_of(vertex.id, p, apart.data());
            vertex.attributes = apart.data();
        }
        visit(vertex);
    }
    sort.close();
}

template <int D>
void Share<D>::simplices(const std::function<void(abacus_share_simplex &)> &visit) {
    DenseRanks ranks(host_, 1 + names_.words(), memory_ / 2);
    each_known([&](const PageView<D> &page) {
        for (int v = 0; v < page.vertices(); ++v) {
            if ((answer_[v] & is_in) == 0) continue;
            std::uint64_t *const key = ranks.add();
            *key = rank_of(answer_[v]);
            names_.write(page, v, key + 1);
        }
    });
    ranks.finish();
    const Domain<D> domain = domain_of<D>(facts_.form);
    std::array<std::uint64_t, page_vertices<D>> local;
    abacus_share_simplex out{};
    each_known([&](const PageView<D> &page) {
        for (int v = 0; v < page.vertices(); ++v)
            if ((answer_[v] & is_in) != 0) local[v] = ranks.next();
        for (int s = 0; s < page.simplices(); ++s) {
            if (!is_member(page, s)) continue;
            out.owner = cut_.piece(cut_.piece_of(page, range_, s)).part;
            const auto &order = describe(page, s, domain, out.simplex);
            for (int i = 0; i <= D; ++i) out.local[i] = local[page.corner(s, order[i])];
            visit(out);
        }
    });
    ranks.close();
    answers_->close();
}

template class Share<2>;
template class Share<3>;

} // namespace abacus
