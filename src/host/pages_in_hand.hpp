// Pages that go from one cache to another in memory: from the session's to those of threads.
//
// The session's thread keeps them instead of storing them. Threads find them at their desk
// (desk.hpp) as if they were stored. A page that a thread has changed is stored for the first time;
// what none has changed is stored in the end. So pages are not written, read and written again.
//
// A page in hand may be a new version of a stored one, which it hides.
//
// Invariants
//   1. Pages in hand have places of their own, which no host has. A place is good until the page is
//      stored or erased.
//   2. No page has changed that has not been handed out: it owns the stretch of the curve that it
//      owned in the beginning.
#pragma once

#include "host/arena.hpp"
#include "host/host.hpp"

namespace abacus {

class PagesInHand final : public PageKeeper {
public:
    explicit PagesInHand(const Memory &memory) : pages_(memory), bytes_(memory) {}
    PagesInHand(const PagesInHand &) = delete;
    PagesInHand &operator=(const PagesInHand &) = delete;

    /// From now on pages of this kind are kept, up to so many bytes.
    void begin(abacus_page_kind kind, std::size_t most_bytes);
    bool keep(abacus_page_kind kind, abacus_page &page) override;
    /// Those that are kept can be found from now on.
    void end(const Host &host);
    bool empty() const { return pages_.empty(); }
    /// The memory that they take.
    std::size_t bytes() const { return bytes_.size(); }
    struct Count {
        std::size_t pages = 0, new_versions = 0, bytes = 0;
    };
    const Count &kept() const { return kept_; }
    /// Those that have been stored, and had never been before.
    std::size_t stored_first() const { return stored_first_; }
    /// Stores what is left, and forgets all.
    Count store(const Host &host);

    // As the functions of a host:
    bool find(const Host &host, abacus_page_kind kind, abacus_key key, abacus_page &page);
    bool fetch(const Host &host, abacus_page_kind kind, abacus_page &page);
    bool next(const Host &host, abacus_page_kind kind, const abacus_key *key, abacus_page &page);
    void put(const Host &host, abacus_page_kind kind, abacus_page &page);
    void erase(const Host &host, abacus_page_kind kind, const abacus_page &page);

private:
    struct InHand {
        abacus_key key;
        std::uint64_t location; ///< of the stored version, 0 if there is none
        std::size_t begin, size;
        bool is_handed_out, is_gone;
    };
    /// A location with this bit is a page in hand. Desks have another bit of their own.
    static constexpr std::uint64_t in_hand_bit = std::uint64_t{1} << 62;

    static void count(Count &count, const InHand &kept);
    static bool is_less(const abacus_key &a, const abacus_key &b) {
        return a.code != b.code ? a.code < b.code : a.part < b.part;
    }
    bool has(abacus_page_kind kind, const abacus_page &page) const {
        return kind == kind_ && (page.location & in_hand_bit) != 0;
    }
    InHand *at(std::uint64_t location);
    /// The first with a greater key, gone or not.
    InHand *after(const abacus_key &key);
    void hand_out(InHand &kept, abacus_page &page);

    Arena<InHand> pages_; ///< from end() on in the order of their keys
    Arena<unsigned char> bytes_;
    abacus_page_kind kind_ = 0;
    std::size_t most_bytes_ = 0; ///< 0 unless pages are kept now
    bool are_all_ = false;       ///< nothing was stored when they were kept
    Count kept_;
    std::size_t stored_first_ = 0;
};

} // namespace abacus
