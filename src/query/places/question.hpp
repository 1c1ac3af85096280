// The question that is put to each of many places, and the answers until they are reported.
#pragma once

#include "query/locate/reader.hpp"
#include "query/values/interpolation.hpp"

namespace abacus {

/// A sequence of answers, as words.
class Tape {
public:
    explicit Tape(const Memory &memory) : words_(memory) {}

    template <class T> void put(const T &value) { put(&value, 1); }
    template <class T> void put(const T *values, std::size_t n) {
        static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 8 == 0);
        if (n == 0) return;
        std::memcpy(words_.extend(n * sizeof(T) / 8), values, n * sizeof(T));
    }
    /// Sets a word that was put before: the number of things that follow.
    void set(std::size_t at, std::uint64_t word) { words_[at] = word; }
    void reserve(std::size_t words) { words_.reserve(words); }
    std::size_t size() const { return words_.size(); }
    void clear() { words_.clear(); }

    class Player {
    public:
        explicit Player(const Tape &tape) : at_(tape.words_.data()) {}

        /// The next n words put, valid as long as the tape.
        template <class T> const T *take(std::size_t n) {
            const auto *values = reinterpret_cast<const T *>(at_);
            at_ += n * sizeof(T) / 8;
            return values;
        }
        template <class T> const T &take() { return *take<T>(1); }

    private:
        const std::uint64_t *at_;
    };

private:
    Arena<std::uint64_t> words_;
};

/// What a thread needs in order to answer.
template <int D> struct Answerer {
    Answerer(const Host &host, const abacus_facts &facts, std::size_t cache_bytes)
        : reader(host, facts, CacheOptions{.budget = cache_bytes}, true), interpolation(host) {}

    Reader<D> reader; // of places in order
    Interpolation<D> interpolation;
};

template <int D> class Question {
public:
    /// The words of an answer, about.
    virtual std::size_t words() const = 0;
    /// Whether it takes hardly longer than reading a page.
    virtual bool is_quick() const { return false; }
    /// Puts the answer at p on the tape. For any thread.
    virtual void answer(Answerer<D> &by, const Point<D> &p, Tape &tape) const = 0;
    /// Reports the next answer. For the session's thread.
    virtual void tell(std::int64_t id, Tape::Player &answers) const = 0;

protected:
    ~Question() = default;
};

} // namespace abacus
