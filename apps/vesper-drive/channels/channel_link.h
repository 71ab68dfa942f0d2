// How processes that show channels of one eye tell each other what they see. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "ranks/packet.h"

namespace vesper::drive {

/// All processes say one thing of a kind in each turn to each, and hear what every one has said to them, in the order
/// of their ranks. This one is alone and hears itself. Throws Error.
class ChannelLink {
public:
    enum class Kind : uint8_t { Nodes, Light, Statistics };
    static constexpr size_t kKinds = 3;

    virtual ~ChannelLink() = default;

    /// The channels that each process renders, ascending.
    virtual std::vector<std::vector<size_t>> shares(size_t channels) const;
    /// Those of this process.
    virtual std::vector<size_t> own(size_t channels) const { return shares(channels).front(); }
    /// The same to all, or what each is told. Does not wait for others.
    virtual void say(Kind kind, apps::Bytes bytes) { said_[size_t(kind)].push_back(std::move(bytes)); }
    virtual void say_to_each(Kind kind, std::vector<apps::Bytes> bytes) { say(kind, std::move(bytes.front())); }
    /// What was said in the earliest turn that was not heard yet; waits for it.
    virtual std::vector<apps::Bytes> hear(Kind kind);

private:
    std::array<std::deque<apps::Bytes>, kKinds> said_;
};

/// Turns of one kind that are heard at once, or a moment late.
class ChannelTurns {
public:
    ChannelTurns(ChannelLink& link, ChannelLink::Kind kind) : link_(link), kind_(kind) {}

    /// Says `bytes` to all, or to each its own. Returns what all have said: now, or, with `late`, a moment ago; there
    /// is no such moment at first.
    std::vector<apps::Bytes> tell(apps::Bytes bytes, bool late);
    std::vector<apps::Bytes> tell_each(std::vector<apps::Bytes> bytes, bool late);
    /// The next moment is the first one again. Every process must call it between the same turns.
    void forget();

private:
    std::vector<apps::Bytes> hear(bool late);

    ChannelLink& link_;
    ChannelLink::Kind kind_;
    std::optional<std::vector<apps::Bytes>> heard_;  // the turn before, where it was heard already
    size_t unheard_ = 0;
    bool first_ = true;
};

}  // namespace vesper::drive
