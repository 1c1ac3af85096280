// A mesh whose simplices have labels, and the labels that it should have.
#pragma once

#include "attributes/attribute_key.hpp"
#include "geometry/predicates.hpp"
#include "keys/domain_of.hpp"
#include "support/located_places.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

namespace abacus::test {

/// Labels by the sorted ids of a simplex.
template <int D> using LabelsByIds = std::map<Ids<D>, std::vector<double>>;

template <int D> Ids<D> ids_of(const abacus_simplex &simplex) {
    Ids<D> ids;
    std::copy_n(simplex.id, D + 1, ids.begin());
    std::sort(ids.begin(), ids.end());
    return ids;
}

inline bool is_same(const std::vector<double> &a, const double *b) {
    return std::memcmp(a.data(), b, a.size() * sizeof(double)) == 0;
}

template <int D> class LabelledMesh {
public:
    explicit LabelledMesh(unsigned labels, std::size_t cache_bytes = 1 << 20)
        : mesh(0, cache_bytes), labels_(labels) {
        mesh.header.facts.columns.labels = labels;
        for (unsigned i = 0; i < labels; ++i)
            std::strcpy(mesh.header.names[i], ("label " + std::to_string(i)).c_str());
    }

    /// Every `every`th simplex gets none.
    void load(Triangulation<D> t, std::size_t memory = 64 << 20, unsigned every = 7) {
        t.shuffle(5);
        std::mt19937_64 random(4);
        std::vector<std::vector<double>> given;
        for (Ids<D> ids : t.simplices) {
            std::vector<double> row(labels_);
            const bool none = given.size() % every == 0;
            for (double &label : row) {
                const bool null = none || random() % 4 == 0;
                label = null ? null_value : double(random() % 1000);
            }
            given.push_back(row);
            labelled_ +=
                !std::all_of(row.begin(), row.end(), [](double x) { return std::isnan(x); });
            std::sort(ids.begin(), ids.end());
            known_[ids] = row;
        }
        ASSERT_EQ(mesh.load(t.vertices, t.simplices, memory, true, false, given), ABACUS_OK)
            << mesh.error.message << ' ' << mesh.error.detail;
        EXPECT_EQ(mesh.header.facts.census.labelled, labelled_);
        EXPECT_TRUE(mesh.host.spools.empty());
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
    void expect_all_in_cells() {
        std::size_t seen = 0;
        each_cell({}, nullptr, [&](const Ids<D> &ids, const double *labels) {
            EXPECT_TRUE(is_same(known_.at(ids), labels));
            ++seen;
        });
        EXPECT_EQ(seen, known_.size());
    }
    /// Expects simplices with a label in a range, in the whole mesh and in windows.
    void expect_in_ranges() {
        std::mt19937_64 random(9);
        std::uniform_real_distribution<double> wide(-0.1, 1.1);
        for (int trial = 0; trial < 24; ++trial) {
            const auto least = double(random() % 1100) - 50;
            const abacus_range range{static_cast<std::uint32_t>(random() % labels_), least,
                                     least + double(random() % 3 * (random() % 200))};
            abacus_window window{};
            if (trial % 3 != 0) window.kind = ABACUS_BOX_WINDOW;
            for (int axis = 0; axis < D; ++axis) {
                window.lower[axis] = wide(random);
                window.upper[axis] = window.lower[axis] + std::abs(wide(random)) / 2;
            }
            std::size_t expected = 0;
            each_cell(window, nullptr, [&](const Ids<D> &ids, const double *) {
                const double label = known_.at(ids)[range.attribute];
                expected += range.least <= label && label <= range.greatest;
            });
            std::size_t found = 0;
            each_cell(window, &range, [&](const Ids<D> &ids, const double *labels) {
                EXPECT_TRUE(is_same(known_.at(ids), labels));
                EXPECT_GE(labels[range.attribute], range.least);
                EXPECT_LE(labels[range.attribute], range.greatest);
                ++found;
            });
            EXPECT_EQ(found, expected);
        }
    }
    void expect_those_of_places() {
        std::mt19937_64 random(6);
        std::uniform_real_distribution<double> wide(-0.1, 1.1);
        abacus_places *places = nullptr;
        ASSERT_EQ(abacus_places_open(mesh.host.table(), &mesh.header.facts, 1 << 20, 1 << 20,
                                     &places, &mesh.error),
                  ABACUS_OK);
        for (std::uint64_t i = 0; i < 500; ++i) {
            std::array<std::uint64_t, 1 + D> record{i};
            for (int axis = 0; axis < D; ++axis)
                record[1 + axis] = std::bit_cast<std::uint64_t>(wide(random));
            ASSERT_EQ(abacus_places_add(places, record.data(), 1, &mesh.error), ABACUS_OK);
        }
        inside_ = 0;
        EXPECT_EQ(abacus_places_locate(places, expect_labels, this, &mesh.error), ABACUS_OK);
        abacus_places_close(places);
        EXPECT_GT(inside_, 100);
    }
    /// Gives some simplices other values of these labels; the last labels may be new.
    void label(const std::vector<std::uint32_t> &numbers, unsigned seed) {
        std::mt19937_64 random(seed);
        const std::uint32_t known = mesh.header.facts.columns.labels;
        abacus_header named = mesh.header;
        for (const std::uint32_t number : numbers)
            if (number >= named.facts.columns.labels) {
                named.facts.columns.labels = number + 1;
                std::strcpy(named.names[number], ("label " + std::to_string(number)).c_str());
            }
        labels_ = named.facts.columns.labels;
        for (auto &[ids, row] : known_) row.resize(labels_, null_value);
        auto simplices = mesh.simplices(false);
        std::shuffle(simplices.begin(), simplices.end(), random);
        simplices.resize(simplices.size() / 2);
        std::vector<std::uint64_t> rows;
        for (const abacus_simplex &simplex : simplices) {
            rows.push_back(simplex.code);
            Ids<D> ids = ids_of<D>(simplex);
            std::shuffle(ids.begin(), ids.end(), random);
            rows.insert(rows.end(), ids.begin(), ids.end());
            for (const std::uint32_t number : numbers) {
                const double value = random() % 9 == 0 ? null_value : double(random() % 100);
                rows.push_back(std::bit_cast<std::uint64_t>(value));
                known_.at(ids_of<D>(simplex))[number] = value;
            }
        }
        abacus_labelling *labelling = nullptr;
        ASSERT_EQ(abacus_labelling_open(mesh.host.table(), &named.facts, known, numbers.data(),
                                        numbers.size(), 1 << 16, 1 << 20, &labelling, &mesh.error),
                  ABACUS_OK);
        EXPECT_EQ(abacus_labelling_add(labelling, rows.data(), simplices.size(), &mesh.error),
                  ABACUS_OK);
        EXPECT_EQ(abacus_labelling_end(labelling, &named, &mesh.error), ABACUS_OK)
            << mesh.error.message;
        abacus_labelling_close(labelling);
        mesh.header = named;
    }
    /// After a change: remaining simplices have kept their labels, others have none.
    void expect_followed() {
        LabelsByIds<D> left;
        std::uint64_t kept = 0;
        for (const abacus_simplex &simplex : mesh.simplices(false)) {
            const auto before = known_.find(ids_of<D>(simplex));
            const bool is_new = before == known_.end();
            left[ids_of<D>(simplex)] =
                is_new ? std::vector<double>(labels_, null_value) : before->second;
            kept += !is_new;
        }
        EXPECT_LT(kept, known_.size());
        known_ = left;
        expect_all_in_cells();
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_TRUE(mesh.host.spools.empty());
    }
    /// A simplex that has labels.
    struct Labelled {
        Owner<D, D + 1> simplex;
        std::vector<double> labels;
    };
    std::vector<Labelled> all_labelled() {
        std::vector<Labelled> result;
        for (const abacus_simplex &simplex : mesh.simplices(false)) {
            const auto &labels = known_.at(ids_of<D>(simplex));
            if (std::all_of(labels.begin(), labels.end(), [](double x) { return std::isnan(x); }))
                continue;
            result.push_back({owner(simplex), labels});
        }
        return result;
    }
    /// After a change: remaining simplices have kept their labels. Others have the labels of the
    /// former simplex in which their centroid lies. Returns how many have got some in this way.
    std::size_t expect_inherited(const std::vector<Labelled> &before) {
        LabelsByIds<D> now;
        std::size_t heirs = 0;
        for (const abacus_simplex &simplex : mesh.simplices(false)) {
            const Ids<D> ids = ids_of<D>(simplex);
            if (known_.contains(ids)) {
                now[ids] = known_[ids];
                continue;
            }
            const Labelled *from = has_centroid(before, owner(simplex));
            now[ids] = from == nullptr ? std::vector<double>(labels_, null_value) : from->labels;
            heirs += from != nullptr;
        }
        known_ = now;
        expect_all_in_cells();
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_TRUE(mesh.host.spools.empty());
        return heirs;
    }
    std::uint64_t labelled() const { return labelled_; }

    MeshOf<D> mesh;

private:
    static Owner<D, D + 1> owner(const abacus_simplex &simplex) {
        std::array<Point<D>, D + 1> points;
        for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, points[i].begin());
        return owner_of<D, D + 1>(points);
    }
    static int position(const Owner<D, D + 1> &simplex, const Point<D> &p) {
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) corners[i] = &simplex[i];
        if (orientation<D>(corners) < 0) std::swap(corners[0], corners[1]);
        return in_simplex<D>(corners, p);
    }
    /// If there are several, the one with the least key; null if there is none.
    const Labelled *has_centroid(const std::vector<Labelled> &all, const Owner<D, D + 1> &simplex) {
        const Domain<D> domain = domain_of<D>(mesh.header.facts.form);
        Point<D> centroid{};
        for (const Point<D> &p : simplex)
            for (int axis = 0; axis < D; ++axis) centroid[axis] += p[axis] / (D + 1);
        if (position(simplex, centroid) <= 0) return nullptr;
        const auto key = [&](const Labelled &labelled) {
            return attribute_key<D, D + 1>(labelled.simplex,
                                           code_of<D, D + 1>(domain, labelled.simplex));
        };
        const Labelled *first = nullptr;
        for (const Labelled &labelled : all)
            if (position(labelled.simplex, centroid) >= 0 &&
                (first == nullptr || key(labelled) < key(*first)))
                first = &labelled;
        return first;
    }

    /// Calls take(ids, labels) for the simplices of a window that have a label in a range.
    template <class Take>
    void each_cell(const abacus_window &window, const abacus_range *range, Take take) {
        abacus_cells *cells = nullptr;
        const abacus_extent all{};
        ASSERT_EQ(abacus_cells_open(mesh.host.table(), &mesh.header.facts, &window, &all, range,
                                    &cells, &mesh.error),
                  ABACUS_OK);
        abacus_simplex simplex;
        const double *labels = nullptr;
        while (abacus_cells_next(cells, &simplex, nullptr, &mesh.error) == ABACUS_OK) {
            ASSERT_EQ(abacus_cells_labels(cells, &simplex, &labels, &mesh.error), ABACUS_OK);
            take(ids_of<D>(simplex), labels);
        }
        abacus_cells_close(cells);
    }

    static abacus_host_status expect_labels(void *context, std::int64_t,
                                            const abacus_simplex *simplex, const double *labels) {
        auto &of = *static_cast<LabelledMesh *>(context);
        EXPECT_EQ(simplex == nullptr, labels == nullptr);
        if (simplex == nullptr) return ABACUS_HOST_OK;
        ++of.inside_;
        EXPECT_TRUE(is_same(of.known_.at(ids_of<D>(*simplex)), labels));
        return ABACUS_HOST_OK;
    }

    unsigned labels_;
    LabelsByIds<D> known_;
    std::uint64_t labelled_ = 0;
    int inside_ = 0;
};

template <int D> Triangulation<D> some_triangulation(int n) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Point<D>> points(static_cast<std::size_t>(n));
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    return delaunay<D>(points);
}

} // namespace abacus::test
