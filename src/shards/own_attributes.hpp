// What a shard has of the attributes of the mesh of all shards, if they are apart, as pages: those
// of the vertices that it owns.
//
// A stretch of the curve is one of the keys of each group. Pages inside are as they are stored; one
// across an end is made again of the rows that belong to the shard. In each group the first page of
// a shard begins where its stretch does.
#pragma once

#include "attributes/attribute_page.hpp"
#include "keys/domain_of.hpp"

#include <optional>

namespace abacus {

template <int D> class OwnAttributes {
public:
    /// Codes from `first` to `last`; none if last < first.
    OwnAttributes(const Host &host, const abacus_facts &facts, std::uint64_t first,
                  std::uint64_t last)
        : host_(host), domain_(domain_of<D>(facts.form)), groups_(facts.columns.attributes),
          first_(first), last_(last), is_over_(true), keys_(host), rows_(host) {}
    OwnAttributes(const OwnAttributes &) = delete;
    OwnAttributes &operator=(const OwnAttributes &) = delete;

    /// Begins with the page that owns the key; only pages of its group follow.
    void seek(const Key &key);
    /// The next page, without a location; false after the last. Valid until the next call.
    bool next(abacus_page &page);
    /// Where the stretch ends in the group.
    const Key &end() const { return end_; }

private:
    bool find(abacus_page &page);
    void cut(abacus_page &page);

    const Host &host_;
    const Domain<D> domain_;
    const AttributeGroups groups_;
    const std::uint64_t first_, last_;
    unsigned group_ = 0;
    Key begin_{}, end_{}; // of the stretch, in the group
    Key at_{};            // where the next page is looked for
    bool is_first_ = false, is_over_;
    AttributePage<D> view_;
    Arena<Key> keys_;
    Arena<std::uint64_t> rows_;
    std::optional<AttributePageWriter> writer_;
};

extern template class OwnAttributes<2>;
extern template class OwnAttributes<3>;

} // namespace abacus
