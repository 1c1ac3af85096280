// Where a block is cut: its records with their keys, and how to part them at about some number.
#pragma once

#include "blocks/block.hpp"
#include "host/arena.hpp"
#include "keys/key.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace abacus {

class KeyCut {
public:
    struct Place {
        Key key;
        Handle handle;
    };

    explicit KeyCut(const Host &host) : places_(host) {}

    void clear() {
        places_.clear();
        least_ = key_word_end;
        greatest_ = 0;
    }
    /// A record; the part of its key is 0 until it is set.
    void add(std::uint64_t code, Handle h) {
        least_ = std::min(least_, code);
        greatest_ = std::max(greatest_, code);
        places_.push_back({{code, 0}, h});
    }

    std::size_t size() const { return places_.size(); }
    const Place &operator[](std::size_t i) const { return places_[i]; }
    const Place *begin() const { return places_.begin(); }
    const Place *end() const { return places_.end(); }
    Place *begin() { return places_.begin(); }
    Place *end() { return places_.end(); }
    std::uint64_t least_code() const { return least_; }
    std::uint64_t greatest_code() const { return greatest_; }

    /// Parts them at about `wanted`: all keys below the returned index are less than the one
    /// there, which is the least from there on. size() if impossible.
    std::size_t cut_near(std::size_t wanted);

private:
    /// Whether no part tells the records of a code apart.
    bool has_one_key(std::uint64_t code) const;
    /// The same a little below, by a histogram of the codes; 0 if that does not tell.
    std::size_t cut_below(std::size_t wanted);

    Arena<Place> places_;
    std::uint64_t least_ = key_word_end, greatest_ = 0; // codes
};

} // namespace abacus
