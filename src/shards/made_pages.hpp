// Pages that are made, to be handed out one after the other instead of stored.
#pragma once

#include "host/arena.hpp"
#include "keys/key.hpp"

namespace abacus {

class MadePages final : public PageKeeper {
public:
    explicit MadePages(const Memory &memory) : pages_(memory), words_(memory) {}

    bool keep(abacus_page_kind, abacus_page &page) override {
        pages_.push_back({page.key, words_.size(), page.size});
        const std::size_t words = (page.size + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);
        std::memcpy(words_.extend(words), page.bytes, page.size);
        page.location = pages_.size();
        return true;
    }
    /// The next one; false if there is none. Valid until a page is made.
    bool next(abacus_page &page) {
        if (at_ == pages_.size()) return false;
        const Made &made = pages_[at_++];
        page = {made.key, reinterpret_cast<const unsigned char *>(words_.data() + made.begin),
                made.size, 0};
        return true;
    }
    void clear() {
        pages_.clear();
        words_.clear();
        at_ = 0;
    }

private:
    struct Made {
        Key key;
        std::size_t begin, size; // in words, in bytes
    };
    Arena<Made> pages_;
    Arena<std::uint64_t> words_;
    std::size_t at_ = 0;
};

} // namespace abacus
