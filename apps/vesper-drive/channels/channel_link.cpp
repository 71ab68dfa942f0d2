#include "channels/channel_link.h"

#include <numeric>
#include <utility>

namespace vesper::drive {

std::vector<std::vector<size_t>> ChannelLink::shares(size_t channels) const {
    std::vector<size_t> all(channels);
    std::iota(all.begin(), all.end(), size_t{0});
    return {all};
}

std::vector<apps::Bytes> ChannelLink::hear(Kind kind) {
    std::deque<apps::Bytes>& said = said_[size_t(kind)];
    std::vector<apps::Bytes> turn;
    turn.push_back(std::move(said.front()));
    said.pop_front();
    return turn;
}

std::vector<apps::Bytes> ChannelTurns::tell(apps::Bytes bytes, bool late) {
    link_.say(kind_, std::move(bytes));
    return hear(late);
}

std::vector<apps::Bytes> ChannelTurns::tell_each(std::vector<apps::Bytes> bytes, bool late) {
    link_.say_to_each(kind_, std::move(bytes));
    return hear(late);
}

std::vector<apps::Bytes> ChannelTurns::hear(bool late) {
    ++unheard_;
    const auto next = [&] { return --unheard_, link_.hear(kind_); };
    if (!late || first_) {
        while (unheard_ > 1) next();  // of moments that were to be heard late
        heard_ = next();
        first_ = false;
        return late ? *heard_ : *std::exchange(heard_, std::nullopt);
    }
    // The turn before: it was the first, or it is the earliest that is unheard.
    return heard_ ? *std::exchange(heard_, std::nullopt) : next();
}

void ChannelTurns::forget() {
    for (; unheard_ > 0; --unheard_) link_.hear(kind_);
    heard_.reset(), first_ = true;
}

}  // namespace vesper::drive
