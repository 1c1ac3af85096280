#include "host/desk.hpp"

#include "host/stopwatch.hpp"

#include <cstring>

namespace abacus {

void Desk::open(unsigned threads) {
    const std::lock_guard guard(lock_);
    open_requests_ = 0;
    read_ = written_ = waited_ = 0;
    at_work_ = threads;
    is_rung_ = is_urgent_ = false;
    for (Courier *courier = first_; courier != nullptr; courier = courier->next_)
        courier->begin_anew();
    __atomic_store_n(&closed_, 0, __ATOMIC_RELAXED);
}

void Desk::close() noexcept {
    const std::lock_guard guard(lock_);
    __atomic_store_n(&closed_, 1, __ATOMIC_RELAXED);
    asked_.notify_all();
    for (Courier *courier = first_; courier != nullptr; courier = courier->next_)
        courier->answered_.notify_all();
}

void Desk::leave() noexcept {
    const std::lock_guard guard(lock_);
    --at_work_;
    asked_.notify_all();
}

unsigned Desk::at_work() const {
    const std::lock_guard guard(lock_);
    return at_work_;
}

std::uint64_t Desk::waited() const {
    const std::lock_guard guard(lock_);
    return waited_;
}

void Desk::ring() noexcept {
    const std::lock_guard guard(lock_);
    is_rung_ = true;
    asked_.notify_all();
}

bool Desk::serve(const Host &host, std::chrono::microseconds wait) {
    {
        std::unique_lock guard(lock_);
        if (wait.count() > 0)
            asked_.wait_for(guard, wait, [&] { return is_urgent_ || at_work_ == 0 || is_rung_; });
        is_rung_ = is_urgent_ = false;
        if (open_requests_ == 0 && at_work_ == 0) return false;
    }
    host.poll();
    // In turns, so that no thread waits for all requests of another one.
    for (bool is_idle = false; !is_idle;) {
        is_idle = true;
        for (Courier *courier = first_; courier != nullptr; courier = courier->next_)
            is_idle &= !serve(host, *courier);
    }
    return true;
}

bool Desk::serve(const Host &host, Courier &courier) {
    Courier::Request *request;
    abacus_page page;
    {
        const std::lock_guard guard(lock_);
        if (courier.served_ == courier.asked_) return false;
        request = &courier.requests_[courier.served_ % Courier::most_requests];
        page = request->page;
        page.location = courier.place(page.location);
    }
    host.poll();
    bool found = true;
    switch (request->wish) {
    case Courier::Wish::find:
        found = in_hand_->find(host, request->kind, page.key, page);
        break;
    case Courier::Wish::fetch:
        found = in_hand_->fetch(host, request->kind, page);
        break;
    case Courier::Wish::next: {
        const abacus_key key = page.key;
        found = in_hand_->next(host, request->kind, &key, page);
        break;
    }
    case Courier::Wish::first:
        found = in_hand_->next(host, request->kind, nullptr, page);
        break;
    case Courier::Wish::put:
        page.bytes = request->bytes;
        in_hand_->put(host, request->kind, page);
        break;
    case Courier::Wish::erase:
        in_hand_->erase(host, request->kind, page);
        break;
    }
    const bool is_put = request->wish == Courier::Wish::put;
    ++(is_put ? written_ : read_);
    if (!is_put && request->wish != Courier::Wish::erase) {
        if (found)
            std::memcpy(request->bytes, page.bytes, std::min(page.size, sizeof request->bytes));
        request->page = page;
        request->page.bytes = request->bytes;
        request->answer = found ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
    }
    const std::lock_guard guard(lock_);
    if (is_put) courier.places_[request->ticket] = page.location;
    ++courier.served_;
    --open_requests_;
    if (courier.served_ == courier.awaited_) courier.answered_.notify_one();
    return true;
}

// ---- The thread's side ------------------------------------------------------------------

/// The functions in the thread's table of host functions.
struct Courier::Functions {
    static Courier &self(void *context) { return *static_cast<Courier *>(context); }

    static void *resize(void *context, void *block, std::size_t size) {
        try {
            return self(context).memory_.resize(block, size);
        } catch (const std::bad_alloc &) {
            return nullptr;
        }
    }
    static abacus_host_status poll(void *) { return ABACUS_HOST_FAILED; } // the desk is closed
    static abacus_host_status progress(void *, const abacus_progress *) { return ABACUS_HOST_OK; }
    static abacus_host_status find(void *context, abacus_page_kind kind, abacus_key key,
                                   abacus_page *page) {
        page->key = key;
        page->location = 0; // a location that is not a ticket
        return self(context).look(self(context).begin(Wish::find, kind, *page), *page);
    }
    static abacus_host_status fetch(void *context, abacus_page_kind kind, abacus_page *page) {
        return self(context).look(self(context).begin(Wish::fetch, kind, *page), *page);
    }
    static abacus_host_status next(void *context, abacus_page_kind kind, const abacus_key *key,
                                   abacus_page *page) {
        if (key != nullptr) page->key = *key;
        page->location = 0;
        const Wish wish = key == nullptr ? Wish::first : Wish::next;
        return self(context).look(self(context).begin(wish, kind, *page), *page);
    }
    static abacus_host_status put(void *context, abacus_page_kind kind, abacus_page *page) {
        Request *const request = self(context).begin(Wish::put, kind, *page);
        if (request == nullptr) return ABACUS_HOST_FAILED;
        std::memcpy(request->bytes, page->bytes, page->size);
        try {
            request->ticket = self(context).new_ticket();
        } catch (const std::bad_alloc &) {
            return ABACUS_HOST_FAILED;
        }
        page->location = ticket_bit | request->ticket;
        self(context).ask(false);
        return ABACUS_HOST_OK;
    }
    static abacus_host_status erase(void *context, abacus_page_kind kind, const abacus_page *page) {
        if (self(context).begin(Wish::erase, kind, *page) == nullptr) return ABACUS_HOST_FAILED;
        self(context).ask(false);
        return ABACUS_HOST_OK;
    }
};

Courier::Courier(Desk &desk, const Memory &memory)
    : desk_(desk), next_(desk.first_), memory_(memory), host_(table_), requests_(memory),
      places_(memory) {
    table_.context = this;
    table_.resize = Functions::resize;
    table_.interrupted = &desk.closed_;
    table_.poll = Functions::poll;
    table_.progress = Functions::progress;
    table_.find = Functions::find;
    table_.fetch = Functions::fetch;
    table_.next = Functions::next;
    table_.put = Functions::put;
    table_.erase = Functions::erase;
    host_ = Host(table_);
    requests_.reserve(most_requests); // otherwise an arena would allocate more at once
    requests_.resize(most_requests);
    desk.first_ = this;
}

void Courier::begin_anew() {
    asked_ = served_ = awaited_ = 0;
    places_.clear();
}

void Courier::wait_until_served(std::unique_lock<std::mutex> &guard, std::size_t requests) {
    if (desk_.closed_ != 0 || served_ >= requests) return;
    const Stopwatch watch(desk_.waited_);
    awaited_ = requests;
    answered_.wait(guard, [&] { return desk_.closed_ != 0 || served_ >= requests; });
}

Courier::Request *Courier::begin(Wish wish, abacus_page_kind kind, const abacus_page &page) {
    {
        std::unique_lock guard(desk_.lock_);
        // Once it has to wait, it waits for more than one place.
        if (asked_ - served_ == most_requests) wait_until_served(guard, asked_ - most_requests / 2);
        if (desk_.closed_ != 0) return nullptr;
    }
    Request &request = requests_[asked_ % most_requests];
    request.wish = wish;
    request.kind = kind;
    request.page = page;
    return &request;
}

void Courier::ask(bool waits) {
    const std::lock_guard guard(desk_.lock_);
    ++asked_;
    ++desk_.open_requests_;
    if (waits || asked_ - served_ >= most_requests / 2) {
        desk_.is_urgent_ = true;
        desk_.asked_.notify_one();
    }
}

abacus_host_status Courier::look(Request *request, abacus_page &page) {
    if (request == nullptr) return ABACUS_HOST_FAILED;
    ask(true);
    std::unique_lock guard(desk_.lock_);
    wait_until_served(guard, asked_);
    if (asked_ != served_) return ABACUS_HOST_FAILED;
    page = request->page;
    return request->answer;
}

std::uint64_t Courier::new_ticket() {
    const std::lock_guard guard(desk_.lock_);
    places_.push_back(0);
    return places_.size() - 1;
}

std::uint64_t Courier::place(std::uint64_t location) const {
    return (location & ticket_bit) != 0 ? places_[location & ~ticket_bit] : location;
}

} // namespace abacus
