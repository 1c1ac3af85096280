#include "query/volume/volume.hpp"

namespace abacus {

namespace {

/// The area of the surface itself, in space.
ScaledNumber surface_of(const Piece<2> &piece) {
    const auto raised = [&](int i) {
        return Point<3>{piece.corner[i][0], piece.corner[i][1], piece.value[i]};
    };
    return triangle_area(raised(0), raised(1), raised(2));
}

ScaledNumber surface_of(const Piece<3> &piece) { return section_area(piece, piece.value); }

/// How many times larger a surface is than the triangle below it.
ScaledNumber steepness(const ValuedSimplex<2> &simplex) {
    constexpr double flat = 0x1p-20;
    if (!(measure(NearFrame<2>(simplex, simplex).into(simplex)) > flat))
        return {exact::steepness(simplex.as_it_is()), 0};
    const Piece<2> whole = simplex.piece();
    return surface_of(whole) / scaled_measure(whole);
}

void add(WideSum &sum, const ScaledNumber &number) { sum.add(number.value, number.exponent); }

} // namespace

// ---- Sums --------------------------------------------------------------------------------

template <int D> void Volume<D>::add(const Piece<D> &piece) {
    abacus::add(area_, scaled_measure(piece));
    abacus::add(surface_, surface_of(piece));
    add_sides(piece);
}

template <int D> void Volume<D>::add(const Portion<D> &portion, const ScaledNumber &steepness) {
    abacus::add(area_, portion.size());
    abacus::add(surface_, portion.size() * steepness);
    each_of_one_sign<D>(portion, [&](const Portion<D> &part) {
        const ScaledNumber amount = part.integral();
        if (amount.value >= 0)
            abacus::add(cut_, amount);
        else
            abacus::add(fill_, {-amount.value, amount.exponent});
    });
}

template <int D> void Volume<D>::add_sides(const Piece<D> &piece) {
    const auto amount = [](const Piece<D> &part) {
        const ScaledNumber size = scaled_measure(part);
        return D == 2 ? size * scaled(std::fabs(mean(part))) : size;
    };
    const auto [least, greatest] = std::minmax_element(piece.value.begin(), piece.value.end());
    if (*least >= 0) {
        abacus::add(cut_, amount(piece));
    } else if (*greatest <= 0) {
        abacus::add(fill_, amount(piece));
    } else {
        Sides<D> turned;
        for (int i = 0; i <= D; ++i) turned[i] = -piece.value[i];
        clip<D>(piece, piece.value, [&](const Piece<D> &part) { abacus::add(cut_, amount(part)); });
        clip<D>(piece, turned, [&](const Piece<D> &part) { abacus::add(fill_, amount(part)); });
    }
}

// ---- Meshes ------------------------------------------------------------------------------

template <int D>
abacus_volume volume_above(const Host &host, const abacus_facts &facts,
                           const abacus_surface &surface, double base) {
    const Box<D> window = box_of<D>(surface.window);
    Volume<D> volume;
    each_simplex<D>(host, facts, surface, surface.window,
                    [&](const abacus_simplex &simplex, const CornerValues &values) {
                        ValuedSimplex<D> cell = cell_of<D>(simplex, values);
                        if (!cell.has_values()) return;
                        for (double &value : cell.value) value -= base;
                        clip_box<D>(
                            cell.piece(), cell.seen_from_first(window), [&](const Piece<D> &piece) {
                                clip_polygon(cell, piece, surface.extent,
                                             [&](const Piece<D> &part) { volume.add(part); });
                            });
                    });
    return volume.sums();
}

abacus_volume volume_between(const Host &host, const abacus_facts &facts,
                             const abacus_surface &surface, const OtherMesh &other) {
    const Box<2> window = box_of<2>(surface.window);
    for (const bool is_exact : {false, true}) {
        CommonPortions<2> portions(is_exact);
        Volume<2> volume;
        each_overlap<2>(host, facts, surface, other,
                        [&](const ValuedSimplex<2> &first, const ValuedSimplex<2> &second) {
                            const ScaledNumber steep = steepness(first);
                            portions.each(
                                first, second, window, surface.extent,
                                [&](const Portion<2> &portion) { volume.add(portion, steep); });
                        });
        if (portions.is_sure()) return volume.sums();
    }
    return {}; // not reached
}

template class Volume<2>;
template class Volume<3>;
template abacus_volume volume_above<2>(const Host &, const abacus_facts &, const abacus_surface &,
                                       double);
template abacus_volume volume_above<3>(const Host &, const abacus_facts &, const abacus_surface &,
                                       double);

} // namespace abacus
