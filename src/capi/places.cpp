// Many places behind the C interface.
#include "query/places/places.hpp"
#include "query/scan/simplex_labels.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/nearest.hpp"

#include <abacus/values.h>

struct abacus_places {
    abacus_places(const abacus_host *table, const abacus_facts &facts, std::size_t memory,
                  std::size_t cache_bytes)
        : host(*table), places(host, facts, memory, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Places> places;
};

namespace abacus {
namespace {

template <int D> class Locating final : public Question<D> {
public:
    Locating(const Host &host, const abacus_facts &facts, abacus_place_report report, void *context)
        : labels_(host, facts), report_(report), context_(context) {}

    std::size_t words() const override { return 1 + sizeof(abacus_simplex) / 8; }
    bool is_quick() const override { return true; }
    void answer(Answerer<D> &by, const Point<D> &p, Tape &tape) const override {
        abacus_simplex simplex{};
        const std::uint64_t is_inside = by.reader.locate(p, simplex);
        tape.put(is_inside);
        if (is_inside != 0) tape.put(simplex);
    }
    void tell(std::int64_t id, Tape::Player &answers) const override {
        if (answers.take<std::uint64_t>() == 0)
            return host::require(report_(context_, id, nullptr, nullptr));
        const auto &simplex = answers.take<abacus_simplex>();
        host::require(report_(context_, id, &simplex, labels_.of(simplex)));
    }

private:
    mutable SimplexLabels<D> labels_; // for the session's thread; reading changes no answer
    const abacus_place_report report_;
    void *const context_;
};

template <int D> class Interpolating final : public Question<D> {
public:
    Interpolating(const abacus_interpolation &interpolation, abacus_values_report report,
                  void *context)
        : interpolation_(interpolation), report_(report), context_(context) {}

    std::size_t words() const override { return 1 + interpolation_.attributes; }
    bool is_quick() const override { return interpolation_.method == ABACUS_LINEAR; }
    void answer(Answerer<D> &by, const Point<D> &p, Tape &tape) const override {
        std::array<double, ABACUS_MAX_ATTRIBUTES> values;
        const std::uint64_t is_inside =
            by.interpolation.values(by.reader, interpolation_, p, values.data());
        tape.put(is_inside);
        if (is_inside != 0) tape.put(values.data(), interpolation_.attributes);
    }
    void tell(std::int64_t id, Tape::Player &answers) const override {
        const bool is_inside = answers.take<std::uint64_t>() != 0;
        const double *values =
            is_inside ? answers.take<double>(interpolation_.attributes) : nullptr;
        host::require(report_(context_, id, values));
    }

private:
    const abacus_interpolation &interpolation_;
    const abacus_values_report report_;
    void *const context_;
};

template <int D> class Weighing final : public Question<D> {
public:
    Weighing(const abacus_interpolation &interpolation, abacus_weights_report report, void *context)
        : interpolation_(interpolation), report_(report), context_(context) {}

    std::size_t words() const override {
        // A place among uniform vertices has 6 natural neighbours in the plane, 16 in space.
        const std::size_t weights =
            interpolation_.method == ABACUS_NATURAL ? (D == 2 ? 8 : 20) : D + 1;
        return 1 + weights * sizeof(abacus_weight) / 8;
    }
    bool is_quick() const override { return interpolation_.method == ABACUS_LINEAR; }
    void answer(Answerer<D> &by, const Point<D> &p, Tape &tape) const override {
        const bool is_inside = by.interpolation.weigh(by.reader, interpolation_, p);
        const Arena<abacus_weight> &weights = by.interpolation.weights();
        const std::uint64_t n = is_inside ? weights.size() : 0;
        tape.put(n);
        tape.put(weights.data(), n);
    }
    void tell(std::int64_t id, Tape::Player &answers) const override {
        const auto n = answers.take<std::uint64_t>();
        host::require(report_(context_, id, answers.take<abacus_weight>(n), n));
    }

private:
    const abacus_interpolation &interpolation_;
    const abacus_weights_report report_;
    void *const context_;
};

template <int D> class Nearing final : public Question<D> {
public:
    Nearing(const abacus_facts &facts, std::uint64_t k, abacus_nearest_report report, void *context)
        : record_words_(record_words(D, facts.columns.attributes)),
          words_(1 + std::min({k, facts.census.vertices, most_counted}) * (1 + record_words_)),
          k_(k), report_(report), context_(context) {}

    std::size_t words() const override { return words_; }
    void answer(Answerer<D> &by, const Point<D> &p, Tape &tape) const override {
        const std::size_t at = tape.size();
        std::uint64_t n = 0;
        tape.put(n);
        Nearest<D>(by.reader).find(p, k_, [&](const std::uint64_t *record) {
            tape.put(distance<D>(p, record_point<D>(record)));
            tape.put(record, record_words_);
            ++n;
        });
        tape.set(at, n);
    }
    void tell(std::int64_t id, Tape::Player &answers) const override {
        const auto n = answers.take<std::uint64_t>();
        for (std::uint64_t rank = 1; rank <= n; ++rank) {
            const auto from = answers.take<double>();
            report_vertex<D>(id, rank, answers.take<std::uint64_t>(record_words_), from, report_,
                             context_);
        }
    }

private:
    static constexpr std::uint64_t most_counted = std::uint64_t{1} << 32; // far too many anyway

    const std::size_t record_words_, words_;
    const std::uint64_t k_;
    const abacus_nearest_report report_;
    void *const context_;
};

} // namespace
} // namespace abacus

abacus_status abacus_places_open(const abacus_host *host, const abacus_facts *facts, size_t memory,
                                 size_t cache_bytes, abacus_places **places, abacus_error *error) {
    return abacus::guard(error, [&] {
        *places = abacus::create_handle<abacus_places>(host, *facts, memory, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_places_add(abacus_places *places, const uint64_t *records, size_t count,
                                abacus_error *error) {
    return abacus::dispatch(places->places, error, [&](auto &all) { all.add(records, count); });
}

abacus_status abacus_places_locate(abacus_places *places, abacus_place_report report, void *context,
                                   abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::Places<D> &all) {
        all.each(abacus::Locating<D>(places->host, all.facts(), report, context));
    });
}

abacus_status abacus_places_interpolate(abacus_places *places,
                                        const abacus_interpolation *interpolation,
                                        abacus_values_report report, void *context,
                                        abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::Places<D> &all) {
        all.each(abacus::Interpolating<D>(*interpolation, report, context));
    });
}

abacus_status abacus_places_weigh(abacus_places *places, const abacus_interpolation *interpolation,
                                  abacus_weights_report report, void *context,
                                  abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::Places<D> &all) {
        all.each(abacus::Weighing<D>(*interpolation, report, context));
    });
}

abacus_status abacus_places_nearest(abacus_places *places, uint64_t k, abacus_nearest_report report,
                                    void *context, abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::Places<D> &all) {
        all.each(abacus::Nearing<D>(all.facts(), k, report, context));
    });
}

void abacus_places_close(abacus_places *places) { abacus::destroy_handle(places); }
