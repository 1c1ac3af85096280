#include "thin/finder.hpp"

#include <cmath>

namespace abacus {

namespace {

template <int D> std::array<Point<D>, D> facet_of(const Piece<D> &piece) {
    std::array<Point<D>, D> facet;
    std::copy_n(piece.corner.begin(), D, facet.begin());
    return facet;
}

} // namespace

template <int D>
bool comes_first(const Piece<D> &piece, bool is_ghost, const std::uint64_t *vertex,
                 const std::uint64_t *other) {
    const Point<D> p = vertex_point<D>(vertex), q = vertex_point<D>(other);
    if (p == q) return false;
    const double value = vertex_value<D>(vertex), other_value = vertex_value<D>(other);
    const Misfit<D> misfit(piece);
    const Magnitude a = is_ghost ? height_over<D>(facet_of(piece), p) : misfit.of(p, value);
    const Magnitude b = is_ghost ? height_over<D>(facet_of(piece), q) : misfit.of(q, other_value);
    if (a.least() > b.most()) return true;
    if (a.most() < b.least()) return false;
    const int order = is_ghost ? exact::compare_heights<D>(facet_of(piece), p, q)
                               : exact::compare_misfits<D>(piece, p, value, piece, q, other_value);
    return order != 0 ? order > 0 : lexicographically_less<D>(p, q);
}

template <int D>
Finder<D>::Finder(const Host &host, const abacus_facts &facts, const Options &options, Aim aim)
    : vertex_words_(options.vertex_words), attribute_(options.attribute), bound_(options.bound),
      aim_(aim), reader_(host, facts, options.cache_bytes), table_(host), vertices_(host),
      candidates_(host) {
    table_.resize(places);
    for (Place &place : table_) place.is_taken = false;
    vertices_.resize(places * vertex_words_);
}

template <int D> bool Finder<D>::look(const std::uint64_t *vertex) {
    const Point<D> p = vertex_point<D>(vertex);
    const Handle h = reader_.simplex_around(p);
    if (h == no_handle) return true;
    if (reader_.cache().simplex(h).is_ghost()) {
        if (aim_ == Aim::outside) look_outside(vertex, p, h);
        return true;
    }
    if (aim_ == Aim::outside) return false;
    if (aim_ == Aim::misfits && reader_.is_on_facet())
        reader_.containing(p, [&](Handle met) { look_inside(vertex, p, met); });
    else
        look_inside(vertex, p, h);
    return false;
}

template <int D>
void Finder<D>::look_outside(const std::uint64_t *vertex, const Point<D> &p, Handle ghost) {
    Cache<D> &cache = reader_.cache();
    const auto sees = [&](Handle h) {
        const Simplex<D> &s = cache.simplex(h);
        Corners<D> corners;
        for (int i = 0; i < D; ++i) corners[i] = &cache.point(s.vertex[i]);
        corners[D] = &p;
        return s.is_ghost() && orientation<D>(corners) > 0;
    };
    reader_.flood().from(
        cache, ghost, [&](Handle h, int facet) { return facet < D && sees(h); },
        [&](Handle h) {
            if (!sees(h)) return true;
            const Simplex<D> &s = cache.simplex(h);
            for (int i = 0; i < D; ++i) piece_.corner[i] = cache.point(s.vertex[i]);
            last_ = no_handle;
            compete(h, true, height_over<D>(facet_of(piece_), p), vertex);
            return true;
        });
}

template <int D> const Misfit<D> &Finder<D>::misfits(Handle h) {
    const Cache<D> &cache = reader_.cache();
    if (h == last_ && evictions_ == cache.counters.evictions) return *misfits_;
    const Simplex<D> &s = cache.simplex(h);
    for (int i = 0; i <= D; ++i) {
        piece_.corner[i] = cache.point(s.vertex[i]);
        piece_.value[i] = reader_.vertex_values().value(cache.vertices(), s.vertex[i], attribute_);
        if (!std::isfinite(piece_.value[i]))
            throw Error(ABACUS_ERROR_STATE, "a vertex of the thinned mesh has no value", {},
                        "Drop the mesh, and thin anew.");
    }
    last_ = h;
    evictions_ = cache.counters.evictions;
    return misfits_.emplace(piece_);
}

template <int D>
void Finder<D>::look_inside(const std::uint64_t *vertex, const Point<D> &p, Handle h) {
    const double value = vertex_value<D>(vertex);
    const Misfit<D> &all = misfits(h);
    for (const Point<D> &corner : piece_.corner)
        if (corner == p) return;
    const Magnitude misfit = all.of(p, value);
    if (aim_ == Aim::greatest) {
        if (all.may_exceed(value, misfit, greatest_))
            greatest_ = std::max(greatest_, exact::misfit<D>(piece_, p, value));
        return;
    }
    if (all.exceeds(p, value, misfit, bound_)) compete(h, false, misfit, vertex);
}

template <int D>
bool Finder<D>::is_worse(const Place &place, const std::uint64_t *kept, const Magnitude &misfit,
                         const std::uint64_t *vertex) const {
    if (misfit.least() > place.misfit.most()) return true;
    if (misfit.most() < place.misfit.least()) return false;
    return comes_first<D>(place.piece, place.is_ghost, vertex, kept);
}

template <int D>
void Finder<D>::compete(Handle h, bool is_ghost, const Magnitude &misfit,
                        const std::uint64_t *vertex) {
    const std::size_t number = to_number(h) * std::uint64_t{0x9e3779b97f4a7c15} >> 54;
    static_assert(places == std::size_t{1} << (64 - 54));
    Place &place = table_[number];
    // A handle may be another simplex's by now: the corners tell.
    const int corners = is_ghost ? D : D + 1;
    const bool is_same = place.is_taken && place.is_ghost == is_ghost &&
                         std::equal(piece_.corner.begin(), piece_.corner.begin() + corners,
                                    place.piece.corner.begin());
    if (is_same) {
        if (!is_worse(place, kept(number), misfit, vertex)) return;
    } else {
        if (place.is_taken) hand_out(number);
        place.piece = piece_;
        place.is_taken = true;
        place.is_ghost = is_ghost;
    }
    place.misfit = misfit;
    std::copy_n(vertex, vertex_words_, kept(number));
}

template <int D> void Finder<D>::hand_out(std::size_t number) {
    std::uint64_t *const words = candidates_.extend(stride());
    Candidate<D>::put(words, table_[number].piece, table_[number].is_ghost);
    std::copy_n(kept(number), vertex_words_, words + Candidate<D>::head_words);
    table_[number].is_taken = false;
}

template <int D> void Finder<D>::flush() {
    for (std::size_t i = 0; i < places; ++i)
        if (table_[i].is_taken) hand_out(i);
}

template class Finder<2>;
template class Finder<3>;
template bool comes_first<2>(const Piece<2> &, bool, const std::uint64_t *, const std::uint64_t *);
template bool comes_first<3>(const Piece<3> &, bool, const std::uint64_t *, const std::uint64_t *);

} // namespace abacus
