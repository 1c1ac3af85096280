#include "query/places.hpp"

#include "points/record.hpp"

namespace abacus {

namespace {

abacus_header without_attributes(abacus_header header) {
    header.attributes = 0;
    return header;
}

} // namespace

/// Gets the places in order.
template <int D> class Places<D>::Locator final : public RecordSink {
public:
    Locator(Reader<D> &reader, abacus_place_report report, void *context)
        : reader_(reader), report_(report), context_(context) {}

    void add(const std::uint64_t *record) override {
        const bool is_inside = reader_.locate(record_point<D>(record), simplex_);
        if (report_(context_, record_id(record), is_inside ? &simplex_ : nullptr) != ABACUS_HOST_OK)
            throw HostFailure{};
    }
    void finish() override {}

    abacus_phase phase() const override { return ABACUS_PHASE_LOCATING; }
    PagesMoved pages_moved() const override { return {reader_.pages_read(), 0}; }

private:
    Reader<D> &reader_;
    const abacus_place_report report_;
    void *const context_;
    abacus_simplex simplex_{};
};

template <int D>
Places<D>::Places(const Host &host, const abacus_header &header, std::size_t memory,
                  std::size_t cache_bytes)
    : shape_(without_attributes(header)), stage_(host, shape_, memory, false),
      reader_(host, header, CacheOptions{.budget = cache_bytes}, true) {}

template <int D> void Places<D>::locate(abacus_place_report report, void *context) {
    stage_.end(shape_); // a mesh without points has no domain
    Locator locator(reader_, report, context);
    stage_.emit(locator, shape_);
}

template class Places<2>;
template class Places<3>;

} // namespace abacus
