#pragma once

#include "host/arena.hpp"
#include "mesh/simplex.hpp"

namespace abacus {

/// What a search has found out about simplices, by handle. All marks are `none` between
/// searches: a search takes its own away.
class Marks {
public:
    enum Mark : std::uint8_t { none, inside, outside };

    explicit Marks(const Memory &memory) : marks_(memory) {}

    Mark get(Handle h) const { return to_number(h) < marks_.size() ? marks_[h] : none; }
    void set(Handle h, Mark mark) {
        if (to_number(h) >= marks_.size()) {
            const std::size_t known = marks_.size();
            marks_.resize(std::size_t(to_number(h)) + 1);
            std::fill(marks_.begin() + known, marks_.end(), none);
        }
        marks_[h] = mark;
    }

private:
    Arena<Mark, Handle> marks_;
};

} // namespace abacus
