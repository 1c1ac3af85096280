#include "staging/distributor.hpp"

#include <algorithm>

namespace abacus {

template <int D>
Distributor<D>::Distributor(const Host &host, std::size_t stride, std::size_t piece,
                            const Slice<D> &slice, const Sample<D> &sample, unsigned parts,
                            bool more_rounds)
    : host_(host), stride_(stride), piece_(piece), slice_(slice),
      splitters_(host, slice_, sample, parts, more_rounds), parts_(host), buffers_(host),
      buffer_(host), waiting_(host) {
    parts_.reserve(splitters_.size());
    for (unsigned i = 0; i < splitters_.size(); ++i)
        parts_.push_back({Spool(), splitters_.slice(i), splitters_.round(i)});
    buffers_.resize(parts_.size() * piece_ * stride_);
    waiting_.resize(parts_.size());
    buffer_.reserve(parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i)
        buffer_.push_back(buffers_.data() + i * piece_ * stride_);
    std::fill(waiting_.begin(), waiting_.end(), 0);
}

template <int D> Arena<Part<D>> Distributor<D>::finish() {
    for (unsigned part = 0; part < parts_.size(); ++part)
        if (waiting_[part] > 0) write(part, buffer_[part], waiting_[part]);
    buffers_.reset();
    return std::move(parts_);
}

template class Distributor<2>;
template class Distributor<3>;

} // namespace abacus
