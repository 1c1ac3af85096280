// One pass of all threads over gathered points: each thread takes one interval after the other, and
// inserts its points, removes them, or fixes its segments.
#pragma once

#include "change/cuts.hpp"
#include "change/interval.hpp"
#include "change/workspace.hpp"
#include "host/crew.hpp"

#include <atomic>
#include <deque>
#include <functional>
#include <optional>

namespace abacus {

template <int D> class Pass final : public Crew::Work {
public:
    struct Task {
        const Batch &batch;
        const Cuts &cuts;
        std::size_t cache_bytes; ///< of each thread
        Deed deed;
        bool counts_crowded;                       ///< see Interval::insert()
        const typename Interval<D>::Removing *how; ///< null unless points are removed
    };

    /// report(done) is called now and then in the session's thread, with how many points are done.
    Pass(Workspace<D> &work, Crew &crew, const Task &task,
         std::function<void(std::uint64_t)> report)
        : work_(work), task_(task), report_(std::move(report)), host_memory_(work.host),
          results_(&host_memory_) {
        for (std::size_t i = 0; i < task.cuts.size(); ++i)
            results_.emplace_back(crew.memory().memory());
        if (work_.changes != nullptr) work_.changes->work_with(crew);
    }
    Pass(const Pass &) = delete;
    Pass &operator=(const Pass &) = delete;
    ~Pass() {
        if (work_.changes != nullptr) work_.changes->drop_handed();
    }

    void piece(std::size_t number, const Host &host) override {
        const Batch &batch = task_.batch;
        std::optional<Interval<D>> interval;
        for (std::size_t run = 0; run < batch.runs(); ++run) {
            const std::size_t begin = task_.cuts.begin(number, batch, run),
                              end = task_.cuts.end(number, batch, run);
            if (begin == end) continue;
            if (!interval)
                interval.emplace(host, *work_.facts, task_.cuts.first(number),
                                 task_.cuts.last(number), task_.cache_bytes, work_.changes);
            deal_with(*interval, begin, end, results_[number]);
        }
        if (interval) interval->finish(results_[number]);
    }
    void meanwhile() override {
        if (work_.changes != nullptr) work_.changes->take_handed();
        report_(done_.load(std::memory_order_relaxed));
    }
    using AllResults = std::pmr::deque<typename Interval<D>::Results>;
    /// Of each interval.
    const AllResults &results() const { return results_; }

private:
    void deal_with(Interval<D> &interval, std::size_t begin, std::size_t end,
                   typename Interval<D>::Results &results) {
        switch (task_.deed) {
        case Deed::insert:
            return interval.insert(task_.batch, begin, end, task_.counts_crowded, done_, results);
        case Deed::remove:
            return interval.remove(task_.batch, begin, end, *task_.how, done_, results);
        case Deed::fix:
            return interval.fix(task_.batch, begin, end, done_, results);
        }
    }

    Workspace<D> &work_;
    const Task task_;
    const std::function<void(std::uint64_t)> report_;
    HostMemory host_memory_;
    AllResults results_;
    std::atomic<std::uint64_t> done_ = 0;
};

} // namespace abacus
