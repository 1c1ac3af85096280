// Records of a spool, one by one.
#pragma once

#include "host/arena.hpp"
#include "sort/spool.hpp"

namespace abacus {

/// A spool with a piece of it in memory: first written, then read, as often as need be. What is no
/// more than a piece needs no file.
class RecordSpool {
public:
    /// Bytes in memory.
    static constexpr std::size_t piece_bytes = std::size_t{64} << 10;

    RecordSpool(const Host &host, std::size_t stride)
        : host_(host), stride_(stride),
          piece_(std::max<std::size_t>(1, piece_bytes / (8 * stride))), words_(host) {
        words_.reserve(piece_ * stride_);
    }

    /// Room for one more record.
    std::uint64_t *add() {
        if (count_ == piece_) flush();
        return words_.data() + count_++ * stride_;
    }
    /// That so many records take in the file: none if memory has room for them.
    double spool_bytes(double records) const {
        return records > static_cast<double>(piece_) ? records * 8 * static_cast<double>(stride_)
                                                     : 0;
    }
    /// Ends adding, or goes back to the first record.
    void rewind() {
        if (writing_ && spool_.size() > 0 && count_ > 0) flush();
        writing_ = false;
        at_ = 0;
        if (spool_.size() == 0) return;
        spool_.rewind(host_);
        count_ = 0;
    }
    const std::uint64_t *next() {
        if (at_ == count_) {
            if (spool_.size() == 0) return nullptr;
            host_.poll();
            at_ = 0;
            count_ = spool_.read(host_, words_.data(), piece_, stride_);
            if (count_ == 0) return nullptr;
        }
        return words_.data() + at_++ * stride_;
    }
    void close() {
        spool_.close(host_);
        words_.reset();
        count_ = at_ = 0;
    }

private:
    void flush() {
        host_.poll();
        spool_.write(host_, words_.data(), count_, stride_);
        count_ = 0;
    }

    const Host &host_;
    std::size_t stride_, piece_;
    Arena<std::uint64_t> words_;
    Spool spool_;
    std::size_t count_ = 0, at_ = 0;
    bool writing_ = true;
};

} // namespace abacus
