// Where exceptions end. Every function of abacus.h that can fail runs its body in
// guard(). That turns whatever is thrown into a status and an abacus_error. It also
// leaves the rounding mode as it found it: CGAL's interval arithmetic changes the mode,
// and the caller is a server that does its own arithmetic.
#pragma once

#include "host/host.hpp"

#include <cfenv>
#include <exception>
#include <new>
#include <string_view>

namespace abacus {

/// Copies a text, truncated before a character of UTF-8 that does not fit whole.
template <std::size_t N> void copy_text(char (&to)[N], std::string_view from) noexcept {
    std::size_t length = from.size();
    if (length >= N) {
        length = N - 1;
        while (length > 0 && (static_cast<unsigned char>(from[length]) & 0xc0) == 0x80) --length;
    }
    from.copy(to, length);
    to[length] = '\0';
}

inline void fill_error(abacus_error *error, abacus_error_kind kind, std::string_view message,
                       std::string_view detail = {}, std::string_view hint = {}) noexcept {
    if (error == nullptr) return;
    error->kind = kind;
    copy_text(error->message, message);
    copy_text(error->detail, detail);
    copy_text(error->hint, hint);
}

/// Two sums tell, since asking the processor at every call of the core takes longer.
inline bool rounds_to_nearest() noexcept {
    volatile double tiny = 0x1p-60; // for the compiler no constant
    return 1.0 + tiny == 1.0 && 1.0 - tiny == 1.0;
}

/// The core computes in round-to-nearest and leaves the mode as it found it. Another one is kept
/// as a whole: it may be that of SSE alone, which CGAL changes, and fegetround() reads x87's.
class RoundingModeKept {
public:
    RoundingModeKept() noexcept : is_nearest_(rounds_to_nearest()) {
        if (is_nearest_) [[likely]]
            return;
        std::fegetenv(&found_);
        std::fesetround(FE_TONEAREST);
    }
    RoundingModeKept(const RoundingModeKept &) = delete;
    RoundingModeKept &operator=(const RoundingModeKept &) = delete;
    ~RoundingModeKept() {
        if (!is_nearest_)
            std::fesetenv(&found_);
        else if (!rounds_to_nearest())
            std::fesetround(FE_TONEAREST);
    }

private:
    const bool is_nearest_;
    std::fenv_t found_;
};

/// Runs `body`, which returns an abacus_status and may throw.
template <class Body> abacus_status guard(abacus_error *error, Body &&body) noexcept {
    const RoundingModeKept kept;
    try {
        return body();
    } catch (const HostFailure &) {
        return ABACUS_HOST_ERROR;
    } catch (const Error &e) {
        fill_error(error, e.kind, e.what(), e.detail, e.hint);
    } catch (const std::bad_alloc &) {
        fill_error(error, ABACUS_ERROR_MEMORY, "out of memory");
    } catch (const std::exception &e) { // CGAL::Failure_exception included
        fill_error(error, ABACUS_ERROR_INTERNAL, "unexpected failure", e.what());
    } catch (...) {
        fill_error(error, ABACUS_ERROR_INTERNAL, "unexpected failure");
    }
    return ABACUS_ERROR;
}

} // namespace abacus
