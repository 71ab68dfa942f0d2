// Events of a drive, done one after the other. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "session.h"

namespace vesper {

size_t frames_in(const std::vector<DriveEvent>&);

/// What windows and the headless program drive by when nobody holds the wheel: a recording, or steps made for the purpose. What was
/// given beside a recording (`kept`) wins over what it sets.
class Playback {
public:
    explicit Playback(std::vector<DriveEvent> events, DriveSettings::Values kept = {}) : events_(std::move(events)), kept_(std::move(kept)), frames_(frames_in(events_)) {}

    /// Does the next event; nothing at the end. A Frame is left to the caller.
    const DriveEvent* next(Session&);
    /// Back to the first event, with the settings the session began with.
    void rewind(Session&);
    /// Whether the car went another way than the recording says.
    bool strayed() const { return strayed_; }
    size_t frames() const { return frames_; }

private:
    std::vector<DriveEvent> events_;
    DriveSettings::Values kept_;
    size_t frames_ = 0, next_ = 0;
    bool strayed_ = false;
};

}  // namespace vesper
