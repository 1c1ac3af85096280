#include "load/overlap.hpp"

#include "geometry/contact.hpp"

namespace abacus {

namespace {

constexpr char common_faces[] = "Give simplices that meet in common faces only.";

std::string overlap_of(const std::string &a, const std::string &b) {
    return names_of(a, b) + " overlap";
}
void add_overlap(Faults &faults, const std::string &a, const std::string &b) {
    faults.add(overlap_of(a, b), "Their interiors have points in common.", common_faces);
}
void add_contact(Faults &faults, const std::string &a, const std::string &b,
                 const std::string &detail) {
    if (faults.has(overlap_of(a, b))) return; // that says more
    faults.add(names_of(a, b) + " meet in more than a common face", detail, common_faces);
}

constexpr std::size_t least_room = 64; // facets
/// Shares of the memory: for records put aside while a boundary is held in parts, and for the batch
/// that threads check.
constexpr std::size_t aside_share = 4, batch_share = 8;
constexpr std::size_t least_parts = 2, most_parts = 64; // at once
/// From this number of facets on, a boundary is worth the threads.
constexpr std::uint64_t worth_sharing = 1 << 15;
constexpr std::size_t least_batch = 64; // records

} // namespace

template <int D>
Overlap<D>::Overlap(const Host &host, const LoadLayout<D> &layout, std::size_t memory)
    : host_(host), layout_(layout), memory_(memory),
      room_(std::max(least_room, memory / (sizeof(BoundaryFacet) + BoxTree<D>::bytes_per_box))),
      facets_(host), tree_(host), loop_(host), batch_(host) {}

template <int D> typename Overlap<D>::BoundaryFacet Overlap<D>::read(const Word *record) const {
    BoundaryFacet facet;
    for (int i = 0; i < D; ++i) {
        const Word *vertex = layout_.boundary_vertex(record, i);
        facet.id[i] = vertex[0];
        facet.point[i] = point_in<D>(vertex);
    }
    const Word *opposite = layout_.behind(record) + 2;
    facet.opposite_id = opposite[0];
    facet.opposite = point_in<D>(opposite);
    return facet;
}

template <int D> Box<D> Overlap<D>::box_of_simplex(const Word *simplex) const {
    Box<D> box;
    for (int i = 0; i <= D; ++i) box.extend(point_in<D>(layout_.simplex_vertex(simplex, i)));
    return box;
}

template <int D>
void Overlap<D>::check(RecordSort &boundary, RecordSpool &simplices, Faults &faults) {
    // The parts, and so the order of faults, are the same for any number of threads.
    const bool is_large = boundary.size() >= worth_sharing || host_.has_tiny_intervals();
    is_shared_ = is_large && host_.threads() > 1;
    if (is_large) room_ = std::max(least_room, room_ - room_ / batch_share);
    if (boundary.size() <= room_) {
        check_at_once(boundary, simplices, faults);
    } else {
        room_ = std::max(least_room, room_ - room_ / aside_share);
        std::uint64_t first = 0;
        while (!faults.is_full() && first < boundary.size())
            first = check_parts(first, boundary, simplices, faults);
    }
    if (faults.is_full()) faults.stop();
    faults.raise();
    facets_.reset();
    batch_.reset();
}

template <int D>
void Overlap<D>::check_at_once(RecordSort &boundary, RecordSpool &simplices, Faults &faults) {
    boundary.rewind();
    fill(boundary);
    simplices.rewind();
    check_simplices([&] { return simplices.next(); }, faults);
    boundary.rewind();
    Arena<Word> numbered(host_);
    numbered.resize(1 + layout_.boundary);
    Word number = 0;
    const auto next = [&]() -> const Word * {
        const Word *record = boundary.next();
        if (record == nullptr) return nullptr;
        numbered[0] = number++;
        std::copy_n(record, layout_.boundary, numbered.data() + 1);
        return numbered.data();
    };
    check_facets(next, faults);
}

template <int D>
std::uint64_t Overlap<D>::check_parts(std::uint64_t first, RecordSort &boundary,
                                      RecordSpool &simplices, Faults &faults) {
    const std::uint64_t most = std::clamp(memory_ / aside_share / BoundaryParts<D>::bytes_a_part,
                                          least_parts, most_parts),
                        left = (boundary.size() - first + room_ - 1) / room_;
    BoundaryParts<D> parts(host_, std::min(most, left), room_, layout_.simplex,
                           1 + layout_.boundary);
    put_aside(parts, first, boundary, simplices);
    boundary.rewind();
    for (std::uint64_t i = 0; i < first; ++i) boundary.next();
    first_ = first;
    for (std::size_t part = 0; part < parts.size() && !faults.is_full(); ++part) {
        fill(boundary);
        RecordSpool &near = parts.simplices(part), &later = parts.others(part);
        check_simplices([&] { return near.next(); }, faults);
        check_facets([&] { return later.next(); }, faults);
        first_ += facets_.size();
    }
    parts.close();
    return first_;
}

/// Puts aside what is near each part: simplices, and the facets that do not come before the part.
template <int D>
void Overlap<D>::put_aside(BoundaryParts<D> &parts, std::uint64_t first, RecordSort &boundary,
                           RecordSpool &simplices) const {
    boundary.rewind();
    for (std::uint64_t i = 0; i < first; ++i) boundary.next();
    for (std::uint64_t i = 0; i < parts.most(); ++i) {
        const Word *record = boundary.next();
        if (record == nullptr) break;
        parts.add(read(record).box());
    }
    parts.finish();
    simplices.rewind();
    while (const Word *simplex = simplices.next())
        parts.each_near(box_of_simplex(simplex), [&](std::size_t part) {
            std::copy_n(simplex, layout_.simplex, parts.simplices(part).add());
        });
    boundary.rewind();
    for (std::uint64_t number = 0; const Word *record = boundary.next(); ++number) {
        if (number < first) continue;
        parts.each_near(read(record).box(), [&](std::size_t part) {
            if (part > parts.part_of(number - first)) return; // all facets of this part come later
            Word *numbered = parts.others(part).add();
            *numbered++ = number;
            std::copy_n(record, layout_.boundary, numbered);
        });
    }
    parts.rewind();
}

/// Reads the next facets into memory.
template <int D> void Overlap<D>::fill(RecordSort &boundary) {
    facets_.clear();
    tree_.clear();
    while (facets_.size() < room_) {
        const Word *record = boundary.next();
        if (record == nullptr) break;
        facets_.push_back(read(record));
        tree_.add(facets_.back().box());
    }
    tree_.finish();
}

template <int D>
template <class Next, class IsSound, class Report>
void Overlap<D>::each(std::size_t words, Next next, IsSound is_sound, Report report,
                      const Faults &faults) {
    if (!is_shared_) {
        while (const Word *record = faults.is_full() ? nullptr : next()) report(record);
        return;
    }
    const std::size_t most = std::max(memory_ / batch_share / (words * sizeof(Word)), least_batch);
    const Word *record = nullptr;
    do {
        batch_.clear();
        while (batch_.size() < most * words && (record = next()) != nullptr)
            std::copy_n(record, words, batch_.extend(words));
        look_at_batch(words, is_sound, report);
    } while (record != nullptr && !faults.is_full());
}

template <int D>
template <class IsSound, class Report>
void Overlap<D>::look_at_batch(std::size_t words, IsSound is_sound, Report report) {
    const std::size_t n = batch_.size() / words;
    const auto record = [&](std::size_t i) { return batch_.data() + i * words; };
    struct Rest {
        std::size_t begin, end;
    };
    Arena<Rest> rests(host_); // of each stretch, from the first faulty record on
    rests.resize(loop_.stretches());
    loop_.each_stretch(n,
                       [&](std::size_t stretch, std::size_t i, std::size_t end, const Host &host) {
                           while (i < end && is_sound(record(i), host)) ++i;
                           rests[stretch] = {i, end};
                       });
    for (const Rest &rest : rests)
        for (std::size_t i = rest.begin; i < rest.end; ++i) report(record(i));
}

template <int D> template <class Next> void Overlap<D>::check_simplices(Next next, Faults &faults) {
    const auto is_sound = [&](const Word *simplex, const Host &host) {
        return each_covered(simplex, host, [](std::size_t, Cover) { return false; });
    };
    const auto report = [&](const Word *simplex) {
        if (faults.is_full()) return;
        each_covered(simplex, host_, [&](std::size_t i, Cover cover) {
            std::array<Word, D + 1> ids;
            for (int k = 0; k <= D; ++k) ids[k] = layout_.simplex_vertex(simplex, k)[0];
            if (cover == Cover::inside)
                add_overlap(faults, facets_[i].simplex(), sorted_name(ids));
            else
                add_contact(faults, facets_[i].simplex(), sorted_name(ids),
                            "Facet " + sorted_name(facets_[i].id) + " lies along " +
                                sorted_name(ids) + ".");
            return !faults.is_full();
        });
    };
    each(layout_.simplex, next, is_sound, report, faults);
}

template <int D>
template <class Visit>
bool Overlap<D>::each_covered(const Word *simplex, const Host &host, Visit visit) const {
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &point_in<D>(layout_.simplex_vertex(simplex, i));
    return tree_.visit(box_of_simplex(simplex), [&](std::size_t i) {
        host.poll();
        const Cover cover = covers(corners, facets_[i]);
        return cover == Cover::none || visit(i, cover);
    });
}

template <int D>
typename Overlap<D>::Cover Overlap<D>::covers(const Corners<D> &corners,
                                              const BoundaryFacet &facet) {
    Cover cover = Cover::inside;
    for (int k = 0; k <= D; ++k) {
        Corners<D> replaced = corners;
        int side = 0;
        for (int i = 0; i < D && side == 0; ++i) {
            replaced[k] = &facet.point[i];
            side = orientation<D>(replaced);
        }
        if (side == 0) { // the facet lies in this plane: on the simplex's side or beyond
            Corners<D> base;
            for (int i = 0; i < D; ++i) base[i] = &facet.point[i];
            base[D] = &facet.opposite;
            const int solid = orientation<D>(base);
            base[D] = corners[k];
            side = orientation<D>(base) == solid ? -1 : 1;
            cover = Cover::along;
        }
        if (side < 0) return Cover::none;
    }
    return cover;
}

template <int D> template <class Next> void Overlap<D>::check_facets(Next next, Faults &faults) {
    const auto is_sound = [&](const Word *numbered, const Host &host) {
        return each_crossed(numbered, host, [](std::size_t) { return false; });
    };
    const auto report = [&](const Word *numbered) {
        if (faults.is_full()) return;
        each_crossed(numbered, host_, [&](std::size_t i) {
            const BoundaryFacet &other = facets_[i], facet = read(numbered + 1);
            add_contact(faults, other.simplex(), facet.simplex(),
                        "Their facets " + sorted_name(other.id) + " and " + sorted_name(facet.id) +
                            " cross or touch.");
            return !faults.is_full();
        });
    };
    each(1 + layout_.boundary, next, is_sound, report, faults);
}

template <int D>
template <class Visit>
bool Overlap<D>::each_crossed(const Word *numbered, const Host &host, Visit visit) const {
    const BoundaryFacet facet = read(numbered + 1);
    bool goes_on = true;
    tree_.visit(facet.box(), [&](std::size_t i) {
        host.poll();
        if (first_ + i >= *numbered) return false; // itself or a later one, which has its own turn
        goes_on = !meet_improperly(facet.vertices(), facets_[i].vertices()) || visit(i);
        return goes_on;
    });
    return goes_on;
}

template class Overlap<2>;
template class Overlap<3>;

} // namespace abacus
