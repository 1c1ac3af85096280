// Labels of simplices behind the C interface.
#include "query/labelling.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"

#include <abacus/change.h>

struct abacus_labelling {
    abacus_labelling(const abacus_host *table, const abacus_header &header, std::uint32_t known,
                     std::span<const std::uint32_t> labels, std::size_t memory,
                     std::size_t cache_bytes)
        : host(*table), labelling(host, header, known, labels, memory, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Labelling> labelling;
};

abacus_status abacus_labelling_open(const abacus_host *host, const abacus_header *header,
                                    uint32_t known, const uint32_t *labels, size_t count,
                                    size_t memory, size_t cache_bytes, abacus_labelling **labelling,
                                    abacus_error *error) {
    return abacus::guard(error, [&] {
        *labelling = abacus::create_handle<abacus_labelling>(
            host, *header, known, std::span(labels, count), memory, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_labelling_add(abacus_labelling *labelling, const uint64_t *rows, size_t count,
                                   abacus_error *error) {
    return abacus::dispatch(labelling->labelling, error,
                            [&](auto &opened) { opened.add(rows, count); });
}

abacus_status abacus_labelling_end(abacus_labelling *labelling, abacus_header *header,
                                   abacus_error *error) {
    return abacus::dispatch(labelling->labelling, error, [&](auto &opened) {
        abacus_header changed = *header; // the caller's stays as it is if this fails
        opened.set(changed);
        *header = changed;
    });
}

void abacus_labelling_close(abacus_labelling *labelling) { abacus::destroy_handle(labelling); }
