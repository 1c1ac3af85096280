#include "query/places/places.hpp"

#include "points/record.hpp"
#include "query/places/places_threads.hpp"

namespace abacus {

/// Receives the places in order.
template <int D> class Places<D>::Visitor final : public RecordSink {
public:
    Visitor(const Places &places, const Question<D> &question)
        : places_(places), question_(question), tape_(places.host_) {
        const std::uint64_t total = places.stage_.points();
        if (PlacesTogether<D>::is_worth_while(places.host_, places.facts_, places.cache_bytes_,
                                              question, total))
            together_.emplace(places.host_, places.facts_, places.cache_bytes_, question, total);
    }

    void add(const std::uint64_t *record) override {
        if (!together_)
            answer(record);
        else if (together_->gather(record))
            answer_gathered();
    }
    void finish() override {
        if (together_ && together_->held_back() > 0) answer_gathered();
    }
    std::size_t held_back() const override { return together_ ? together_->held_back() : 0; }

    abacus_phase phase() const override { return ABACUS_PHASE_LOCATING; }
    PagesMoved pages_moved() const override {
        return {(answerer_ ? answerer_->reader.pages_read() : 0) +
                    (together_ ? together_->pages_read() : 0),
                0};
    }

private:
    void answer(const std::uint64_t *record) {
        if (!answerer_) answerer_.emplace(places_.host_, places_.facts_, places_.cache_bytes_);
        tape_.clear();
        question_.answer(*answerer_, record_point<D>(record), tape_);
        Tape::Player player(tape_);
        question_.tell(record_id(record), player);
    }
    void answer_gathered() {
        if (together_->answer()) return;
        together_->each_gathered([&](const std::uint64_t *record) { answer(record); });
    }

    const Places &places_;
    const Question<D> &question_;
    Tape tape_;
    std::optional<PlacesTogether<D>> together_;
    std::optional<Answerer<D>> answerer_; // for the session's thread, if it has to answer
};

template <int D> void Places<D>::each(const Question<D> &question) {
    stage_.end(shape_); // a mesh without points has no domain
    Visitor visitor(*this, question);
    stage_.emit(visitor, shape_);
}

template class Places<2>;
template class Places<3>;

} // namespace abacus
