// The locations of pages that a reader has used, so that the host need not search for them again.
//
// A stamp identifies one state of a mesh for ever, and a reader lives as long as its stamp. So the
// known interval of a page stays valid. The host may move a page meanwhile. So its location is a
// hint, and the key of the page there is checked.
#pragma once

#include "blocks/directory.hpp"

#include <algorithm>

namespace abacus {

struct KnownPage {
    std::uint64_t lower, upper; // codes
    std::uint64_t location;
    double spacing;             // of vertices, in cells of the curve
    const unsigned char *bytes; // where they were; they are not read there
};

class KnownPages {
public:
    /// Keeps to about this many bytes: pages beyond them stay unknown.
    KnownPages(const Host &host, std::size_t bytes)
        : directory_(host), pages_(host), most_(bytes / bytes_per_page) {}

    /// The page that owns {code, 0}; null if it is unknown.
    const KnownPage *find(std::uint64_t code) const {
        const std::uint32_t page = directory_.floor({code, 0});
        return page != Directory::none && code < pages_[page].upper ? &pages_[page] : nullptr;
    }
    /// Adds a page, or says where it is now.
    void learn(const KnownPage &page) {
        const std::uint32_t before = directory_.floor({page.lower, 0});
        if (before != Directory::none && pages_[before].lower == page.lower) {
            pages_[before] = page;
        } else if (pages_.size() < most_) {
            directory_.insert({page.lower, 0}, static_cast<std::uint32_t>(pages_.size()));
            pages_.push_back(page);
        }
    }
    std::size_t bytes() const { return pages_.size() * bytes_per_page; }

private:
    // Pieces of a directory are three quarters full, as a rule.
    static constexpr std::size_t bytes_per_page = sizeof(KnownPage) + 32;

    Directory directory_;
    Arena<KnownPage> pages_;
    const std::size_t most_;
};

} // namespace abacus
