// Pages of bytes under keys, by kind. For the session's thread.
#pragma once

#include "host/error.hpp"

namespace abacus {

/// Gets to know of each page that is stored.
class PageWatch {
public:
    virtual void stored(abacus_page_kind kind, const abacus_page &page) = 0;

protected:
    ~PageWatch() = default;
};

/// Takes pages before they are stored.
class PageKeeper {
public:
    /// Keeps a page, and sets its location; or false, and it is to be stored.
    virtual bool keep(abacus_page_kind kind, abacus_page &page) = 0;

protected:
    ~PageKeeper() = default;
};

class Pages {
public:
    explicit Pages(const abacus_host &table, PageWatch *watch = nullptr)
        : table_(&table), watch_(watch) {}
    /// The same pages, unless they are kept.
    Pages(const Pages &pages, PageKeeper &keeper)
        : table_(pages.table_), watch_(pages.watch_), keeper_(&keeper) {}

    /// The page with the greatest key that is not above this one; false when there is none.
    bool find(abacus_page_kind kind, abacus_key key, abacus_page &page) const {
        return host::found(table_->find(table_->context, kind, key, &page));
    }
    /// The page at page.location; false when it is no longer there.
    bool fetch(abacus_page_kind kind, abacus_page &page) const {
        return host::found(table_->fetch(table_->context, kind, &page));
    }
    /// The page with the least key above this one, the first if it is null.
    bool next(abacus_page_kind kind, const abacus_key *key, abacus_page &page) const {
        return host::found(table_->next(table_->context, kind, key, &page));
    }
    /// Stores the page, in place of the version at page.location unless that is 0.
    void put(abacus_page_kind kind, abacus_page &page) const {
        if (keeper_ != nullptr && keeper_->keep(kind, page)) return;
        host::require(table_->put(table_->context, kind, &page));
        if (watch_ != nullptr) watch_->stored(kind, page);
    }
    void erase(abacus_page_kind kind, const abacus_page &page) const {
        host::require(table_->erase(table_->context, kind, &page));
    }

private:
    const abacus_host *table_;
    PageWatch *watch_;
    PageKeeper *keeper_ = nullptr;
};

} // namespace abacus
