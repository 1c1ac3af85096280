// An attribute at the centres of a raster's pixels, row by row.
//
// As many rows as memory has room for, a band, are filled at once. Linear interpolation goes
// through the pages that meet the band, and through their simplices: each fills the pixels whose
// centres lie strictly inside it. A centre has only one such simplex, the one that Reader::locate()
// finds; and the value is computed from it as in Interpolation, to the last bit. A centre at a
// vertex has the vertex's value, whichever simplex it is taken from. The other centres on borders
// have several simplices, and locate() decides which of them counts: these pixels are marked.
// Afterwards they are looked up like many places (places.hpp), and so are all pixels of the other
// methods, and of a raster that is much coarser than the mesh.
//
// Which centres of a row are in a simplex is decided exactly, but not one by one: between two that
// are, all are. These two are computed in doubles with a bound on the error, and then tested from
// outside.
#pragma once

#include "query/pages/page_boxes.hpp"
#include "query/pages/vertex_values.hpp"
#include "query/scan/range_scan.hpp"
#include "query/values/interpolation.hpp"

#include <abacus/raster.h>

namespace abacus {

template <int D> class ValueRaster {
public:
    /// Throws if the raster's centres are no doubles, or a row has too many.
    ValueRaster(const Host &host, const abacus_facts &facts, const abacus_raster &raster,
                const abacus_interpolation &how, std::size_t memory, std::size_t cache_bytes);

    /// The values of the next row, valid until the next call; null after the last. NaN where there
    /// is none.
    const double *next();

private:
    enum Mark : std::uint8_t { filled, asked };

    void fill_band();
    /// Whether there are so many simplices that it takes less time to locate each centre.
    bool is_finer_than_pixels() const;
    void fill_linear();
    void ask();
    void fill_from(const PageView<D> &page);
    void fill_from(const PageView<D> &page, int simplex);
    /// Calls visit(page) for the pages that may meet the band.
    template <class Visit> void each_page(const Box<D> &band, Visit visit);

    /// Columns whose centres in a row may be within a simplex.
    struct Columns {
        std::int64_t first, last;
    };
    Columns columns_of(const Corners<D> &corners, const Box<D> &box, const Point<D> &in_row) const;
    void fill_row(const PageView<D> &page, int simplex, std::uint32_t row, const Columns &columns);
    std::size_t pixel(std::uint32_t row, std::int64_t column) const {
        return std::size_t(row - first_) * raster_.width + static_cast<std::size_t>(column);
    }

    double x(std::int64_t column) const {
        return raster_.lower[0] + (static_cast<double>(column) + 0.5) * width_ / raster_.width;
    }
    double y(std::int64_t row) const {
        return latitudes_.empty() ? evenly(row) : latitudes_[static_cast<std::size_t>(row)];
    }
    double evenly(std::int64_t row) const {
        return raster_.upper[1] - (static_cast<double>(row) + 0.5) * height_ / raster_.height;
    }
    Point<D> centre(std::uint32_t row, std::int64_t column) const {
        Point<D> p;
        p[0] = x(column) + 0.0;
        p[1] = y(row) + 0.0;
        if constexpr (D == 3) p[2] = raster_.lower[2] + 0.0;
        return p;
    }

    const Host &host_;
    const abacus_facts facts_;
    const abacus_raster raster_;
    const double width_, height_; // of the window
    const abacus_interpolation how_;
    const std::size_t memory_; // half of the memory: for a band, and also for sorting places
    const std::size_t cache_bytes_;
    std::uint32_t rows_ = 0;   // most of a band
    std::uint32_t first_ = 0;  // row of the band
    std::uint32_t filled_ = 0; // rows from the first one on
    std::uint32_t next_ = 0;
    std::optional<Box<D>>
        extent_;              // outside of which there is no value, where that is worth knowing
    Arena<double> latitudes_; // of the rows, if not evenly spaced
    Arena<double> values_;
    Arena<Mark> marks_;
    std::optional<PageBoxes<D>> boxes_; // of a mesh that is not Delaunay
    CornerValues carried_;
    const VertexValues<D> vertex_values_;
    // The simplex from which pixels are filled.
    int described_ = -1;
    abacus_simplex simplex_{};
};

extern template class ValueRaster<2>;
extern template class ValueRaster<3>;

} // namespace abacus
