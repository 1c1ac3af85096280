#include "query/check/check_threads.hpp"

namespace abacus {

namespace {

/// From this number of simplices on, a mesh is worth the threads.
constexpr std::uint64_t simplices_worth_sharing = 1 << 16;
/// Batches of pages in memory for each thread: one in work, one waiting.
constexpr std::size_t batches_a_thread = 2;
/// Parts of the curve for each thread, so that no thread waits long for the last one.
constexpr std::size_t parts_a_thread = 4;

} // namespace

template <int D>
bool Check<D>::Together::is_worth_while(const Host &host, const abacus_facts &facts) {
    return host.threads() > 1 &&
           (facts.census.simplices + facts.census.ghosts >= simplices_worth_sharing ||
            host.has_tiny_intervals());
}

template <int D>
Check<D>::Together::Together(Check &check)
    : check_(check), crew_(check.host_),
      feed_(check.host_, check.host_.threads() * batches_a_thread,
            check.host_.has_tiny_intervals() ? 1 : PageFeed::Batch::most) {}

/// The common part of both passes.
template <int D> class Check<D>::Together::Pass : public Crew::Work {
public:
    Pass(Together &together, std::uint64_t pages_before)
        : together_(together), pages_before_(pages_before) {}

    void meanwhile() override {
        const std::uint64_t pages = pages_.load(std::memory_order_relaxed);
        if (pages - reported_ < 64) return;
        reported_ = pages;
        together_.check_.report(pages_before_ + pages, together_.crew_.desk().at_work());
    }
    bool has_fault() const { return has_fault_.load(std::memory_order_relaxed); }
    std::uint64_t pages() const { return pages_.load(std::memory_order_relaxed); }

protected:
    ~Pass() = default;

    Check &check() const { return together_.check_; }
    const PageFeed &feed() const { return together_.feed_; }
    /// Counts pages; returns whether to continue.
    bool looked_at(std::uint64_t pages, const FaultList &faults) {
        pages_.fetch_add(pages, std::memory_order_relaxed);
        if (faults.size() > 0) has_fault_.store(true, std::memory_order_relaxed);
        return !has_fault();
    }

    Together &together_;

private:
    const std::uint64_t pages_before_;
    std::atomic<std::uint64_t> pages_ = 0;
    std::atomic<bool> has_fault_ = false;
    std::uint64_t reported_ = 0;
};

// ---- Pages -----------------------------------------------------------------------------

template <int D> class Check<D>::Together::Pages final : public Pass {
public:
    explicit Pages(Together &together) : Pass(together, 0) {}

    /// Each piece is a thread that takes pages until there are none.
    void piece(std::size_t, const Host &host) override {
        FaultList faults(host, 1);
        PageCheck<D> check(this->check().domain_, faults);
        PageFeed &feed = this->together_.feed_;
        while (PageFeed::Batch *batch = feed.take(host)) {
            look_at(*batch, check, faults);
            const bool goes_on = this->looked_at(batch->size, faults);
            feed.give_back(*batch);
            if (!goes_on) return;
            this->together_.crew_.ring();
        }
        const std::lock_guard guard(lock_);
        counts_ += check.counts();
    }
    void meanwhile() override {
        Pass::meanwhile();
        if (is_busy()) this->together_.feed_.read(this->check().host_);
    }
    bool is_busy() const override { return this->together_.feed_.has_to_read(); }
    const typename PageCheck<D>::Counts &counts() const { return counts_; }

private:
    void look_at(const PageFeed::Batch &batch, PageCheck<D> &check, FaultList &faults) {
        for (std::size_t i = 0; i < batch.size; ++i) {
            const PageFeed::Page &page = batch.pages[i];
            faults.at = page.key;
            if (!check.read(page.bytes, page.size, page_attributes(this->check().facts_.columns)))
                return;
            check.check();
            const Key &behind = i + 1 < batch.size ? batch.pages[i + 1].key : batch.beyond;
            if (!(check.page().upper() == behind))
                faults.add("interval", "The pages leave out or share a part of the curve.");
        }
    }

    std::mutex lock_;
    typename PageCheck<D>::Counts counts_;
};

template <int D> bool Check<D>::Together::check_pages() {
    Pages pass(*this);
    const unsigned threads = check_.host_.threads();
    const bool has_run = crew_.run(threads, threads, pass);
    feed_.end();
    if (!has_run || pass.has_fault()) return false;
    // No thread has checked that the first page begins with the curve.
    if (pass.pages() > 0 && !(feed_.first() == first_key)) return false;
    check_.counts_ = pass.counts();
    check_.pages_ = pass.pages();
    return true;
}

// ---- Topology ----------------------------------------------------------------------------

template <int D> class Check<D>::Together::Topology final : public Pass {
public:
    Topology(Together &together, unsigned threads, std::size_t parts)
        : Pass(together, together.check_.pages_), threads_(threads), parts_(parts),
          links_(together.check_.host_, threads) {}

    void piece(std::size_t number, const Host &host) override {
        Links &links = links_.get(host, this->check(), threads_);
        if (this->has_fault()) return;
        links.faults.run("link", [&] {
            links.check.check(this->feed().border(number, parts_),
                              this->feed().border(number + 1, parts_),
                              [&] { return this->looked_at(1, links.faults); });
        });
        this->looked_at(0, links.faults);
    }
    StarCounts stars() {
        StarCounts stars;
        links_.each([&](const Links &links) { stars += links.check.stars().counts(); });
        return stars;
    }

private:
    /// The links of a thread.
    struct Links {
        Links(const Host &host, const Check &all, unsigned threads)
            : faults(host, 1), check(host, all.facts_, all.cache_bytes_ / threads, faults) {}

        FaultList faults;
        TopologyCheck<D> check;
    };

    const unsigned threads_;
    const std::size_t parts_;
    OfEachThread<Links> links_;
};

template <int D> bool Check<D>::Together::check_topology() {
    const unsigned threads = check_.host_.threads();
    std::size_t parts = feed_.most_parts();
    if (!check_.host_.has_tiny_intervals()) parts = std::min(parts, threads * parts_a_thread);
    Topology pass(*this, threads, parts);
    if (!crew_.run(threads, parts, pass) || pass.has_fault()) return false;
    if (abacus_is_convex(check_.facts_.standing)) check_.check_stars(pass.stars());
    return true;
}

} // namespace abacus
