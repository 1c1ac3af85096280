// Where points go, one after the other, once they are in order: to vertex pages, into the
// triangulation itself, or to a search for them there.
#pragma once

#include "sort/pacer.hpp"

namespace abacus {

class RecordSink {
public:
    /// Takes the next point: a record as in abacus_stage_add.
    virtual void add(const std::uint64_t *record) = 0;
    /// Takes the next n, of `stride` words each.
    virtual void add(const std::uint64_t *records, std::size_t n, std::size_t stride) {
        for (; n > 0; --n, records += stride) add(records);
    }
    /// Whether add() below saves it the work of finding codes.
    virtual bool takes_codes() const { return false; }
    /// Finds the codes of n records; for any thread.
    virtual void find_codes(const std::uint64_t * /*records*/, std::size_t /*n*/,
                            std::size_t /*stride*/, std::uint64_t * /*codes*/) const {}
    /// Takes the next n with their codes.
    virtual void add(const std::uint64_t *records, const std::uint64_t * /*codes*/, std::size_t n,
                     std::size_t stride) {
        add(records, n, stride);
    }
    /// After the last point.
    virtual void finish() = 0;
    /// Called now and then while the next points are looked for.
    virtual void meanwhile() {}
    /// Of the points taken, how many it holds back: nothing has been done with them.
    virtual std::size_t held_back() const { return 0; }
    /// The name of its work, and the pages that it has moved so far.
    virtual abacus_phase phase() const = 0;
    virtual PagesMoved pages_moved() const = 0;

protected:
    ~RecordSink() = default;
};

} // namespace abacus
