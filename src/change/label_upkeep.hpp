// Labels of simplices and markers of facets while the mesh changes: those of simplices that have
// gone go (label_sweep.hpp), or others inherit them (label_heirs.hpp), facets keep theirs
// (marker_sweep.hpp), and all follow the mesh to another domain.
#pragma once

#include "change/workspace.hpp"
#include "mesh/stored_pages.hpp"

namespace abacus {

template <int D> class LabelUpkeep {
public:
    /// `stored` learns from the host which pages are stored; null if simplices have no labels and
    /// facets no markers.
    LabelUpkeep(Workspace<D> &work, StoredPages *stored) : work_(work), stored_(stored) {}

    /// Until settle() labels and markers stay with the simplices of now: all changes until then
    /// count as one.
    void hold() { holds_ = true; }
    void settle() { holds_ = false; }
    /// After a change that has been stored.
    void follow() {
        if (stored_ != nullptr && !holds_) sweep();
    }
    /// Whether no page has been stored yet that labels must follow.
    bool follows_all() { return stored_ == nullptr || stored_->stretches().empty(); }
    /// The pages stored so far have the same simplices as before.
    void keep_all() {
        if (stored_ != nullptr) stored_->clear();
    }
    /// Simplices with labels that have gone.
    std::uint64_t lost() const { return lost_; }
    /// Sorts labels and markers by the keys of the new domain; `from` is the old one.
    void rekey(const Domain<D> &from, std::size_t memory);

private:
    void sweep();
    void sweep_labels();
    void sweep_markers();

    Workspace<D> &work_;
    StoredPages *const stored_;
    bool holds_ = false;
    std::uint64_t lost_ = 0;
};

extern template class LabelUpkeep<2>;
extern template class LabelUpkeep<3>;

} // namespace abacus
