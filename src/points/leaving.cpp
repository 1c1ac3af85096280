#include "points/leaving.hpp"

#include <algorithm>

namespace abacus {

namespace {
constexpr std::size_t fewest_wants = 16, most_wants = 1 << 20;
} // namespace

Leaving::Leaving(const Host &host, std::size_t bytes, bool exactly, unsigned attributes)
    : exactly_(exactly), identities_(host, exactly ? attributes : 0),
      most_(
          std::clamp(bytes / (bytes_a_want + identities_.bytes_each()), fewest_wants, most_wants)),
      wants_(host), wanted_(host), candidates_(host) {}

void Leaving::begin() {
    candidates_.clear();
    wanted_.clear();
    front_ = 0;
    for (const std::int64_t id : wants_) wanted_.push_back({id, 1, 0, 0, none, none});
    std::sort(wanted_.begin(), wanted_.end(),
              [](const Wanted &a, const Wanted &b) { return a.id < b.id; });
    std::size_t different = 0;
    for (const Wanted &wanted : wanted_) {
        if (different > 0 && wanted_[different - 1].id == wanted.id)
            ++wanted_[different - 1].times;
        else
            wanted_[different++] = wanted;
    }
    wanted_.resize(different);
    unmet_ = different;
}

Leaving::Wanted *Leaving::find(std::int64_t id) {
    Wanted *wanted = std::lower_bound(wanted_.begin(), wanted_.end(), id,
                                      [](const Wanted &a, std::int64_t b) { return a.id < b; });
    return wanted != wanted_.end() && wanted->id == id ? wanted : nullptr;
}

bool Leaving::offer(std::int64_t id, const double *attributes, std::uint64_t serial) {
    Wanted *wanted = find(identities_.find(id, attributes));
    const bool is_behind = candidates_.size() >= wants_.size();
    if (is_behind && (wanted == nullptr || wanted->behind == wanted->times)) return true;
    const auto number = static_cast<std::uint32_t>(candidates_.size());
    candidates_.push_back({serial, none, false});
    if (wanted != nullptr) {
        if (wanted->first == none)
            wanted->first = number;
        else
            candidates_[wanted->last].next = number;
        wanted->last = number;
        wanted->behind += is_behind;
        unmet_ -= ++wanted->offered == wanted->times;
    }
    return unmet_ > 0; // otherwise every want has found its id
}

std::uint32_t Leaving::choose(Wanted &wanted) {
    while (wanted.first != none && candidates_[wanted.first].leaves)
        wanted.first = candidates_[wanted.first].next;
    if (wanted.first != none || exactly_) return wanted.first;
    while (front_ < candidates_.size() && candidates_[front_].leaves) ++front_;
    return front_ < candidates_.size() ? front_ : none;
}

void Leaving::decide() {
    for (const std::int64_t id : wants_) {
        const std::uint32_t chosen = choose(*find(id));
        if (chosen != none) candidates_[chosen].leaves = true;
    }
}

} // namespace abacus
