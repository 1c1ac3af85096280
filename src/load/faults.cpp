#include "load/faults.hpp"

#include <algorithm>

namespace abacus {

namespace {

bool is_in(const std::vector<std::string> &texts, const std::string &text) {
    return std::find(texts.begin(), texts.end(), text) != texts.end();
}

} // namespace

bool Faults::has(const std::string &message) const { return is_in(messages_, message); }

void Faults::add(const std::string &message, const std::string &detail, const std::string &hint) {
    if (!is_full() && has(message)) return;
    if (messages_.empty()) first_detail_ = detail;
    ++count_;
    if (!is_full()) messages_.push_back(message);
    if (!is_in(hints_, hint)) hints_.push_back(hint);
}

std::string Faults::list() const {
    const std::string listed = std::to_string(messages_.size());
    std::string text = first_detail_.empty() ? "" : first_detail_ + "\n";
    if (!is_whole_)
        text += "The first " + listed + " faults, after which no others were looked for:";
    else if (count_ > messages_.size())
        text += "The first " + listed + " of " + std::to_string(count_) + " faults:";
    else
        text += "All " + listed + " faults found in this step:";
    for (const std::string &message : messages_) text += "\n" + message;
    return text;
}

void Faults::raise() const {
    if (messages_.empty()) return;
    std::string hint;
    for (const std::string &text : hints_) hint += (hint.empty() ? "" : " ") + text;
    throw Error(ABACUS_ERROR_ARGUMENT, messages_.front(), count_ == 1 ? first_detail_ : list(),
                hint);
}

} // namespace abacus
