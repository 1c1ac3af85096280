// What several pages know about a vertex, brought together; and the answers, taken back to the
// pages.
//
// Two sorts do this, so that no table of vertices is kept: by the names of the vertices, and back
// into the order in which pages named them.
#pragma once

#include "query/scan/vertex_names.hpp"
#include "sort/record_sort.hpp"

#include <optional>

namespace abacus {

/// Words about vertices, grouped by vertex, in the order of their names.
template <int D> class VertexGroups {
public:
    struct Word {
        std::uint64_t place; // of the vertex among all that pages name
        std::uint64_t word;
    };

    VertexGroups(const Host &host, const abacus_facts &facts, std::size_t memory)
        : names_(facts), words_(names_.words()), sort_(host, words_ + 2, words_ + 1, memory),
          group_(host) {}

    void add(const PageView<D> &page, int vertex, std::uint64_t place, std::uint64_t word) {
        std::uint64_t *const record = sort_.add();
        names_.write(page, vertex, record);
        record[words_] = place;
        record[words_ + 1] = word;
    }
    void finish() {
        sort_.finish();
        ahead_ = sort_.next();
    }
    /// The words of the next vertex, in the order of their places; none after the last.
    const Arena<Word> &next() {
        group_.clear();
        if (ahead_ == nullptr) return group_;
        std::array<std::uint64_t, D + 2> name;
        std::copy_n(ahead_, words_, name.begin());
        do {
            group_.push_back({ahead_[words_], ahead_[words_ + 1]});
            ahead_ = sort_.next();
        } while (ahead_ != nullptr && std::equal(ahead_, ahead_ + words_, name.begin()));
        return group_;
    }
    void close() { sort_.close(); }

private:
    const VertexNames<D> names_;
    const std::size_t words_;
    RecordSort sort_;
    Arena<Word> group_;
    const std::uint64_t *ahead_ = nullptr;
};

/// Records (place, ...) for places, read in the order of the places.
class PlacedWords {
public:
    /// Of so many words with the place; those of one place are in the order of all.
    PlacedWords(const Host &host, std::size_t words, std::size_t memory)
        : sort_(host, words, words, memory) {}

    std::uint64_t *add() { return sort_.add(); }
    /// Ends adding, or goes back to the first.
    void rewind() {
        if (is_finished_)
            sort_.rewind();
        else
            sort_.finish();
        is_finished_ = true;
        is_taken_ = false;
        ahead_ = sort_.next();
    }
    /// The next record of a place, null after its last. Places may only grow.
    const std::uint64_t *next(std::uint64_t place) {
        if (is_taken_) ahead_ = sort_.next();
        is_taken_ = false;
        if (ahead_ == nullptr || ahead_[0] != place) return nullptr;
        is_taken_ = true;
        return ahead_;
    }
    void close() { sort_.close(); }

private:
    RecordSort sort_;
    const std::uint64_t *ahead_ = nullptr;
    bool is_finished_ = false;
    bool is_taken_ = false; // the record ahead was returned
};

} // namespace abacus
