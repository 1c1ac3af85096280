// How the core fails.
#pragma once

#include <abacus/host_functions.h>

#include <stdexcept>
#include <string>

namespace abacus {

/// Thrown when a host function failed; the host keeps the error itself.
struct HostFailure {};

/// An error of the core's own; ends in src/capi as an abacus_error.
class Error : public std::runtime_error {
public:
    Error(abacus_error_kind kind, const std::string &message, std::string detail = {},
          std::string hint = {})
        : std::runtime_error(message), kind(kind), detail(std::move(detail)),
          hint(std::move(hint)) {}

    abacus_error_kind kind;
    std::string detail;
    std::string hint;
};

/// Stored bytes that the core did not write. `whole` is what they are of.
[[noreturn]] inline void throw_corrupted(const std::string &detail,
                                         const std::string &whole = "mesh") {
    throw Error(ABACUS_ERROR_CORRUPTED, whole + " is corrupted", detail,
                "Run abacus_check on the " + whole +
                    "; restore it from a backup or build it anew.");
}

namespace host {

/// Whether a host function found something; throws if it failed.
inline bool found(abacus_host_status status) {
    if (status == ABACUS_HOST_FAILED) throw HostFailure{};
    return status == ABACUS_HOST_OK;
}
inline void require(abacus_host_status status) {
    if (status != ABACUS_HOST_OK) throw HostFailure{};
}

} // namespace host

} // namespace abacus
