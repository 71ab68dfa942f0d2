#include "external/world_message.h"

#include <cmath>
#include <numbers>
#include <set>

namespace vesper::drive {
namespace {

using Kind = osi::MovingObject::Kind;

osi::MovingObject object_of(const traffic::Actor& actor, uint64_t id, Kind kind, double length, double width,
                            const MessageFrame& frame) {
    const double yaw = actor.yaw + std::numbers::pi / 2 - frame.yaw, pitch = -actor.pitch;
    const glm::dmat3 axes = osi::axes_of(yaw, pitch, actor.roll);
    const glm::dvec3 size(length, width, osi::usual_size(kind).z);
    osi::MovingObject o{.id = id,
                        .kind = kind,
                        .model = actor.node,
                        .size = size,
                        .centre = frame.back(actor.position) + size.z / 2 * axes[2],
                        .yaw = yaw,
                        .pitch = pitch,
                        .roll = actor.roll,
                        .velocity = actor.speed * axes[0],
                        .lights = light_states_of(actor.lamps)};
    return o;
}

}  // namespace

osi::Message message_of(const traffic::World& world, const ExternalState& external, const MessageFrame& frame) {
    const traffic::WorldDescription& d = world.description();
    const std::vector<traffic::Actor> actors = world.actors();
    osi::Message message{.host = external.host, .objects = external.objects};
    std::set<uint64_t> taken;
    for (const osi::MovingObject& object : external.objects) taken.insert(object.id);
    uint64_t id = 0;
    const auto add = [&](size_t i, Kind kind, double length, double width) {
        do ++id;
        while (taken.contains(id));
        message.objects.push_back(object_of(actors[i], id, kind, length, width, frame));
    };
    if (!external.host) {
        add(0, Kind::Car, d.vehicle.length, d.vehicle.width);
        message.host = id;
    }
    for (size_t i = 0; i < d.cars.size(); ++i) add(1 + i, Kind::Car, d.cars[i].length, d.cars[i].width);
    const glm::dvec3 person = osi::usual_size(Kind::Pedestrian);
    for (size_t i = 0; i < d.walkers.size(); ++i) add(1 + d.cars.size() + i, Kind::Pedestrian, person.x, person.y);
    return message;
}

}  // namespace vesper::drive
