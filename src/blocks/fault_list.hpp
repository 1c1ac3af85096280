// The faults that a check has found, and the page where it is.
#pragma once

#include "host/arena.hpp"
#include "keys/key.hpp"

#include <abacus/check.h>
#include <cstdio>

namespace abacus {

class FaultList {
public:
    /// Keeps the first `limit` faults.
    FaultList(const Memory &memory, std::size_t limit) : faults_(memory), limit_(limit) {}

    void add(const char *kind, const Key &key, const char *message) {
        if (faults_.size() >= limit_) return;
        abacus_fault fault{key, kind, {}};
        std::snprintf(fault.message, sizeof fault.message, "%s", message);
        faults_.push_back(fault);
    }
    /// Of the current page.
    void add(const char *kind, const char *message) { add(kind, at, message); }
    /// One of what the current page says of its content, which may well hold together.
    void add_of_content(const char *kind, const char *message) {
        const std::size_t before = size();
        add(kind, message);
        of_content_ += size() - before;
    }
    /// Runs a pass; a page so damaged that the pass cannot go on is a fault of its own.
    template <class Pass> void run(const char *kind, Pass pass) {
        try {
            pass();
        } catch (const Error &error) {
            if (error.kind != ABACUS_ERROR_CORRUPTED) throw;
            add(kind, error.detail.c_str());
        }
    }

    /// The next one that was not handed out; false after the last.
    bool next(abacus_fault &fault) {
        if (at_ == faults_.size()) return false;
        fault = faults_[at_++];
        return true;
    }

    std::size_t size() const { return faults_.size(); }
    const abacus_fault &operator[](std::size_t i) const { return faults_[i]; }
    /// Whether there are no faults but of content.
    bool is_sound() const { return size() == of_content_; }
    /// Forgets faults from the n-th on, none of which is of content.
    void shorten(std::size_t n) { faults_.resize(n); }

    Key at{}; ///< of the current page

private:
    Arena<abacus_fault> faults_;
    std::size_t of_content_ = 0, at_ = 0;
    const std::size_t limit_;
};

} // namespace abacus
