// Labels of simplices behind the C interface.
#include "labels/labelling.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/named_by_reader.hpp"

#include <abacus/labels.h>

struct abacus_labelling {
    abacus_labelling(const abacus_host *table, const abacus_facts &facts, std::uint32_t known,
                     std::span<const std::uint32_t> labels, std::size_t memory,
                     std::size_t cache_bytes)
        : host(*table), cache_bytes(cache_bytes), labelling(host, facts, known, labels, memory) {}

    const abacus::Host host;
    const std::size_t cache_bytes;
    abacus::ByDimension<abacus::Labelling> labelling;
};

abacus_status abacus_labelling_open(const abacus_host *host, const abacus_facts *facts,
                                    uint32_t known, const uint32_t *labels, size_t count,
                                    size_t memory, size_t cache_bytes, abacus_labelling **labelling,
                                    abacus_error *error) {
    return abacus::guard(error, [&] {
        *labelling = abacus::create_handle<abacus_labelling>(
            host, *facts, known, std::span(labels, count), memory, cache_bytes);
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
    return abacus::set_by_reader(labelling->host, labelling->labelling, labelling->cache_bytes,
                                 *header, error);
}

void abacus_labelling_close(abacus_labelling *labelling) { abacus::destroy_handle(labelling); }
