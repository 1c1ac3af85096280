// Thinned meshes, over an in-memory host: the predicate that decides, against rational arithmetic;
// the cells that are due; and the same mesh whatever the caches, the memory and the threads.
#include "geometry/misfit.hpp"
#include "geometry/predicates.hpp"
#include "geometry/rational.hpp"
#include "support/oracle.hpp"
#include "thin/due_cells.hpp"

#include <abacus/thin.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace abacus::test {
namespace {

using Random = std::mt19937_64;

template <int D> Piece<D> random_piece(Random &random, double far) {
    std::uniform_real_distribution<double> unit(0, 1);
    std::uniform_int_distribution<int> level(-3, 3);
    Piece<D> piece;
    for (int i = 0; i <= D; ++i) {
        for (double &x : piece.corner[i]) x = far + std::floor(unit(random) * 64) / 8;
        piece.value[i] = level(random) * 0.1;
    }
    return piece;
}

template <int D> bool is_flat(const Piece<D> &piece) {
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &piece.corner[i];
    return orientation<D>(corners) == 0;
}

/// Doubles decide as rational numbers do, also where the bound is hit exactly.
template <int D> void expect_exact_decisions() {
    Random random(D);
    std::uniform_real_distribution<double> unit(0, 1);
    int decided = 0;
    for (int round = 0; round < 4000; ++round) {
        const Piece<D> piece = random_piece<D>(random, round % 2 == 0 ? 0 : 1e7);
        if (is_flat(piece)) continue;
        // A point of the simplex, often on a grid, and a value near the bound.
        Point<D> p{};
        for (int i = 0; i <= D; ++i)
            for (int axis = 0; axis < D; ++axis) p[axis] += piece.corner[i][axis] / (D + 1);
        const double value = piece.value[0] + std::floor(unit(random) * 9 - 4) * 0.1;
        const double error = exact::misfit<D>(piece, p, value);
        const Misfit<D> misfit(piece);
        const Magnitude found = misfit.of(p, value);
        for (const double bound : {0.0, error, std::nextafter(error, 0.0), std::nextafter(error, 9),
                                   error * 0.9, error * 1.1}) {
            const int order = exact::compare_misfit<D>(piece, p, value, bound);
            EXPECT_EQ(misfit.exceeds(p, value, found, bound), order > 0) << round;
            if (order > 0) {
                EXPECT_TRUE(misfit.may_exceed(value, found, bound)) << round;
            }
            decided += order != 0 ? 1 : 0;
        }
        EXPECT_EQ(exact::compare_misfits<D>(piece, p, value, piece, p, value), 0);
    }
    EXPECT_GT(decided, 1000);
}

TEST(ThinTest, DecisionsAreExactInThePlane) { expect_exact_decisions<2>(); }
TEST(ThinTest, DecisionsAreExactInSpace) { expect_exact_decisions<3>(); }

/// The cells of a box contain those of its points, and a box meets the cell of a point in it.
template <int D> void expect_no_cell_missed() {
    Random random(D);
    std::uniform_real_distribution<double> unit(-0.2, 1.2);
    const MemoryHost memory;
    const Host host(*memory.table());
    Point<D> lower, upper;
    lower.fill(0);
    upper.fill(1);
    DueCells<D> cells(host, Domain<D>(lower, upper));
    for (int round = 0; round < 300; ++round) {
        Box<D> box;
        Point<D> a, b, inside;
        for (int axis = 0; axis < D; ++axis) {
            a[axis] = unit(random);
            b[axis] = round % 3 == 0 ? unit(random) : a[axis] + unit(random) / 100;
            inside[axis] = a[axis] + (b[axis] - a[axis]) * 0.3;
        }
        box.extend(a);
        box.extend(b);
        cells.clear();
        cells.add(box);
        EXPECT_TRUE(cells.has(inside));
        cells.clear();
        EXPECT_FALSE(cells.meets(box));
        cells.add(inside);
        EXPECT_TRUE(cells.has(inside));
        EXPECT_TRUE(cells.meets(box));
    }
}

TEST(ThinTest, NoCellIsMissed) {
    expect_no_cell_missed<2>();
    expect_no_cell_missed<3>();
}

// ---- Whole meshes ------------------------------------------------------------------------

struct Setting {
    std::size_t cache_bytes, sort_bytes;
    unsigned threads;
};

/// A mesh thinned through the C interface, and its greatest error.
template <int D> struct Thinned : MeshOf<D> {
    Thinned(MeshOf<D> &source, double max_error, const Setting &setting)
        : MeshOf<D>(1, setting.cache_bytes), source_(source) {
        this->header.facts.form = source.header.facts.form;
        this->host.set_threads(setting.threads, setting.threads > 1);
        const abacus_thin_options options{0, max_error, 0, setting.sort_bytes, setting.cache_bytes};
        EXPECT_EQ(abacus_thin_open(this->host.table(), &this->header.facts, &options, &thinning_,
                                   &this->error),
                  ABACUS_OK);
        step(ABACUS_THIN_START);
        while (step(ABACUS_THIN_HULL) > 0) {
        }
        while (step(ABACUS_THIN_WORST) > 0) ++rounds;
        EXPECT_EQ(abacus_thin_greatest(thinning_, source.host.table(), &source.header.facts,
                                       &this->header.facts, &greatest, &without_value,
                                       &this->error),
                  ABACUS_OK);
        abacus_thin_close(thinning_);
    }

    std::uint64_t step(abacus_thin_step which) {
        std::uint64_t added = 0;
        const abacus_status status = this->with_stage({}, 1 << 20, [&](abacus_stage *stage) {
            const abacus_status found =
                abacus_thin_find(thinning_, which, source_.host.table(), &source_.header.facts,
                                 &this->header.facts, stage, &added, &this->error);
            if (found != ABACUS_OK || added == 0) return found;
            const abacus_status ended = abacus_stage_end(stage, &this->header.facts, &this->error);
            if (ended != ABACUS_OK) return ended;
            return this->with_build([&](abacus_build *build) {
                return abacus_build_insert(build, stage, ABACUS_KEEP, &this->header, &this->error);
            });
        });
        EXPECT_EQ(status, ABACUS_OK) << this->error.message;
        EXPECT_EQ(abacus_thin_inserted(thinning_, &this->header.facts, &this->error), ABACUS_OK);
        return added;
    }

    int rounds = 0;
    double greatest = 0;
    std::uint64_t without_value = 0;

private:
    MeshOf<D> &source_;
    abacus_thinning *thinning_ = nullptr;
};

/// Hills with a plateau, on a grid with some points beside it, and some without a value.
template <int D> std::vector<InputOf<D>> hills(int points) {
    Random random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<InputOf<D>> input;
    for (int i = 0; i < points; ++i) {
        Point<D> p;
        for (double &x : p) x = i % 3 == 0 ? unit(random) : std::floor(unit(random) * 32) / 32;
        double value = std::sin(p[0] * 7) + p[1] * p[D - 1];
        if (p[0] > 0.7) value = 0.5;
        if (i % 50 == 0) value = NAN;
        input.push_back({i, p, {value}});
    }
    return input;
}

template <int D> void expect_one_answer(int points, double max_error) {
    MeshOf<D> source(1);
    const std::vector<InputOf<D>> input = hills<D>(points);
    ASSERT_EQ(source.insert(input), ABACUS_OK) << source.error.message;
    Thinned<D> first(source, max_error, {64 << 20, 64 << 20, 1});
    EXPECT_LE(first.greatest, max_error);
    EXPECT_GT(first.rounds, 2);
    EXPECT_GT(first.without_value, 0U);
    EXPECT_LT(first.header.facts.census.vertices, source.header.facts.census.vertices / 2);
    const auto expected = first.positions();
    for (const Setting &setting : {Setting{1, 1, 1}, {1 << 20, 1, 3}, {1 << 20, 1 << 20, 7}}) {
        Thinned<D> other(source, max_error, setting);
        EXPECT_EQ(other.positions(), expected);
        EXPECT_EQ(other.greatest, first.greatest);
        EXPECT_EQ(other.without_value, first.without_value);
        EXPECT_EQ(other.check(), std::vector<std::string>{});
    }
}

TEST(ThinTest, OneAnswerInThePlane) { expect_one_answer<2>(4000, 0.02); }
TEST(ThinTest, OneAnswerInSpace) { expect_one_answer<3>(1500, 0.1); }

TEST(ThinTest, PointsOnALineAreRefused) {
    MeshOf<2> source(1);
    ASSERT_EQ(source.insert(
                  {{1, {0, 0}, {1.0}}, {2, {1, 1}, {2.0}}, {3, {2, 2}, {1.0}}, {4, {0, 1}, {NAN}}}),
              ABACUS_OK);
    MeshOf<2> thinned(1);
    thinned.header.facts.form = source.header.facts.form;
    const abacus_thin_options options{0, 0.5, 0, 1 << 20, 1 << 20};
    abacus_thinning *thinning = nullptr;
    ASSERT_EQ(abacus_thin_open(thinned.host.table(), &thinned.header.facts, &options, &thinning,
                               &thinned.error),
              ABACUS_OK);
    std::uint64_t added = 0;
    EXPECT_EQ(thinned.with_stage({}, 1 << 20,
                                 [&](abacus_stage *stage) {
                                     return abacus_thin_find(
                                         thinning, ABACUS_THIN_START, source.host.table(),
                                         &source.header.facts, &thinned.header.facts, stage, &added,
                                         &thinned.error);
                                 }),
              ABACUS_ERROR);
    EXPECT_EQ(thinned.error.kind, ABACUS_ERROR_ARGUMENT);
    EXPECT_STREQ(thinned.error.message, "the vertices with values lie on one line");
    abacus_thin_close(thinning);
}

} // namespace
} // namespace abacus::test
