// Events of a drive, done one after the other. SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "session/session.h"

namespace vesper::drive {

/// Does what an event says; a Frame is left to the caller.
void perform(Session&, const DriveEvent&);

/// What windows and the headless program drive by when nobody holds the wheel: a recording, or steps made for the
/// purpose. What was given beside a recording (`kept`) wins over what it sets.
class Playback {
public:
    explicit Playback(DriveEvents events, DriveSettings::Values kept = {})
        : events_(std::move(events)), kept_(std::move(kept)), frames_(events_.frames()), next_(events_) {}
    Playback(const Playback&) = delete;
    Playback& operator=(const Playback&) = delete;

    /// Where messages come while one drives: the moment of theirs that the next step shows (Session::step).
    std::function<std::optional<double>()> live_moment;
    /// Does the next event and says of which kind it was; nothing at the end. A Frame is left to the caller.
    std::optional<DriveEvent::Kind> next(Session&);
    /// Back to the first event, with the settings the session began with.
    void rewind(Session&);
    /// Whether the car went another way than the recording says.
    bool strayed() const { return strayed_; }
    size_t frames() const { return frames_; }

private:
    DriveEvents events_;
    DriveSettings::Values kept_;
    size_t frames_;
    DriveEvents::Iterator next_;
    bool strayed_ = false;
};

}  // namespace vesper::drive
