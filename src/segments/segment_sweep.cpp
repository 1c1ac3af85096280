#include "segments/segment_sweep.hpp"

#include "geometry/crossing.hpp"

#include <algorithm>

namespace abacus {

namespace {

constexpr std::size_t least_room = 64, least_batch = 1024; // segments

bool is_lower(const auto &a, const auto &b) { return a.low < b.low; }

} // namespace

SegmentSweep::SegmentSweep(const Host &host, std::size_t memory)
    : host_(host), room_(std::max(least_room, memory / 2 / (3 * sizeof(Item)))),
      sorted_(host, words, 1, memory / 2), held_(host), fresh_(host), kept_(host) {}

void SegmentSweep::add(const LineSegment &segment) {
    if (segment.a == segment.b) return; // crosses nothing
    std::uint64_t *const record = sorted_.add();
    record[0] = ordered(std::min(segment.a[0], segment.b[0]));
    write_segment(segment, record + 1);
}

SegmentSweep::Item SegmentSweep::item_of(const LineSegment &segment) {
    const auto [left, right] = std::minmax(segment.a[0], segment.b[0]);
    const auto [low, high] = std::minmax(segment.a[1], segment.b[1]);
    return {left, right, low, high, segment};
}

void SegmentSweep::advance() {
    const std::uint64_t *const record = sorted_.next();
    next_.reset();
    if (record != nullptr) next_ = item_of(read_segment(record + 1));
}

void SegmentSweep::each(const Report &report) {
    sorted_.finish();
    unsigned runs = 0;
    do {
        std::optional<RecordSpool> &left = spools_[runs % 2], &leaving = spools_[(runs + 1) % 2];
        leaving.emplace(host_, 1 + segment_words);
        leaving_ = &*leaving;
        left_ = 0;
        run(left ? &*left : nullptr, report);
        if (left) left->close();
        ++runs;
    } while (left_ > 0);
    leaving_->close();
}

void SegmentSweep::run(RecordSpool *left, const Report &report) {
    sorted_.rewind();
    passed_ = 0;
    held_.clear();
    advance();
    waits_.reset();
    if (left != nullptr) {
        left->rewind();
        read_left(*left);
    }
    while (next_) {
        if (left != nullptr) {
            if (held_.empty() && !waits_) return;
            while (held_.empty() && next_ && passed_ < since_) advance(), ++passed_;
            hold_left(*left);
        }
        take_batch();
        compare_held(report);
        if (left == nullptr) {
            compare_fresh(report);
            hold_fresh();
        } else {
            drop_ended();
        }
    }
}

// ---- What is held ----------------------------------------------------------------------

void SegmentSweep::read_left(RecordSpool &left) {
    const std::uint64_t *const record = left.next();
    waits_.reset();
    if (record == nullptr) return;
    since_ = record[0];
    waits_ = read_segment(record + 1);
}

void SegmentSweep::hold_left(RecordSpool &left) {
    const std::size_t before = held_.size();
    for (; waits_ && since_ <= passed_; read_left(left)) {
        const Item item = item_of(*waits_);
        if (next_ && item.right < next_->left) continue;
        if (held_.size() < room_)
            held_.push_back(item);
        else
            leave(item);
    }
    if (held_.size() > before) std::sort(held_.begin(), held_.end(), is_lower<Item, Item>);
}

void SegmentSweep::leave(const Item &item) {
    std::uint64_t *const record = leaving_->add();
    record[0] = passed_;
    write_segment(item.segment, record + 1);
    ++left_;
}

void SegmentSweep::hold_fresh() {
    kept_.clear();
    const Item *held = held_.begin(), *fresh = fresh_.begin();
    while (next_ && (held != held_.end() || fresh != fresh_.end())) {
        const bool is_held =
            fresh == fresh_.end() || (held != held_.end() && !is_lower(*fresh, *held));
        const Item &item = is_held ? *held++ : *fresh++;
        if (item.right < next_->left) continue;
        if (kept_.size() < room_)
            kept_.push_back(item);
        else
            leave(item);
    }
    held_.swap(kept_);
}

void SegmentSweep::drop_ended() {
    Item *to = held_.begin();
    for (const Item &item : held_)
        if (next_ && item.right >= next_->left) *to++ = item;
    held_.resize(static_cast<std::size_t>(to - held_.begin()));
}

// ---- Pairs -----------------------------------------------------------------------------

void SegmentSweep::take_batch() {
    fresh_.clear();
    const std::size_t most = std::min(room_, std::max(held_.size(), least_batch));
    for (; next_ && fresh_.size() < most && !(waits_ && since_ <= passed_); ++passed_) {
        fresh_.push_back(*next_);
        advance();
    }
    std::sort(fresh_.begin(), fresh_.end(), is_lower<Item, Item>);
}

void SegmentSweep::compare(const Item &a, const Item &b, const Report &report) {
    if (a.left > b.right || b.left > a.right) return;
    const LineSegment &s = a.segment, &t = b.segment;
    if (cross(s.a, s.b, t.a, t.b)) report(s, t);
}

void SegmentSweep::compare_held(const Report &report) const {
    const Item *held = held_.begin(), *fresh = fresh_.begin();
    const auto compare_with = [&](const Item &item, const Item *other, const Item *end) {
        for (; other != end && other->low <= item.high; ++other) compare(item, *other, report);
        host_.poll();
    };
    while (held != held_.end() && fresh != fresh_.end())
        if (is_lower(*held, *fresh))
            compare_with(*held++, fresh, fresh_.end());
        else
            compare_with(*fresh++, held, held_.end());
}

void SegmentSweep::compare_fresh(const Report &report) const {
    for (const Item *item = fresh_.begin(); item != fresh_.end(); ++item) {
        for (const Item *other = item + 1; other != fresh_.end() && other->low <= item->high;
             ++other)
            compare(*item, *other, report);
        host_.poll();
    }
}

void SegmentSweep::close() { sorted_.close(); }

} // namespace abacus
