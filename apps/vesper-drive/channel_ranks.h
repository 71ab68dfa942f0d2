// Channels of one drive on several ranks. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "channel_link.h"
#include "channels.h"
#include "osi/message.h"
#include "ranks.h"
#include "session.h"

namespace vesper::drive {

/// The first rank steps the world and tells the others what happens; each renders its channels and adapts the one eye;
/// all show their pictures at once. Throws Error, also where eyes differ.
class ChannelRanks : public ChannelLink {
public:
    /// Throws Error where ranks and channels do not go together.
    ChannelRanks(apps::Ranks&, const Channels&);

    bool is_first() const { return ranks_.is_first(); }
    bool has(size_t channel) const { return rank_of_[channel] == ranks_.rank(); }

    /// What the first rank asks of a frame.
    struct Wanted {
        bool display = false, scene = false;  ///< of each channel, for a film
        bool row = false;                     ///< of the log
    };
    /// How ranks with channels were ready to show the frame before.
    struct Meeting {
        double skew = 0;  ///< s: by how much longer the first one waited than the last
        int last = 0;     ///< that rank
    };

    // Of the first rank.
    /// From now on the others do what this session does. It must outlive this.
    void lead(Session&);
    /// The next frame that the session renders is one of all.
    void begin_frame(const Wanted&);
    /// After meet(): what was wanted of other ranks. Returns the row of the log, empty where this rank has that
    /// channel.
    std::string collect(ChannelMosaic&);
    /// Lets the others end.
    void end_drive();

    // Of the others.
    /// Does what the first rank's session did, up to a frame; `meanwhile` while there is nothing to do. Nothing: the
    /// drive is over.
    std::optional<Wanted> follow(Session&, const std::function<void()>& meanwhile = {});
    void report(const Wanted&, const ChannelMosaic&, const std::string& row);

    /// Before a frame is shown: waits until all ranks can show theirs.
    Meeting meet(const shared::EyeState&);

    std::vector<std::vector<size_t>> shares(size_t channels) const override;
    std::vector<size_t> own(size_t channels) const override;
    void say(Kind, apps::Bytes) override;
    void say_to_each(Kind, std::vector<apps::Bytes>) override;
    std::vector<apps::Bytes> hear(Kind) override;

private:
    apps::Ranks& ranks_;
    std::vector<int> rank_of_;  // of each channel
    size_t gaze_;
    apps::PacketWriter news_;  // since the last frame
    Wanted wanted_;
    uint64_t frames_ = 0, usual_frames_ = 0;  // of the latter nothing was set before
    bool unusual_ = true;
    Stopwatch frame_watch_;
    double longest_ = 0;                                // of usual frames, s
    double waited_ = 0;                                 // for the others, in the last frame, s
    std::array<std::deque<apps::Bytes>, kKinds> said_;  // by this rank, to itself
};

/// Of a log: names, and values.
constexpr const char* kMeetingColumns = ",skew_us,last_rank";
std::string columns_of(const ChannelRanks::Meeting&);

/// Which rank shows each channel: those of the file; else the ranks but the first, a run of channels each. Throws
/// Error.
std::vector<int> ranks_of(const Channels&, int ranks);

}  // namespace vesper::drive
