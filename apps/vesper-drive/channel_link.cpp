#include "channel_link.h"

#include <numeric>
#include <utility>

namespace vesper::drive {

std::vector<size_t> ChannelLink::own(size_t channels) const {
    std::vector<size_t> all(channels);
    std::iota(all.begin(), all.end(), size_t{0});
    return all;
}

std::vector<apps::Bytes> ChannelLink::hear(Kind kind) {
    std::deque<apps::Bytes>& said = said_[size_t(kind)];
    std::vector<apps::Bytes> turn;
    turn.push_back(std::move(said.front()));
    said.pop_front();
    return turn;
}

std::vector<apps::Bytes> ChannelTurns::tell(apps::Bytes bytes, bool late) {
    link_.say(kind_, std::move(bytes)), ++unheard_;
    const auto hear = [&] { return --unheard_, link_.hear(kind_); };
    if (!late || first_) {
        while (unheard_ > 1) hear();  // of moments that were to be heard late
        heard_ = hear();
        first_ = false;
        return late ? *heard_ : *std::exchange(heard_, std::nullopt);
    }
    // The turn before: it was the first, or it is the earliest that is unheard.
    return heard_ ? *std::exchange(heard_, std::nullopt) : hear();
}

void ChannelTurns::forget() {
    for (; unheard_ > 0; --unheard_) link_.hear(kind_);
    heard_.reset(), first_ = true;
}

}  // namespace vesper::drive
