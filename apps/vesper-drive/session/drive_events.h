// What happened in a drive, in the order in which it did. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "traffic/driver.h"

namespace vesper::drive {

struct DriveEvent {
    enum class Kind : uint8_t { Step, Frame, Set, Restart };
    Kind kind = Kind::Step;
    traffic::DriverInput input;  ///< Step
    std::optional<glm::dvec4>
        pose;  ///< Step: X, Z (m), yaw (rad) and speed (m/s) of the driver's car after it, where that is known
    std::optional<double> shown;  ///< Step: the moment of live messages that it shows (Session::step), s
    std::string name, value;      ///< Set
    uint64_t place = 0;           ///< Set: which event of its file it is in
};

/// Events, one after the other, that take little room: a step has 1 byte while the driver holds still, 33 where its
/// pose is known.
class DriveEvents {
public:
    void push_back(const DriveEvent&);
    size_t size() const { return kinds_.size(); }
    size_t frames() const;

    /// Goes through them, and ends with them.
    class Iterator {
    public:
        explicit Iterator(const DriveEvents& events) : events_(&events) { read(); }
        const DriveEvent& operator*() const { return event_; }
        Iterator& operator++();
        bool operator==(std::default_sentinel_t) const { return at_ == events_->size(); }

    private:
        void read();

        const DriveEvents* events_;
        size_t at_ = 0, step_ = 0, input_ = 0,
               set_ = 0;  // the first of each kind that is not behind it; the input that holds
        DriveEvent event_;
    };
    Iterator begin() const { return Iterator(*this); }
    std::default_sentinel_t end() const { return {}; }

private:
    struct Held {
        size_t from;  // the first step
        traffic::DriverInput input;
    };
    struct Change {
        std::string name, value;
        uint64_t place;
    };
    std::vector<DriveEvent::Kind> kinds_;
    size_t steps_ = 0;
    std::vector<Held> inputs_;
    std::deque<glm::dvec4> poses_;  // of steps from the first; not-a-number where none is known. Many, and never moved
    std::deque<double> shown_;      // the same
    std::vector<Change> changes_;
};

}  // namespace vesper::drive
