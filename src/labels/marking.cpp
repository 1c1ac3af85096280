#include "labels/marking.hpp"

#include "blocks/counters.hpp"
#include "keys/domain_of.hpp"
#include "labels/marker_sweep.hpp"

#include <cmath>

namespace abacus {

namespace {

template <int D> Point<D> corner_of(const abacus_simplex &simplex, int corner) {
    Point<D> p;
    std::copy_n(simplex.corner[corner], D, p.begin());
    return p;
}

/// The corner of the neighbour that the simplex does not share.
template <int D> int corner_beyond(const abacus_simplex &simplex, const abacus_simplex &neighbour) {
    for (int i = 0; i <= D; ++i) {
        bool is_shared = false;
        for (int k = 0; k <= D; ++k)
            is_shared |= corner_of<D>(neighbour, i) == corner_of<D>(simplex, k);
        if (!is_shared) return i;
    }
    throw_corrupted("Two neighbours have the same corners.");
}

} // namespace

template <int D>
Marking<D>::Marking(const Host &host, const abacus_facts &, std::size_t memory)
    : host_(host), sort_(host, 1 + row_words, 2, memory / 2),
      sides_(host, side_words, side_key, memory / 2) {}

template <int D> void Marking<D>::add(const std::uint64_t *rows, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, rows += row_words) {
        const std::uint64_t corner = rows[D + 2];
        const auto marker = std::bit_cast<double>(rows[D + 3]);
        if (corner > D)
            throw Error(ABACUS_ERROR_ARGUMENT,
                        "facet " + std::to_string(static_cast<std::int64_t>(corner)) +
                            " does not exist",
                        {},
                        "Facets are numbered 0 to " + std::to_string(D) +
                            "; facet i is the one opposite vertex i.");
        if (!std::isnan(marker) && !is_marker(marker))
            throw Error(ABACUS_ERROR_ARGUMENT, "a marker is not an integer", {},
                        "Give an integer of four bytes, or NULL.");
        std::uint64_t *record = sort_.add();
        record[0] = rows[0];
        record[1] = sort_.size();
        std::copy(rows + 1, rows + row_words, record + 2);
    }
}

template <int D> void Marking<D>::set(NamedSimplices<D> &mesh, abacus_header &header) {
    sort_.finish();
    sides_.expect(static_cast<double>(sort_.size()));
    while (const std::uint64_t *record = sort_.next()) add_sides(mesh, record);
    sort_.close();
    sides_.finish();
    Pages pages(host_, domain_of<D>(header.facts.form), D + 1, marker_group);
    while (const std::uint64_t *side = sides_.next()) mark(pages, side, header.facts.census.marked);
    pages.flush();
    sides_.close();
    header.counters += pages.take_counters();
}

template <int D> void Marking<D>::add_sides(NamedSimplices<D> &mesh, const std::uint64_t *record) {
    std::array<std::int64_t, D + 1> ids;
    std::memcpy(ids.data(), record + 2, sizeof ids);
    const int facet = static_cast<int>(record[D + 3]);
    const auto marker = std::bit_cast<double>(record[D + 4]);
    abacus_simplex simplex, neighbour;
    mesh.describe(record[0], ids.data(), simplex);
    if (std::count(ids.begin(), ids.end(), ids[facet]) > 1)
        throw Error(ABACUS_ERROR_ARGUMENT, "two vertices of the simplex have the same id", {},
                    "Give the points unique ids to name facets of simplices.");
    const int corner =
        static_cast<int>(std::find(simplex.id, simplex.id + D, ids[facet]) - simplex.id);
    add_side(simplex, corner, marker);
    if (mesh.walk(record[0], ids.data(), facet, neighbour))
        add_side(neighbour, corner_beyond<D>(simplex, neighbour), marker);
}

template <int D>
void Marking<D>::add_side(const abacus_simplex &simplex, int corner, double marker) {
    std::array<Point<D>, D + 1> points;
    for (int i = 0; i <= D; ++i) points[i] = corner_of<D>(simplex, i);
    const auto owner = owner_of<D, D + 1>(points);
    const auto opposite = std::find(owner.begin(), owner.end(), points[corner]) - owner.begin();
    const Key key = attribute_key<D, D + 1>(owner, simplex.code);
    std::uint64_t *side = sides_.add();
    *side++ = key.code;
    *side++ = key.part;
    *side++ = sides_.size();
    *side++ = simplex.code;
    std::memcpy(side, owner.data(), sizeof owner);
    side += D * (D + 1);
    *side++ = static_cast<std::uint64_t>(opposite);
    *side = std::bit_cast<std::uint64_t>(marker);
}

template <int D>
void Marking<D>::mark(Pages &pages, const std::uint64_t *side, std::uint64_t &marked) {
    const std::uint64_t code = side[side_key];
    Owner<D, D + 1> owner;
    std::memcpy(owner.data(), side + side_key + 1, sizeof owner);
    const auto opposite = static_cast<std::uint32_t>(side[side_words - 2]);
    const auto marker = std::bit_cast<double>(side[side_words - 1]);
    if (!std::isnan(marker)) {
        marked += set_marker<D>(pages, owner, code, opposite, marker);
        return;
    }
    if (!pages.set(owner, code, {&opposite, 1}, &marker)) return;
    std::array<double, D + 1> left;
    pages.get(owner, code, left.data());
    if (!std::all_of(left.begin(), left.end(), [](double x) { return std::isnan(x); })) return;
    pages.erase(owner, code);
    if (marked-- == 0) throw_corrupted("The header counts too few markers.");
}

template class Marking<2>;
template class Marking<3>;

} // namespace abacus
