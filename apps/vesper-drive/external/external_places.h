// The objects of a moment on the bodies that there are. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "external/external_bodies.h"
#include "external/height_reading.h"
#include "external/message_frame.h"
#include "external/signal_lens.h"
#include "traffic/world.h"

namespace vesper::drive {

/// What another program says of a moment, in the world.
struct ExternalState {
    std::vector<traffic::ExternalActor> actors;
    std::optional<traffic::Actor> driver;    ///< where it has the driver's car
    std::vector<osi::MovingObject> objects;  ///< of the actors and the host, in the frame of messages
    std::optional<uint64_t> host;            ///< which of them the driver's car is
    std::vector<bool> lenses;                ///< which shine, in the order of the scene's; empty: nobody says
    double seconds = 0;                      ///< of the drive: the time of the plan of traffic lights
    std::optional<double> sun_elevation;     ///< degrees
    size_t without_body = 0;                 ///< objects for which no body was left
};

/// Gives each object a body for as long as it is there.
class ExternalPlaces {
public:
    /// `host`: of MessageSource. Bodies and lenses stay with the caller.
    ExternalPlaces(const ExternalBodies&, const std::vector<SignalLens>&, const MessageFrame&, std::string host,
                   HeightJudge = HeightJudge());

    ExternalState place(const osi::Moment&);
    /// Whether the latest moment had its objects' places at the ground.
    bool at_ground() const { return judge_.at_ground(); }

private:
    struct Taken {
        size_t body;
        osi::MovingObject::Kind kind;  // of the object that has it
        std::string model;
    };
    void give_back(const Taken&);
    std::optional<size_t> body_of(const osi::MovingObject&);

    const ExternalBodies* bodies_;
    const std::vector<SignalLens>* lenses_;
    MessageFrame frame_;
    std::string host_;
    HeightJudge judge_;
    std::unordered_map<std::string, std::set<size_t>> free_;  // by kind
    std::unordered_map<uint64_t, Taken> taken_;               // by the object's id
    LensFinder finder_;
};

/// Elevation of the sun, degrees: as stated; else at that time of day at an equinox at 45 degrees of latitude; else
/// with which an overcast sky gives the illuminance in the middle of the stated level (OSI, AmbientIllumination).
std::optional<double> sun_elevation_of(const osi::Environment&);

/// An actor's lamps as an object's states, and back. `for_seconds`: since they flash.
osi::LightStates light_states_of(const traffic::VehicleLamps&);
traffic::VehicleLamps lamps_of(const osi::LightStates&, double for_seconds);

}  // namespace vesper::drive
