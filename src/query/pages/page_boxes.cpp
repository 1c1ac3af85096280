#include "query/pages/page_boxes.hpp"

namespace abacus {

template <int D>
PageBoxes<D>::PageBoxes(const Host &host, const abacus_facts &facts, std::size_t bytes,
                        const std::function<void(const PageView<D> &)> &visit)
    : keys_(host), boxes_(host), tree_(host) {
    const std::size_t most =
        std::max<std::size_t>(16, bytes / (sizeof(Key) + BoxTree<D>::bytes_per_box));
    std::size_t pages = 1, in_last = 0; // pages for each box; for the last one
    PageScan<D> scan(host, facts);
    while (scan.advance()) {
        if (in_last == pages || keys_.empty()) {
            if (keys_.size() == most) {
                halve();
                pages *= 2;
            }
            keys_.push_back(scan.key());
            boxes_.push_back(Box<D>());
            in_last = 0;
        }
        ++in_last;
        Box<D> box;
        for (int i = 0; i < D; ++i) {
            box.lower[i] = scan.page().box(i);
            box.upper[i] = scan.page().box(D + i);
        }
        boxes_.back().extend(box);
        if (visit) visit(scan.page());
    }
    for (const Box<D> &box : boxes_) tree_.add(box);
    tree_.finish();
    boxes_.reset();
}

/// Joins each two boxes into one; the last may have fewer pages than the others.
template <int D> void PageBoxes<D>::halve() {
    std::size_t n = 0;
    for (std::size_t i = 0; i < keys_.size(); i += 2, ++n) {
        Box<D> box = boxes_[i];
        if (i + 1 < keys_.size()) box.extend(boxes_[i + 1]);
        keys_[n] = keys_[i];
        boxes_[n] = box;
    }
    keys_.resize(n);
    boxes_.resize(n);
}

template class PageBoxes<2>;
template class PageBoxes<3>;

} // namespace abacus
