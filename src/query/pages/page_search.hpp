// All simplices around a place, or near a box, in pages that are held in memory, patch by patch.
//
// If a walk does not settle a place, all pages whose boxes contain it are searched
// (page_boxes.hpp): two or three pages in a cavity, more at a vertex. Nearly all of their simplices
// are somewhere else. So the boxes of a page's patches select the patches to read, and the boxes of
// a patch's simplices select the simplices to test, eight at once. The parts of a page that have
// been read are kept; the page used longest ago makes room for another one.
#pragma once

#include "geometry/box.hpp"
#include "host/host.hpp"
#include "host/memory_resource.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/pages/simplex_boxes.hpp"

#include <algorithm>
#include <memory_resource>
#include <vector>

namespace abacus {

template <int D> class PageSearch {
public:
    /// Holds pages in about this many bytes, but at least two pages.
    PageSearch(const Host &host, int attributes, std::size_t bytes)
        : host_(host), attributes_(attributes), memory_(host),
          pages_(std::clamp<std::size_t>(bytes / sizeof(Held), 2, most_held), &memory_) {}

    /// Calls visit(page, simplex, position) for each finite simplex of the page that owns the key
    /// in whose closure p lies; `position` is that of in_simplex(). Returns the next page's key.
    template <class Visit> Key around(const Key &key, const Point<D> &p, Visit visit) {
        return near(key, {p, p}, [&](const PageView<D> &view, int simplex) {
            const int position = in_simplex<D>(corners_of(view, simplex), p);
            if (position >= 0) visit(view, simplex, position);
        });
    }
    /// Calls visit(page, simplex) for finite simplices of the page, all those that meet the box
    /// among them.
    template <class Visit> Key near(const Key &key, const Box<D> &box, Visit visit) {
        Held &held = page(key);
        PageView<D> &view = held.view;
        const auto lower = SimplexBoxes<D>::place(view, box.lower);
        const auto upper = SimplexBoxes<D>::place(view, box.upper);
        for (int patch = 0; patch < view.patches(); ++patch) {
            if (!may_meet(view.patch(patch), lower, upper)) continue;
            read(held, patch);
            held.boxes.meeting(lower, upper, view.simplices_of(patch), [&](int simplex) {
                for (int i = 0; i <= D; ++i) view.read_point(view.corner(simplex, i));
                visit(view, simplex);
                return true;
            });
        }
        return view.upper();
    }

    std::size_t bytes() const { return pages_.size() * sizeof(Held); }
    std::uint64_t pages_read() const { return pages_read_; }

private:
    static constexpr std::size_t most_held = 64;

    struct Held {
        Held() {} // the arrays are filled with the page

        Key lower{}, upper{}; ///< the interval it owns; empty at first
        std::uint64_t last_use = 0;
        std::uint64_t patches = 0; ///< the patches that have been read, a bit each
        PageView<D> view;
        SimplexBoxes<D> boxes;
        alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes;
    };

    using PlaceIn = typename SimplexBoxes<D>::Place;
    static bool may_meet(const PagePatch<D> &patch, const PlaceIn &lower, const PlaceIn &upper) {
        bool may = true;
        for (int axis = 0; axis < D; ++axis)
            may = may && patch.least[axis] <= upper[axis] && lower[axis] <= patch.greatest[axis];
        return may;
    }
    static void read(Held &held, int patch) {
        if ((held.patches >> patch & 1) != 0) return;
        held.view.read_patch(patch);
        held.boxes.make(held.view, patch);
        held.patches |= std::uint64_t{1} << patch;
    }
    /// The page that owns the key, in place of the one used longest ago if it is not held.
    Held &page(const Key &key);

    const Host &host_;
    const int attributes_;
    HostMemory memory_;
    std::pmr::vector<Held> pages_;
    std::uint64_t uses_ = 0, pages_read_ = 0;
};

extern template class PageSearch<2>;
extern template class PageSearch<3>;

} // namespace abacus
