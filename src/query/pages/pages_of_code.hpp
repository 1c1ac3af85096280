// The pages of one code that may have a simplex with given ids.
//
// As a rule the simplices of a code lie in one page. Where points crowd far below the resolution
// of the domain, or around a hub, they fill many pages, and ids do not show where a simplex lies.
// But they show where it does not lie: a page has all corners of its simplices among its vertices.
// So the ids of each page's vertices are kept as bits, one of a few thousand for each id. A simplex
// is searched for where the bits of all its corners are set, which is hardly ever the case
// elsewhere.
//
// A reader lives as long as one state of the mesh, so what is known about pages stays valid. It is
// kept for the last code requested, in bounded memory: pages beyond that are read each time.
#pragma once

#include "host/arena.hpp"
#include "host/host.hpp"
#include "mesh/page_format.hpp"

#include <abacus/facts.h>

namespace abacus {

template <int D> class PagesOfCode {
public:
    PagesOfCode(const Host &host, int attributes, std::size_t bytes)
        : host_(host), attributes_(attributes), most_(bytes / sizeof(Known)), known_(host) {}

    /// Calls visit(key) with the keys of the pages, and of some that have no such simplex.
    template <class Visit> void with_ids(std::uint64_t code, const std::int64_t *ids, Visit visit) {
        if (code != code_) forget(code);
        for (const Known &page : known_)
            if (page.may_have(ids)) visit(page.lower);
        for (Key key = rest_; key.code == code;) {
            const Known page = read(key);
            key = page.lower <= Key{code, 0} ? none : predecessor(page.lower);
            if (known_.size() < most_) {
                known_.push_back(page);
                rest_ = key;
            }
            if (page.may_have(ids)) visit(page.lower);
        }
    }

private:
    struct Known {
        static constexpr int bits_log = 11;
        Key lower;
        std::uint64_t bits[(1 << bits_log) / 64];

        static std::uint64_t bit_of(std::int64_t id) {
            return static_cast<std::uint64_t>(id) * 0x9e3779b97f4a7c15 >> (64 - bits_log);
        }
        void add(std::int64_t id) {
            const std::uint64_t bit = bit_of(id);
            bits[bit / 64] |= std::uint64_t{1} << bit % 64;
        }
        bool may_have(const std::int64_t *ids) const {
            for (int i = 0; i <= D; ++i) {
                const std::uint64_t bit = bit_of(ids[i]);
                if ((bits[bit / 64] >> bit % 64 & 1) == 0) return false;
            }
            return true;
        }
    };
    static constexpr Key none{unknown_code, 0};

    void forget(std::uint64_t code) {
        code_ = code;
        known_.clear();
        rest_ = {code, key_word_end - 1}; // from the last one back
    }
    /// The page that owns the key.
    Known read(const Key &key) {
        host_.poll();
        abacus_page page{};
        if (!host_.find(ABACUS_SIMPLEX_PAGES, key, page)) throw_corrupted(unowned);
        view_.open(page.bytes, page.size, attributes_, PageView<D>::Checksum::ignore);
        if (!(view_.lower() <= key && key < view_.upper())) throw_corrupted(unowned);
        Known known{view_.lower(), {}};
        for (int vertex = 0; vertex < view_.vertices(); ++vertex) known.add(view_.id(vertex));
        return known;
    }
    static constexpr const char *unowned = "No page owns a part of the curve.";

    const Host &host_;
    const int attributes_;
    const std::size_t most_;
    std::uint64_t code_ = unknown_code;
    Key rest_ = none;    // where the unknown pages begin
    Arena<Known> known_; // from the last page of the code back
    PageView<D> view_;
};

} // namespace abacus
