// A database for tests and benchmarks: an abacus_host that keeps everything in the memory of the
// process. Its content is public, so that tests can read pages and damage them. It also checks that
// the core keeps the contract of abacus/host_functions.h, and lists every breach in `violations`.
#pragma once

#include "host/host.hpp"
#include "keys/key.hpp"

#include <abacus/mesh_header.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace abacus {

/// abacus_key is a C type of the global namespace, where std::less would not find the
/// operators of keys/key.hpp.
struct KeyLess {
    bool operator()(const abacus_key &a, const abacus_key &b) const { return a < b; }
};

class MemoryHost {
public:
    /// Bytes in words, so that they are aligned to 8.
    struct Page {
        std::vector<std::uint64_t> words;
        std::size_t size = 0;
        std::uint64_t location = 0;

        unsigned char *bytes() { return reinterpret_cast<unsigned char *>(words.data()); }
        void assign(const unsigned char *bytes, std::size_t size);
    };

    /// A temporary file, in chunks: it grows without being copied.
    struct Spool {
        static constexpr std::size_t chunk_bytes = std::size_t{1} << 18;
        std::vector<std::unique_ptr<unsigned char[]>> chunks;
        std::size_t size = 0;
        std::size_t read = 0;
        bool reading = false;
    };

    /// Calls so far, by function.
    struct Calls {
        std::uint64_t resize = 0, poll = 0, progress = 0;
        std::uint64_t find = 0, fetch = 0, next = 0, put = 0, erase = 0;
        std::uint64_t spool_create = 0, spool_write = 0, spool_rewind = 0, spool_read = 0,
                      spool_close = 0, spool_expect = 0, spool_fits = 0;

        /// All except resize(): the calls that fail_at() counts.
        std::uint64_t fallible() const;
    };

    MemoryHost();
    MemoryHost(const MemoryHost &) = delete;
    MemoryHost &operator=(const MemoryHost &) = delete;
    ~MemoryHost();

    const abacus_host *table() const { return &table_; }
    /// The core may use this many threads; `tiny`: even for little work, in tiny pieces.
    void set_threads(unsigned threads, bool tiny) {
        table_.threads = threads;
        table_.tiny_intervals = tiny;
    }
    /// All threads together may have this many bytes; 0: any number.
    void limit_threads(std::size_t bytes) { table_.most_thread_bytes = bytes; }
    /// For code below the C interface.
    Host host() const { return Host(table_); }

    /// The n-th fallible call from now (1 = the next) fails; 0 = none.
    void fail_at(std::uint64_t n) { fail_at_ = n == 0 ? 0 : calls.fallible() + n; }
    /// The n-th request for memory from now gets none; 0 = none.
    void fail_resize_at(std::uint64_t n) { fail_resize_at_ = n == 0 ? 0 : calls.resize + n; }
    /// Takes over the stored pages of another host.
    void restore(const MemoryHost &other);
    /// Forgets a failure, so that the host can serve further handles.
    void recover();
    /// The next poll() fails, and the core is asked to poll.
    void cancel() {
        cancelled = true;
        interrupted = 1;
    }

    // The database.
    using Pages = std::map<abacus_key, Page, KeyLess>;
    Pages pages; ///< of simplices
    Pages staged_pages;
    Pages repeated_pages;
    Pages attribute_pages;
    Pages step_pages; ///< of one row each
    std::set<Spool *> spools;

    // The events so far.
    Calls calls;
    std::size_t bytes = 0; ///< allocated by resize() and not yet freed
    std::size_t peak_bytes = 0;
    std::size_t spooled_bytes = 0;
    double spool_room = 1e300, expected_bytes = 0; // at most, by one call of spool_expect
    std::size_t peak_spools = 0;
    abacus_progress last_progress{};
    bool failed = false; ///< a fallible call has failed; only resize() may follow
    std::vector<std::string> violations;

    // Settings for coming events.
    volatile int interrupted = 0;
    bool cancelled = false;
    std::size_t memory_limit = SIZE_MAX; ///< resize() beyond it gives NULL
    std::function<void(const abacus_progress &)> on_progress;
    /// Lend copies of pages and spoil them at the next call, as the contract allows; benchmarks
    /// turn it off.
    bool strict = true;

private:
    struct Functions;

    bool enter(std::uint64_t &counter);
    Pages &pages_of(abacus_page_kind kind);
    void violation(const std::string &what) { violations.push_back(what); }
    const unsigned char *hand_out(Page &page);
    void hand_out(const abacus_key &key, Page &stored, abacus_page *page);

    abacus_host table_{};
    std::uint64_t fail_at_ = 0;
    std::uint64_t fail_resize_at_ = 0;
    std::uint64_t next_location_ = 1;
    std::map<std::uint64_t, abacus_key> keys_by_location_;
    std::vector<std::uint64_t> lent_;
};

} // namespace abacus
