// Messages of a simulator in the order of their times, and the moments between them. SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "osi/message.h"

namespace vesper::osi {

/// An object at a moment: its pose between two messages, its lamps as the earlier one states them.
struct ObjectNow {
    MovingObject object;     ///< lights: none is Unknown
    double speed = 0;        ///< along its heading, m/s; negative backwards
    double flashes_for = 0;  ///< s since the last change to Flashing of its lamps
};

struct TrafficLightNow {
    TrafficLight light;
    double state_for = 0;  ///< s since its state began
};

struct Moment {
    std::optional<uint64_t> host;
    std::vector<ObjectNow> objects;               ///< in the order of the message
    std::vector<TrafficLightNow> traffic_lights;  ///< by their ids
    Environment environment;
};

/// What holds until it is stated again: host, traffic lights and environment. An object that a message does not have is
/// gone. Lamps of cars, trucks, buses and motorcycles that no message states: low beams are on; tail lamps are on with
/// low or high beams or rear fog lamps; brake lamps are on while a vehicle slows down by more than 0.7 m/s^2 (UN
/// Regulation 13-H) or stands after it moved; reversing lamps are on while it goes backwards. Speeds that no message
/// states follow from the places.
class Timeline {
public:
    /// `keeps`: moments may be asked for in any order. Otherwise messages before the last moment are forgotten.
    explicit Timeline(bool keeps = true) : keeps_(keeps) {}

    enum class Added : uint8_t { Accepted, Repeated, Late, CrowdedOut };
    /// Late: before a message that a moment was made from. CrowdedOut: those that are not needed yet take 256 MiB
    /// (where messages are forgotten).
    Added add(Message);

    /// The moment so many seconds after the first message that was added. Before it nothing is there, and after the
    /// last message everything stays where it is. A recording of the messages that `on_use` tells has the same moments.
    Moment at(double seconds);

    bool empty() const { return messages_.empty(); }
    /// Time of the latest message, s after the first that was added.
    double latest() const { return messages_.empty() ? 0 : seconds_of(messages_.back()); }
    /// Called once for each message that a moment needs, in the order of their times.
    std::function<void(const Message&)> on_use;

private:
    struct Track {
        LightStates stated, shown;
        double time = 0, speed = 0, flashing_since = 0;
        double acceleration = 0;  ///< of the speed's amount, averaged over about 0.25 s
        glm::dvec3 centre{0};
        bool moved = false;
    };
    struct Held {
        TrafficLight light;
        double since = 0;
    };

    double seconds_of(const Message&) const;
    void use(size_t index);
    void pass(const Message&);
    void follow(const MovingObject&, double time, const Track* before, Track& now) const;
    void forget();

    bool keeps_;
    std::deque<Message> messages_;
    std::optional<int64_t> start_;
    uint64_t bytes_ = 0;            ///< of the messages
    size_t passed_ = 0, used_ = 0;  ///< messages behind the moment; those that moments needed
    std::optional<uint64_t> host_;
    std::unordered_map<uint64_t, Track> tracks_;
    std::map<uint64_t, Held> lights_;  ///< at most kMostObjects
    Environment environment_;
};

/// A lamp's share of a period in which it is lit begins with it. `period`: s.
bool is_lit(LampState state, double since, double period);

}  // namespace vesper::osi
