// Distributes records over spools by several threads, while the session's thread reads more of
// them.
//
// The session copies records into a block. Any thread finds the parts of the records of a block,
// which takes most of the time. The blocks are dealt out to the parts in the order in which they
// came, by one thread at a time: so the records of a part are in the order of the rows. Only the
// session's thread may write spools. So a full piece of a part goes to an outbox, and the part gets
// an empty one; the session empties the outbox whenever it brings records.
//
// Invariants
//   1. A block belongs to the session until it is counted as brought, then to the thread that has
//      taken it, until it is counted as dealt out.
//   2. Blocks are taken in order, and dealt out in order. The pieces of the parts belong to the
//      thread whose block is the next to be dealt out.
//   3. A thread waits only for a block, its turn or an empty piece. The session waits only for a
//      free block or the end, and empties the outbox meanwhile. So some thread can always go on.
#pragma once

#include "host/crew.hpp"
#include "staging/distributor.hpp"

#include <array>
#include <condition_variable>
#include <mutex>

namespace abacus {

template <int D> class DistributorThreads final : private Crew::Work {
public:
    /// Records have `stride` words, and a piece has `piece` of them.
    DistributorThreads(const Host &host, Distributor<D> &distributor, std::size_t stride,
                       std::size_t piece);
    DistributorThreads(const DistributorThreads &) = delete;
    DistributorThreads &operator=(const DistributorThreads &) = delete;

    /// Starts the threads; false if the system grants none.
    bool begin() { return crew_.begin(threads_, threads_, *this); }
    /// Adds at most a piece of records.
    void add(const std::uint64_t *records, std::size_t n) {
        std::copy_n(records, n * stride_, room(n));
        fill(n);
    }
    /// The same in two steps: room for the records, which fill() adds.
    std::uint64_t *room(std::size_t n);
    void fill(std::size_t n) { filled_ += n; }
    /// After the last record. The distributor may be finished then, as long as this is there.
    void finish();

    /// Bytes that it takes.
    static std::size_t bytes(unsigned threads, std::size_t stride, std::size_t piece) {
        const std::size_t record = stride * sizeof(std::uint64_t);
        return (blocks_for(threads) * block_pieces * (record + sizeof(unsigned)) +
                pieces * record) *
               piece;
    }

private:
    struct Block {
        std::uint64_t *records;
        unsigned *parts;
        std::size_t n;
    };
    struct FullPiece {
        unsigned part;
        std::uint64_t *records;
    };
    static constexpr std::size_t pieces = 8; ///< in the outbox, or empty
    /// Of a block. To hand one over costs some microseconds, most of them for waking up.
    static constexpr std::size_t block_pieces = 8;
    static constexpr unsigned most_threads = 4;

    static std::size_t blocks_for(unsigned threads) {
        return std::min(threads, most_threads) + std::size_t{2};
    }
    void piece(std::size_t, const Host &) override;
    void give_up() noexcept override;
    /// A block that is to be taken, by its number; false at the end.
    bool take(std::uint64_t &number);
    /// Waits until all blocks before this one have been dealt out; false if threads give up.
    bool wait_for_turn(std::uint64_t number);
    bool deal_out(const Block &block);
    /// Puts a full piece into the outbox; false if threads give up.
    bool send(unsigned part);
    void count_dealt();
    /// Brings the block that the session has filled.
    void bring();
    /// Writes what is in the outbox.
    void empty_outbox();
    /// Empties the outbox until is_ready(). Throws what a thread has thrown.
    template <class IsReady> void wait(IsReady is_ready);

    const Host &host_;
    Distributor<D> &distributor_;
    const std::size_t stride_;
    const std::size_t room_; ///< records of a block
    const unsigned threads_;
    Arena<std::uint64_t> memory_; ///< of blocks and pieces
    Arena<unsigned> part_memory_;
    Arena<Block> blocks_; ///< a ring
    Arena<std::uint64_t *> empty_;
    std::array<FullPiece, pieces> outbox_; ///< a ring
    std::mutex lock_;
    std::condition_variable for_blocks_, for_turns_, for_pieces_, for_session_;
    std::size_t filled_ = 0;                            ///< records of the block to be brought
    std::uint64_t brought_ = 0, taken_ = 0, dealt_ = 0; ///< blocks
    std::uint64_t sent_ = 0, written_ = 0;              ///< full pieces
    bool is_over_ = false;                              ///< no more blocks come
    bool gives_up_ = false;
    Crew crew_; ///< the last member: the first to go
};

extern template class DistributorThreads<2>;
extern template class DistributorThreads<3>;

} // namespace abacus
