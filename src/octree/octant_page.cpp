#include "octree/octant_page.hpp"

#include <cstring>
#include <string>

namespace abacus {

void throw_octree_corrupted(const std::string &detail) { throw_corrupted(detail, "octree"); }

namespace {

[[gnu::always_inline]] inline void require(bool condition, const char *detail) {
    if (!condition) [[unlikely]]
        throw_octree_corrupted(detail);
}

constexpr const char *wrong_size = "An octant page's size does not fit its counts.";

} // namespace

template <int D>
void OctantPageView<D>::read(const unsigned char *bytes, std::size_t size, int attributes) {
    require(size >= sizeof head_ + checksum_bytes && size <= ABACUS_PAGE_BYTES,
            "An octant page has an impossible size.");
    std::memcpy(&head_, bytes, sizeof head_);
    require(head_.magic == OctantPageHead::expected_magic, "A page is not an octant page.");
    require(head_.version == OctantPageHead::expected_version,
            "An octant page has another format.");
    require(head_.dimension == D && head_.attributes == attributes && head_.reserved == 0,
            "An octant page belongs to another kind of octree.");
    require(head_.leaves <= page_octants, "An octant page has too many leaves.");
    require(head_.lower < head_.upper && head_.upper <= key_word_end,
            "An octant page has an impossible interval.");
    require(page_is_sealed(bytes, size), "An octant page does not have the checksum of its bytes.");

    const unsigned char *at = bytes + sizeof head_;
    const unsigned char *const end = bytes + size - checksum_bytes;
    bool are_heads = levels_.read_head(at, end);
    for (int a = 0; a < attributes; ++a) are_heads = are_heads && columns_[a].read_head(at, end);
    require(are_heads, "An octant page has no column where one should begin.");
    bool are_there = levels_.read_deltas(at, end, leaves());
    for (int a = 0; a < attributes; ++a)
        are_there = are_there && columns_[a].read_deltas(at, end, leaves());
    require(are_there && at == end, wrong_size);

    std::uint64_t code = head_.first;
    require(head_.lower <= code && code <= head_.upper && (leaves() > 0 || code == head_.upper),
            "An octant page begins outside its interval.");
    for (std::uint32_t i = 0; i < leaves(); ++i) {
        const std::uint64_t level = levels_[i];
        require(level <= finest_level<D>, "A leaf has an impossible level.");
        const Octant<D> leaf{code, static_cast<int>(level)};
        require(leaf.is_aligned() && code < head_.upper && leaf.end() <= domain_cells<D>,
                "A leaf lies where no leaf of its level can be.");
        code = leaf.end();
    }
}

template <int D> bool OctantPageWriter<D>::write_columns(const OctantPageHead &head) {
    const std::size_t n = head.leaves;
    plans_.clear();
    size_ = sizeof head + checksum_bytes;
    for (int column = 0; column <= attributes_; ++column) {
        plans_.push_back({words_.data() + static_cast<std::size_t>(column) * n, n});
        size_ += plans_.back().size();
    }
    if (size_ > ABACUS_PAGE_BYTES || n > page_octants) return false;
    std::memcpy(page_, &head, sizeof head);
    unsigned char *at = page_ + sizeof head;
    for (const ColumnPlan &plan : plans_) at = plan.write_head(at);
    const std::uint64_t *words = words_.data();
    for (const ColumnPlan &plan : plans_) {
        at = plan.write_deltas(words, at);
        words += n;
    }
    seal_page(page_, size_);
    return true;
}

template class OctantPageView<2>;
template class OctantPageView<3>;
template class OctantPageWriter<2>;
template class OctantPageWriter<3>;

} // namespace abacus
