// Channels of one drive on several ranks. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "channels/channel_link.h"
#include "channels/channels.h"
#include "osi/message.h"
#include "ranks/ranks.h"
#include "record/drive_log.h"
#include "session/session.h"

namespace vesper::drive {

/// The first rank steps the world and tells the others what happens; each renders its channels and adapts the one eye;
/// all show their pictures at once. Throws Error, also where eyes differ.
class ChannelRanks : public ChannelLink {
public:
    /// Throws Error where ranks and channels do not go together.
    ChannelRanks(apps::Ranks&, const Channels&);

    bool is_first() const { return ranks_.is_first(); }
    bool has(size_t channel) const { return rank_of_[channel] == ranks_.rank(); }

    /// How ranks with channels were ready to show the frame before.
    struct Meeting {
        double skew = 0;  ///< s: by how much longer the first one waited than the last
        int last = 0;     ///< that rank
    };

    // Of the first rank.
    /// From now on the others do what this session does. It must outlive this.
    void lead(Session&);
    /// A frame that all ranks can show.
    struct LedFrame {
        ChannelMosaic wall;  ///< with pictures of other ranks where a film wants them
        Meeting meeting;
        std::string row;  ///< of the log
    };
    /// Renders a frame with all ranks. `film`: which pictures of theirs are wanted. `rows`: of the log, if there is
    /// one.
    LedFrame render(Session&, const Channels&, const render::Outputs&, const render::Outputs& film, DriveRows* rows);
    /// Lets the others end.
    void end_drive();

    // Of the others.
    /// What is done with frames beside the first rank's wishes.
    struct Watching {
        std::function<void(const ChannelMosaic&)> show = {};  ///< when all ranks can show theirs
        std::function<void()> meanwhile = {};                 ///< while there is nothing to do
    };
    /// Does what the first rank's session does until the drive is over.
    void follow(Session&, const Channels&, DriveRows&, const Watching&);

    std::vector<std::vector<size_t>> shares(size_t channels) const override;
    std::vector<size_t> own(size_t channels) const override;
    void say(Kind, apps::Bytes) override;
    void say_to_each(Kind, std::vector<apps::Bytes>) override;
    std::vector<apps::Bytes> hear(Kind) override;

private:
    struct Wanted {                           // by the first rank, of a frame
        bool display = false, scene = false;  // of each channel, for a film
        bool row = false;                     // of the log
    };
    void begin_frame(const Wanted&);
    std::optional<Wanted> await_frame(Session&, const std::function<void()>& meanwhile);
    Meeting meet(const shared::EyeState&);
    void report(const Wanted&, const ChannelMosaic&, const std::string& row);
    std::string collect(ChannelMosaic&);

    apps::Ranks& ranks_;
    std::vector<int> rank_of_;  // of each channel
    size_t gaze_;
    apps::PacketWriter news_;  // since the last frame
    Wanted wanted_;
    uint64_t frames_ = 0, usual_frames_ = 0;  // of the latter nothing was set before
    bool unusual_ = true;
    Stopwatch frame_watch_;
    double longest_ = 0;  // of usual frames, s
    double waited_ = 0;   // for the others, in the last frame, s
};

/// Of a log: names, and values.
constexpr const char* kMeetingColumns = ",skew_us,last_rank";
std::string columns_of(const ChannelRanks::Meeting&);

/// Which rank shows each channel: those of the file; else the ranks but the first, a run of channels each. Throws
/// Error.
std::vector<int> ranks_of(const Channels&, int ranks);

}  // namespace vesper::drive
