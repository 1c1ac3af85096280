// Staging behind the C interface.
#include "staging/stage.hpp"

#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <variant>

struct abacus_stage {
    abacus_stage(const abacus_host *table, const abacus_header &header, std::size_t memory)
        : host(*table) {
        switch (header.dimension) {
        case 2:
            stage.emplace<abacus::Stage<2>>(host, header, memory);
            break;
        case 3:
            stage.emplace<abacus::Stage<3>>(host, header, memory);
            break;
        default:
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "a mesh has 2 or 3 dimensions");
        }
    }

    const abacus::Host host;
    std::variant<std::monostate, abacus::Stage<2>, abacus::Stage<3>> stage;
};

namespace {

/// Runs `call` on the stage of whatever dimension.
template <class Call>
abacus_status dispatch(abacus_stage *stage, abacus_error *error, Call call) noexcept {
    return abacus::guard(error, [&] {
        if (auto *flat = std::get_if<abacus::Stage<2>>(&stage->stage)) call(*flat);
        if (auto *solid = std::get_if<abacus::Stage<3>>(&stage->stage)) call(*solid);
        return ABACUS_OK;
    });
}

} // namespace

abacus_status abacus_stage_open(const abacus_host *host, const abacus_header *header, size_t memory,
                                abacus_stage **stage, abacus_error *error) {
    return abacus::guard(error, [&] {
        *stage = abacus::create_handle<abacus_stage>(host, *header, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_stage_add(abacus_stage *stage, const uint64_t *points, size_t count,
                               abacus_error *error) {
    return dispatch(stage, error, [&](auto &staging) { staging.add(points, count); });
}

abacus_status abacus_stage_finish(abacus_stage *stage, abacus_header *header, abacus_error *error) {
    return dispatch(stage, error, [&](auto &staging) { staging.finish(*header); });
}

void abacus_stage_close(abacus_stage *stage) { abacus::destroy_handle(stage); }
