#include "memory_host.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>

namespace abacus {

void MemoryHost::Page::assign(const unsigned char *bytes, std::size_t new_size) {
    words.assign((new_size + 7) / 8, 0);
    if (new_size > 0) std::memcpy(words.data(), bytes, new_size);
    size = new_size;
}

std::uint64_t MemoryHost::Calls::fallible() const {
    return poll + progress + find + fetch + next + put + erase + spool_create + spool_write +
           spool_rewind + spool_read + spool_close + spool_expect + spool_fits;
}

void MemoryHost::restore(const MemoryHost &other) {
    pages = other.pages;
    staged_pages = other.staged_pages;
    repeated_pages = other.repeated_pages;
    attribute_pages = other.attribute_pages;
    keys_by_location_ = other.keys_by_location_;
    next_location_ = other.next_location_;
}

void MemoryHost::recover() {
    failed = cancelled = false;
    interrupted = 0;
    fail_at_ = fail_resize_at_ = 0;
    // Open spools go away with the transaction.
    for (Spool *spool : spools) delete spool;
    spools.clear();
}

/// Counts a call; false if it must fail.
bool MemoryHost::enter(std::uint64_t &counter) {
    ++counter;
    if (failed) violation("a host function other than resize() is called after a failure");
    std::fill(lent_.begin(), lent_.end(), 0xdeadbeefdeadbeefu);
    if (fail_at_ == 0 || calls.fallible() != fail_at_) return true;
    failed = true;
    return false;
}

MemoryHost::Pages &MemoryHost::pages_of(abacus_page_kind kind) {
    switch (kind) {
    case ABACUS_SIMPLEX_PAGES:
        break;
    case ABACUS_STAGED_PAGES:
        return staged_pages;
    case ABACUS_REPEATED_PAGES:
        return repeated_pages;
    case ABACUS_ATTRIBUTE_PAGES:
        return attribute_pages;
    case ABACUS_STEP_PAGES:
        return step_pages;
    }
    return pages;
}

const unsigned char *MemoryHost::hand_out(Page &page) {
    if (!strict) return page.bytes();
    lent_ = page.words;
    return reinterpret_cast<const unsigned char *>(lent_.data());
}

void MemoryHost::hand_out(const abacus_key &key, Page &stored, abacus_page *page) {
    page->key = key;
    page->bytes = hand_out(stored);
    page->size = stored.size;
    page->location = stored.location;
}

/// The functions of the table.
struct MemoryHost::Functions {
    static MemoryHost &self(void *context) { return *static_cast<MemoryHost *>(context); }

    static abacus_host_status fail(MemoryHost &host, const std::string &what) {
        host.violation(what);
        host.failed = true;
        return ABACUS_HOST_FAILED;
    }

    // Every block is preceded by its size.
    static constexpr std::size_t prefix = 16;

    static void *resize(void *context, void *block, std::size_t size) {
        MemoryHost &host = self(context);
        auto *old = block == nullptr ? nullptr : static_cast<unsigned char *>(block) - prefix;
        std::size_t old_size = 0;
        if (old != nullptr) std::memcpy(&old_size, old, sizeof old_size);
        ++host.calls.resize;
        if (size == 0) {
            host.bytes -= old_size;
            std::free(old);
            return nullptr;
        }
        if (host.calls.resize == host.fail_resize_at_) return nullptr;
        if (size > host.memory_limit || host.bytes - old_size > host.memory_limit - size)
            return nullptr;
        auto *moved = static_cast<unsigned char *>(std::realloc(old, size + prefix));
        if (moved == nullptr) return nullptr;
        std::memcpy(moved, &size, sizeof size);
        host.bytes += size - old_size;
        host.peak_bytes = std::max(host.peak_bytes, host.bytes);
        return moved + prefix;
    }

    static abacus_host_status poll(void *context) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.poll)) return ABACUS_HOST_FAILED;
        host.interrupted = 0;
        if (!host.cancelled) return ABACUS_HOST_OK;
        host.failed = true;
        return ABACUS_HOST_FAILED;
    }

    static abacus_host_status progress(void *context, const abacus_progress *progress) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.progress)) return ABACUS_HOST_FAILED;
        host.last_progress = *progress;
        if (host.on_progress) host.on_progress(*progress);
        return ABACUS_HOST_OK;
    }

    static abacus_host_status find(void *context, abacus_page_kind kind, abacus_key key,
                                   abacus_page *page) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.find)) return ABACUS_HOST_FAILED;
        Pages &pages = host.pages_of(kind);
        auto it = pages.upper_bound(key);
        if (it == pages.begin()) return ABACUS_HOST_NONE;
        --it;
        host.hand_out(it->first, it->second, page);
        return ABACUS_HOST_OK;
    }

    static abacus_host_status fetch(void *context, abacus_page_kind kind, abacus_page *page) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.fetch)) return ABACUS_HOST_FAILED;
        const auto key = host.keys_by_location_.find(page->location);
        if (key == host.keys_by_location_.end()) return ABACUS_HOST_NONE;
        const auto it = host.pages_of(kind).find(key->second);
        if (it == host.pages_of(kind).end() || it->second.location != page->location)
            return ABACUS_HOST_NONE;
        host.hand_out(it->first, it->second, page);
        return ABACUS_HOST_OK;
    }

    static abacus_host_status next(void *context, abacus_page_kind kind, const abacus_key *key,
                                   abacus_page *page) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.next)) return ABACUS_HOST_FAILED;
        Pages &pages = host.pages_of(kind);
        const auto it = key == nullptr ? pages.begin() : pages.upper_bound(*key);
        if (it == pages.end()) return ABACUS_HOST_NONE;
        host.hand_out(it->first, it->second, page);
        return ABACUS_HOST_OK;
    }

    /// Removes the version at a location; false if it is no longer current.
    static bool remove(MemoryHost &host, abacus_page_kind kind, std::uint64_t location) {
        const auto it = host.keys_by_location_.find(location);
        if (it == host.keys_by_location_.end() || host.pages_of(kind).erase(it->second) == 0)
            return false;
        host.keys_by_location_.erase(it);
        return true;
    }

    static abacus_host_status put(void *context, abacus_page_kind kind, abacus_page *page) {
        MemoryHost &host = self(context);
        // The bytes may be those that were lent: copy them before they are spoilt.
        Page stored;
        stored.assign(page->bytes, page->size);
        if (!host.enter(host.calls.put)) return ABACUS_HOST_FAILED;
        if (page->size == 0 || page->size > ABACUS_MAX_PAGE_BYTES)
            return fail(host, "a page of " + std::to_string(page->size) + " bytes is put");
        if (page->key.code >> 63 != 0 || page->key.part >> 63 != 0)
            return fail(host, "a key is out of range");
        if (page->location != 0 && !remove(host, kind, page->location))
            return fail(host, "a page replaces a version that is no longer current");
        stored.location = host.next_location_++;
        page->location = stored.location;
        if (!host.pages_of(kind).emplace(page->key, std::move(stored)).second)
            return fail(host, "a second page is put under one key");
        host.keys_by_location_.emplace(page->location, page->key);
        return ABACUS_HOST_OK;
    }

    static abacus_host_status erase(void *context, abacus_page_kind kind, const abacus_page *page) {
        MemoryHost &host = self(context);
        const std::uint64_t location = page->location;
        if (!host.enter(host.calls.erase)) return ABACUS_HOST_FAILED;
        if (!remove(host, kind, location))
            return fail(host, "a version is erased that is no longer current");
        return ABACUS_HOST_OK;
    }

    static abacus_host_status spool_create(void *context, void **spool) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.spool_create)) return ABACUS_HOST_FAILED;
        auto *created = new Spool;
        host.spools.insert(created);
        host.peak_spools = std::max(host.peak_spools, host.spools.size());
        *spool = created;
        return ABACUS_HOST_OK;
    }

    static Spool *known(MemoryHost &host, void *spool) {
        auto *known = static_cast<Spool *>(spool);
        return host.spools.count(known) != 0 ? known : nullptr;
    }

    /// Copies between `bytes` and the spool from `at` on, chunk by chunk.
    template <class Copy>
    static void each_chunk(Spool &spool, std::size_t at, std::size_t size, Copy copy) {
        for (std::size_t done = 0; done < size;) {
            const std::size_t inside = (at + done) % Spool::chunk_bytes;
            const std::size_t part = std::min(size - done, Spool::chunk_bytes - inside);
            const std::size_t index = (at + done) / Spool::chunk_bytes;
            if (index == spool.chunks.size())
                spool.chunks.emplace_back(new unsigned char[Spool::chunk_bytes]);
            copy(spool.chunks[index].get() + inside, done, part);
            done += part;
        }
    }

    static abacus_host_status spool_write(void *context, void *spool, const void *bytes,
                                          std::size_t size) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.spool_write)) return ABACUS_HOST_FAILED;
        Spool *to = known(host, spool);
        if (to == nullptr || to->reading) return fail(host, "a spool is written out of turn");
        const auto *source = static_cast<const unsigned char *>(bytes);
        each_chunk(*to, to->size, size, [&](unsigned char *chunk, std::size_t done, std::size_t n) {
            std::memcpy(chunk, source + done, n);
        });
        to->size += size;
        host.spooled_bytes += size;
        return ABACUS_HOST_OK;
    }

    static abacus_host_status spool_rewind(void *context, void *spool) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.spool_rewind)) return ABACUS_HOST_FAILED;
        Spool *from = known(host, spool);
        if (from == nullptr) return fail(host, "an unknown spool is rewound");
        from->reading = true;
        from->read = 0;
        return ABACUS_HOST_OK;
    }

    static abacus_host_status spool_read(void *context, void *spool, void *bytes,
                                         std::size_t size) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.spool_read)) return ABACUS_HOST_FAILED;
        Spool *from = known(host, spool);
        if (from == nullptr || !from->reading) return fail(host, "a spool is read out of turn");
        if (from->read == from->size) return ABACUS_HOST_NONE;
        if (size > from->size - from->read)
            return fail(host, "a read goes over the end of a spool");
        auto *target = static_cast<unsigned char *>(bytes);
        each_chunk(*from, from->read, size,
                   [&](unsigned char *chunk, std::size_t done, std::size_t n) {
                       std::memcpy(target + done, chunk, n);
                   });
        from->read += size;
        return ABACUS_HOST_OK;
    }

    static abacus_host_status spool_expect(void *context, double bytes) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.spool_expect)) return ABACUS_HOST_FAILED;
        host.expected_bytes = std::max(host.expected_bytes, bytes);
        host.failed = bytes > host.spool_room;
        return host.failed ? ABACUS_HOST_FAILED : ABACUS_HOST_OK;
    }

    static abacus_host_status spool_fits(void *context, double bytes) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.spool_fits)) return ABACUS_HOST_FAILED;
        return bytes > host.spool_room ? ABACUS_HOST_NONE : ABACUS_HOST_OK;
    }

    static abacus_host_status spool_close(void *context, void *spool) {
        MemoryHost &host = self(context);
        if (!host.enter(host.calls.spool_close)) return ABACUS_HOST_FAILED;
        Spool *closed = known(host, spool);
        if (closed == nullptr) return fail(host, "an unknown spool is closed");
        host.spools.erase(closed);
        delete closed;
        return ABACUS_HOST_OK;
    }
};

MemoryHost::MemoryHost() {
    table_.context = this;
    table_.resize = Functions::resize;
    table_.interrupted = &interrupted;
    table_.poll = Functions::poll;
    table_.progress = Functions::progress;
    table_.find = Functions::find;
    table_.fetch = Functions::fetch;
    table_.next = Functions::next;
    table_.put = Functions::put;
    table_.erase = Functions::erase;
    table_.spool_create = Functions::spool_create;
    table_.spool_write = Functions::spool_write;
    table_.spool_rewind = Functions::spool_rewind;
    table_.spool_read = Functions::spool_read;
    table_.spool_close = Functions::spool_close;
    table_.spool_expect = Functions::spool_expect;
    table_.spool_fits = Functions::spool_fits;
}

MemoryHost::~MemoryHost() { recover(); }

} // namespace abacus
