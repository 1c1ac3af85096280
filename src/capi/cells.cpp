// The simplices of a window behind the C interface.
#include "query/scan/cell_scan.hpp"
#include "query/scan/simplex_labels.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/windows.h>
#include <numeric>

struct abacus_cells {
    abacus_cells(const abacus_host *table, const abacus_facts &facts, const abacus_window &window,
                 const abacus_extent &extent, const abacus_range *label)
        : host(*table), values(all.data(), facts.columns.attributes), labels(host, facts),
          cells(host, facts, window, extent, label) {}

    abacus_cells(const abacus_host *table, const abacus_facts &facts, std::uint64_t least,
                 std::uint64_t greatest)
        : host(*table), values(all.data(), facts.columns.attributes), labels(host, facts),
          cells(host, facts, least, greatest) {}

    static constexpr std::array<std::uint32_t, ABACUS_MAX_ATTRIBUTES> all = [] {
        std::array<std::uint32_t, ABACUS_MAX_ATTRIBUTES> numbers;
        std::iota(numbers.begin(), numbers.end(), 0u);
        return numbers;
    }();

    const abacus::Host host;
    abacus::CornerValues values;
    abacus::ByDimension<abacus::SimplexLabels> labels;
    abacus::ByDimension<abacus::CellScan> cells;
};

abacus_status abacus_cells_open(const abacus_host *host, const abacus_facts *facts,
                                const abacus_window *window, const abacus_extent *extent,
                                const abacus_range *label, abacus_cells **cells,
                                abacus_error *error) {
    return abacus::guard(error, [&] {
        *cells = abacus::create_handle<abacus_cells>(host, *facts, *window, *extent, label);
        return ABACUS_OK;
    });
}

abacus_status abacus_cells_open_stretch(const abacus_host *host, const abacus_facts *facts,
                                        uint64_t least, uint64_t greatest, abacus_cells **cells,
                                        abacus_error *error) {
    return abacus::guard(error, [&] {
        *cells = abacus::create_handle<abacus_cells>(host, *facts, least, greatest);
        return ABACUS_OK;
    });
}

abacus_status abacus_cells_next(abacus_cells *cells, abacus_simplex *simplex, double *values,
                                abacus_error *error) {
    return abacus::guard(error, [&] {
        return cells->cells.visit([&]<int D>(abacus::CellScan<D> &scan) {
            abacus::CornerValues *const wanted = values == nullptr ? nullptr : &cells->values;
            if (!scan.next(*simplex, wanted)) return ABACUS_END;
            if (wanted != nullptr)
                for (int i = 0; i <= D; ++i)
                    for (std::size_t n = 0; n < wanted->count(); ++n)
                        *values++ = wanted->value(i, n);
            return ABACUS_OK;
        });
    });
}

abacus_status abacus_cells_labels(abacus_cells *cells, const abacus_simplex *simplex,
                                  const double **labels, abacus_error *error) {
    return abacus::guard(error, [&] {
        *labels = cells->labels.visit([&](auto &of_all) { return of_all.of(*simplex); });
        return ABACUS_OK;
    });
}

uint64_t abacus_cells_pages(const abacus_cells *cells) {
    return cells->cells.visit([](const auto &scan) { return scan.pages_read(); });
}

void abacus_cells_close(abacus_cells *cells) { abacus::destroy_handle(cells); }
