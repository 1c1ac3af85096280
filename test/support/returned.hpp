// The simplices that changes report as created and removed, and the mesh before and after.
#pragma once

#include "keys/domain_of.hpp"
#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <optional>

namespace abacus::test {

/// In the order of the rows: by code, then the places of the corners, then their ids.
template <int D> struct ChangedSimplex {
    std::uint64_t code;
    std::array<Point<D>, D + 1> point;     // ascending
    std::array<std::int64_t, D + 1> id;    // of these
    std::array<std::int64_t, D + 1> given; // in the order of the row
    bool created;

    auto operator<=>(const ChangedSimplex &) const = default;
};

template <int D> ChangedSimplex<D> changed(const abacus_simplex &s, bool created) {
    ChangedSimplex<D> result{};
    result.code = s.code;
    result.created = created;
    std::array<std::pair<Point<D>, std::int64_t>, D + 1> corners;
    for (int i = 0; i <= D; ++i) {
        std::copy_n(s.corner[i], D, corners[i].first.begin());
        corners[i].second = result.given[i] = s.id[i];
    }
    std::sort(corners.begin(), corners.end());
    for (int i = 0; i <= D; ++i) {
        result.point[i] = corners[i].first;
        result.id[i] = corners[i].second;
    }
    return result;
}

template <int D> class Returned {
public:
    using Rows = std::vector<ChangedSimplex<D>>;

    explicit Returned(MeshOf<D> &mesh, std::size_t memory = 4 << 20)
        : mesh_(mesh), memory_(memory) {}

    void insert(const std::vector<InputOf<D>> &points, abacus_on_duplicate how = ABACUS_KEEP) {
        const abacus_header before = mesh_.header;
        expect([&] {
            return mesh_.with_stage(points, 16 << 20, [&](abacus_stage *stage) {
                const abacus_status ended =
                    abacus_stage_end(stage, &mesh_.header.facts, &mesh_.error);
                return ended != ABACUS_OK ? ended : run([&](abacus_build *build) {
                    return abacus_build_insert(build, stage, how, &mesh_.header, &mesh_.error);
                });
            });
        });
        domain_changed = before.facts.form.has_domain != 0 &&
                         (!std::equal(before.facts.form.lower, before.facts.form.lower + D,
                                      mesh_.header.facts.form.lower) ||
                          !std::equal(before.facts.form.upper, before.facts.form.upper + D,
                                      mesh_.header.facts.form.upper));
    }
    void remove(const std::vector<InputOf<D>> &points) {
        expect([&] {
            return mesh_.with_stage(
                points, 16 << 20,
                [&](abacus_stage *stage) {
                    return run([&](abacus_build *build) {
                        std::uint64_t deleted = 0;
                        return abacus_build_delete(build, stage, 0, &mesh_.header, &deleted,
                                                   &mesh_.error);
                    });
                },
                false);
        });
    }

    Rows rows; ///< of the last change
    bool domain_changed = false;

private:
    static abacus_host_status take(void *context, int created, const abacus_simplex *simplex) {
        static_cast<Returned *>(context)->rows.push_back(changed<D>(*simplex, created != 0));
        return ABACUS_HOST_OK;
    }
    template <class Change> abacus_status run(Change change) {
        return mesh_.with_build([&](abacus_build *build) {
            abacus_status status = abacus_build_log(build, memory_, &mesh_.error);
            if (status == ABACUS_OK) status = change(build);
            if (status == ABACUS_OK) status = abacus_build_report(build, take, this, &mesh_.error);
            return status;
        });
    }
    Rows all(bool created) {
        Rows result;
        for (const abacus_simplex &s : mesh_.simplices(false))
            result.push_back(changed<D>(s, created));
        return result;
    }
    /// The report of a change is the difference between the mesh before and after.
    template <class Change> void expect(Change change) {
        rows.clear();
        Rows before = all(false);
        ASSERT_EQ(change(), ABACUS_OK) << mesh_.error.message << ' ' << mesh_.error.detail;
        Rows after = all(true);
        const Domain<D> domain = domain_of<D>(mesh_.header.facts.form);
        for (ChangedSimplex<D> &s : before) {
            s.code = 0;
            for (const Point<D> &p : s.point) s.code = std::max(s.code, domain.code(p));
        }
        std::sort(before.begin(), before.end());
        std::sort(after.begin(), after.end());
        const auto less = [](ChangedSimplex<D> a, ChangedSimplex<D> b) {
            a.created = b.created = false;
            return a < b;
        };
        Rows expected;
        std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                            std::back_inserter(expected), less);
        std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                            std::back_inserter(expected), less);
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(rows.size(), expected.size());
        EXPECT_TRUE(rows == expected);
        EXPECT_EQ(mesh_.host.violations, std::vector<std::string>{});
        EXPECT_TRUE(mesh_.host.spools.empty());
        EXPECT_EQ(mesh_.host.bytes, 0u);
    }

    MeshOf<D> &mesh_;
    const std::size_t memory_;
};

} // namespace abacus::test
