#include "session/scenery.h"
#include "gpu_scene/cameras.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

#include <glm/gtc/matrix_transform.hpp>

#include "base/angle.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "external/lamp_name.h"
#include "io/in_file.h"
#include "print.h"
#include "roads/convert_roads.h"
#include "scene/apply_photometry.h"
#include "scene/colour.h"
#include "scene_notes.h"
#include "session/road_world.h"
#include "traffic/daylight.h"

namespace vesper::drive {
namespace {

using scene::kNone;
namespace fs = std::filesystem;

constexpr double kEyeHeight = 1.2;  // m, of a driver
// In the order of kLampRoles.
constexpr std::array kLit{
    &traffic::VehicleLamps::low,       &traffic::VehicleLamps::high,     &traffic::VehicleLamps::tail,
    &traffic::VehicleLamps::brake,     &traffic::VehicleLamps::left,     &traffic::VehicleLamps::right,
    &traffic::VehicleLamps::front_fog, &traffic::VehicleLamps::rear_fog, &traffic::VehicleLamps::reversing};
static_assert(kLit.size() == traffic::kLampRoles.size());

constexpr double kPhotocell = 50;  // lx under the sky: street lamps go off above (35 to 70 lx are usual)

// Without what a node's scale does.
glm::dmat4 rigid(const glm::dmat4& m) {
    glm::dmat4 r(1);
    const glm::dvec3 back = glm::normalize(glm::dvec3(m[2])),
                     right = glm::normalize(glm::cross(glm::dvec3(m[1]), back));
    r[0] = glm::dvec4(right, 0), r[1] = glm::dvec4(glm::cross(back, right), 0), r[2] = glm::dvec4(back, 0), r[3] = m[3];
    return r;
}

glm::dmat4 pose_of(const traffic::Actor& a) {
    glm::dmat4 m = glm::translate(glm::dmat4(1), a.position);
    m = glm::rotate(m, a.yaw, glm::dvec3(0, 1, 0));
    m = glm::rotate(m, a.pitch, glm::dvec3(1, 0, 0));
    return glm::rotate(m, -a.roll, glm::dvec3(0, 0, 1));  // left side up
}

// A body is made larger or smaller, and its lamps are where they are on it then, as large as they were.
glm::dmat4 placed(const glm::dmat4& pose, const glm::dvec3& scale, glm::dmat4 offset, bool lamp) {
    if (scale == glm::dvec3(1)) return pose * offset;
    const glm::dvec3 by(scale.y, scale.z, scale.x);  // across, up, along
    if (!lamp) return pose * glm::scale(glm::dmat4(1), by) * offset;
    offset[3] = glm::dvec4(by * glm::dvec3(offset[3]), 1);
    return pose * offset;
}

uint32_t first_camera(const scene::Scene& scene) {
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].camera != kNone) return i;
    return kNone;
}

// A scene alone: straight on from where the camera on that node stands, if there is one.
traffic::WorldFile plain_world(const scene::Scene& scene, uint32_t camera) {
    traffic::WorldFile file;
    glm::dvec3 eye(0, kEyeHeight, 0), ahead(0, 0, -1);
    if (camera != kNone) {
        const glm::dmat4 stands = scene::world_transforms(scene, 0)[camera];
        eye = glm::dvec3(stands[3]), ahead = -glm::dvec3(stands[2]);
    }
    ahead.y = 0;
    ahead = glm::length(ahead) > 1e-6 ? glm::normalize(ahead) : glm::dvec3(0, 0, -1);
    const glm::dvec3 ground = eye - glm::dvec3(0, kEyeHeight, 0);
    file.world.lanes.emplace_back("straight on", std::vector{ground, ground + 10000.0 * ahead}, 3.5, 50 / 3.6);
    return file;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

Scenery::Scenery(const fs::path& file, const MessageSource& source) : source_(source) {
    osi::Trace trace = read_messages(source);
    messages_ = std::move(trace.messages), notes_ = std::move(trace.notes);
    if (!source.live) stationary_ = std::move(trace.stationary);  // those that are sent are not known beforehand
    message_frame_ = frame_of(source, glm::dvec3(0));
    if (!source.host.empty() && source.host != "none" && !source.live &&
        std::none_of(messages_.begin(), messages_.end(), [&](const osi::Message& m) {
            return std::any_of(m.objects.begin(), m.objects.end(),
                               [&](const osi::MovingObject& o) { return std::to_string(o.id) == source.host; });
        }))
        notes_.push_back("--host " + source.host + ": no message has that object");
    if (source.file.extension() == ".osi" && source.host.empty() && !source.live &&
        std::none_of(messages_.begin(), messages_.end(), [](const osi::Message& m) { return m.host.has_value(); }))
        notes_.push_back(
            one_line(source.file.string()) +
            ": names no host vehicle: the driver's car is one more (--host ID sits in one of the objects)");
    const Budget budget("reading " + one_line(file.string()));
    const auto note = [&](const std::vector<std::string>& more) {
        notes_.insert(notes_.end(), more.begin(), more.end());
    };
    const auto make_room = [&](traffic::WorldFile& world) {
        lenses_ = lenses_of(scene_);
        if (source.any()) bodies_ = ExternalBodies(scene_, world, source, messages_);
    };
    if (roads::is_opendrive_name(file)) {
        RoadWorld roads = road_world(file, source, messages_);
        note(roads.notes);
        scene_ = std::move(roads.scene), lenses_ = std::move(roads.lenses), bodies_ = std::move(roads.bodies);
        scene_.name = file.string();
        message_frame_ = frame_of(source, roads.origin);
        draw_stationary(roads.things);
        adopt(roads.world);
    } else if (file.extension() == ".json") {
        traffic::WorldFile world = traffic::read_world(file);
        scene::LoadedScene loaded =
            io::in_file(file.string(), [&] { return scene::read_lit_scene(world.scene, world.photometry); });
        note(apps::notes_of(loaded, world.scene.string())), scene_ = std::move(loaded.scene);
        scene_.name = world.scene.string();
        draw_stationary({});
        make_room(world);
        adopt(world);
        const std::string at = one_line(file.string()) + ": ";
        for (const auto& [role, names] : traffic::kLampRoles) require_lamps(world.roles.*names, at + "/lamps/" + role);
        require_lamps(world.by_day, at + "/lit_by_day");
    } else if (scene::is_scene_name(file)) {
        scene::LoadedScene loaded = scene::read_scene(file);
        note(apps::notes_of(loaded, file.string())), scene_ = std::move(loaded.scene);
        scene_.name = file.string();
        const uint32_t camera = first_camera(scene_);
        traffic::WorldFile plain = plain_world(scene_, camera);
        draw_stationary({});
        make_room(plain);
        adopt(plain, camera);
    } else {
        throw Error(one_line(file.string()) + ": a world (.json), roads (.xodr) or a scene (" +
                    scene::scene_endings(", ") + ") is expected");
    }
    note(bodies_.notes());
    read_heights();
}

void Scenery::draw_stationary(std::span<const glm::dvec3> known) {
    if (stationary_.empty()) return;
    StationaryNodes made = add_stationary(scene_, stationary_, message_frame_, known);
    const auto note = [&](const KindCounts& counts, const char* what) {
        if (!counts.empty())
            notes_.push_back(one_line(source_.file.string()) + ": stationary objects and signs " + what + ": " +
                             text_of(counts));
    };
    note(made.shown, "shown as boxes, cylinders, cones and panels");
    note(made.of_roads, "that the roads have already");
    note(made.not_shown, "not shown (over the road, or without a size)");
    standing_ = std::move(made.standing);
}

// None where the scene is too large for it.
std::shared_ptr<const GroundBelow> Scenery::ground_below() const {
    std::vector<uint32_t> moving;
    for (const Rider& rider : riders_) moving.push_back(rider.node);
    try {
        return std::make_shared<const GroundBelow>(scene_, rest_, std::move(moving));
    } catch (const Error&) {
        return nullptr;
    }
}

ExternalPlaces Scenery::external_places() const {
    HeightJudge judge(source_.live && source_.heights == HeightReading::Ground);
    if (source_.live && source_.heights == HeightReading::Auto) judge = HeightJudge(ground_below());
    return {bodies_, lenses_, message_frame_, source_.host, std::move(judge)};
}

void Scenery::read_heights() {
    if (!source_.any() || source_.live || source_.file.extension() == ".csv") return;
    bool at_ground = source_.heights == HeightReading::Ground;
    if (source_.heights == HeightReading::Auto) {
        const auto below = ground_below();
        const HeightVotes votes = below ? votes_of(messages_, message_frame_, *below) : HeightVotes();
        at_ground = are_at_ground(votes);
        if (votes.ground > 0)
            notes_.push_back(one_line(source_.file.string()) +
                             apps::format(": base.position of %.0f %% of the objects lies on the ground, and not half "
                                          "their height above it: taken as the %s of all boxes (--osi-z)",
                                          100 * double(votes.ground) / double(votes.all()),
                                          at_ground ? "ground" : "middle"));
    }
    if (!at_ground) return;
    for (osi::Message& message : messages_)
        for (osi::MovingObject& object : message.objects) raise(object);
    for (const auto& [node, half] : standing_) {
        scene_.nodes[node].translation += half * glm::dvec3(glm::normalize(rest_[node][1]));
        rest_[node][3] = glm::dvec4(scene_.nodes[node].translation, 1);
    }
}

void Scenery::adopt(traffic::WorldFile& file, uint32_t eye) {
    scene_.channels.clear();
    rest_ = scene::world_transforms(scene_, 0);
    night_ = {scene_.ambient_illuminance * scene_.ambient_colour, scene_.sky_luminance * scene_.sky_colour};
    camera_ = file.camera;
    if (!camera_.empty() && !contains(gpu_scene::camera_names(scene_), camera_))
        throw Error(one_line(scene_.name) + ": there is no camera " + one_line(camera_) + " for the driver");
    tunnels_ = file.tunnels;
    world_ = std::make_shared<const traffic::WorldDescription>(std::move(file.world));

    // Each node rides on the nearest actor above it.
    std::map<std::string, uint32_t> actors;
    const std::vector<traffic::Actor> start = traffic::World(world_, 0).actors();
    for (uint32_t i = 0; i < start.size(); ++i)
        if (!start[i].node.empty() && !actors.try_emplace(start[i].node, i).second)
            throw Error("node " + one_line(start[i].node) + " is to move in two ways");
    std::vector<uint32_t> root(scene_.nodes.size(), kNone);
    std::set<uint32_t> found;
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i) {
        const uint32_t parent = scene_.nodes[i].parent;
        if (parent != kNone) root[i] = root[parent];
        const auto actor = actors.find(scene_.nodes[i].name);
        if (root[i] == kNone && (actor != actors.end() || i == eye)) root[i] = i;
        if (root[i] == kNone) continue;
        if (root[i] == eye) {
            traffic::Actor below = start.front();  // of the eye, not quite where the car begins
            below.position = glm::dvec3(rest_[eye][3]) - glm::dvec3(0, kEyeHeight, 0);
            riders_.push_back({i, 0, glm::inverse(pose_of(below)) * rest_[i]});
            continue;
        }
        const std::string& name = scene_.nodes[root[i]].name;
        const uint32_t who = actors.at(name);
        found.insert(who);
        const auto turn = file.turns.find(name);
        const glm::dmat4 turned =
            glm::rotate(glm::dmat4(1), turn == file.turns.end() ? 0 : turn->second, glm::dvec3(0, 1, 0));
        riders_.push_back({i, who, turned * glm::inverse(rigid(rest_[root[i]])) * rest_[i]});
    }
    for (const auto& [name, index] : actors)
        if (!found.contains(index))
            throw Error(one_line(scene_.name) + ": there is no node " + one_line(name) + " to move");
    find_lamps(file.roles, file.by_day);
}

void Scenery::find_lamps(const traffic::LampRoles& roles, const std::vector<std::string>& by_day) {
    std::vector<uint32_t> rider(scene_.nodes.size(), kNone);
    for (const Rider& r : riders_) rider[r.node] = r.actor;
    std::vector<uint32_t> lens(scene_.nodes.size(), kNone);
    for (uint32_t i = 0; i < lenses_.size(); ++i) lens[lenses_[i].node] = i;
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i) {
        if (scene_.nodes[i].lamp == kNone) continue;
        SwitchedLamp lamp{i, rider[i], kFixed, true, lens[i], lamp_name(scene_, i)};
        if (lamp.actor != kNone)
            for (size_t r = 0; r < traffic::kLampRoles.size(); ++r)
                if (contains(roles.*traffic::kLampRoles[r].second, lamp.name)) lamp.role = r;
        if (lamp.role == kFixed) lamp.by_day = by_day.empty() || contains(by_day, lamp.name);
        lamps_.push_back(std::move(lamp));
    }
}

std::vector<LampGroup> Scenery::lamp_groups() const {
    std::map<std::string, LampGroup> groups;
    for (const SwitchedLamp& switched : lamps_) {
        const scene::Lamp& lamp = scene_.lamps[scene_.nodes[switched.node].lamp];
        if (lamp.kind == scene::Lamp::Kind::Directional) continue;  // has no intensity
        const double largest = lamp.kind == scene::Lamp::Kind::Measured
                                   ? photometry::largest_intensity(scene_.distributions[lamp.distribution])
                                   : 1;
        LampGroup& group = groups[switched.name];
        group.name = switched.name;
        ++group.lamps, group.candela = std::max(group.candela, double(lamp.intensity) * largest);
    }
    std::vector<LampGroup> sorted;
    for (auto& [name, group] : groups)
        if (group.candela > 0) sorted.push_back(std::move(group));
    return sorted;
}

const DriveSettings& Scenery::check(const DriveSettings& settings) const {
    for (const auto& dimmed : settings.lamps()) require_lamp(dimmed.first, "--lamp " + one_line(dimmed.first));
    return settings;
}

void Scenery::require_lamps(const std::vector<std::string>& names, const std::string& place) const {
    for (size_t i = 0; i < names.size(); ++i) require_lamp(names[i], place + "/" + std::to_string(i));
}

void Scenery::require_lamp(const std::string& name, const std::string& place) const {
    if (std::any_of(lamps_.begin(), lamps_.end(), [&](const SwitchedLamp& lamp) { return lamp.name == name; })) return;
    std::string names;
    for (const LampGroup& group : lamp_groups()) names += (names.empty() ? "" : ", ") + group.name;
    throw Error(place + ": the scene has no lamp of that name; it has " +
                (names.empty() ? "none" : one_line(names, 1000)));
}

bool Scenery::shines(const SwitchedLamp& lamp, const std::vector<traffic::Actor>& actors, bool bright) const {
    if (lamp.role == kFixed) return lamp.by_day || !bright;
    return actors[lamp.actor].lamps.*kLit[lamp.role];
}

gpu_scene::SceneFrame Scenery::frame(const std::vector<traffic::Actor>& actors, const DriveSettings& settings,
                                     const ExternalState& external) const {
    gpu_scene::SceneFrame made{
        .world = rest_, .dimming = std::vector<float>(scene_.nodes.size(), 1), .ambient = night_};
    std::vector<glm::dmat4> poses;
    for (const traffic::Actor& actor : actors) poses.push_back(pose_of(actor));
    made.moving.assign(scene_.nodes.size(), false);
    for (const Rider& r : riders_) {
        made.world[r.node] =
            placed(poses[r.actor], actors[r.actor].scale, r.offset, scene_.nodes[r.node].lamp != kNone);
        made.moving[r.node] = true;
    }

    double daylight = 0;
    if (const auto sun = settings.sun() ? settings.sun() : external.sun_elevation) {
        daylight = traffic::kOvercast * traffic::daylight_illuminance(*sun);
        const glm::vec3 light =
            float(daylight) * glm::vec3(scene::colour_of_temperature(traffic::daylight_temperature(*sun)));
        made.ambient->illuminance += light;
        made.ambient->sky += light / std::numbers::pi_v<float>;
        made.tunnels = tunnels_;
    }
    for (const SwitchedLamp& lamp : lamps_) {
        const auto factor = settings.lamps().find(lamp.name);
        const double wanted = factor == settings.lamps().end() ? 1 : factor->second;
        const bool on = shines(lamp, actors, daylight > kPhotocell) &&
                        (lamp.lens == kNone || (external.lenses.empty() ? lenses_[lamp.lens].shines(external.seconds)
                                                                        : external.lenses[lamp.lens]));
        made.dimming[lamp.node] = on ? float(wanted) : 0;
    }
    return made;
}

gpu_scene::View Scenery::view(const gpu_scene::SceneFrame& frame, const std::vector<traffic::Actor>& actors,
                              const DriveSettings& settings, VkExtent2D extent) const {
    constexpr double kFov = 40 * kRadiansPerDegree;
    const double asked = settings.vertical_fov() * std::numbers::pi / 180, fov = asked > 0 ? asked : kFov;
    const traffic::Actor& me = actors.front();
    const glm::dvec3 ahead(-std::sin(me.yaw), 0, -std::cos(me.yaw)), up(0, 1, 0);
    const auto look = [&](glm::dvec3 eye, glm::dvec3 at) {
        return gpu_scene::View::symmetric(extent, float(fov), glm::mat4(glm::lookAt(eye, at, up)));
    };
    switch (settings.camera()) {
        case CameraKind::Chase:
            return look(me.position - 8.0 * ahead + 2.8 * up, me.position + 6.0 * ahead + 1.0 * up);
        case CameraKind::Bird:
            return look(me.position - 18.0 * ahead + 40.0 * up, me.position + 12.0 * ahead);
        case CameraKind::Free: {
            const FreeCamera& c = settings.free_camera();
            const glm::dmat4 m = glm::rotate(glm::rotate(glm::translate(glm::dmat4(1), c.position), c.yaw, up), c.pitch,
                                             glm::dvec3(1, 0, 0));
            return gpu_scene::View::symmetric(extent, float(fov), glm::mat4(glm::inverse(m)));
        }
        case CameraKind::Driver:
            break;
    }
    if (camera_.empty()) {
        const glm::dmat4 eye = glm::translate(pose_of(me), glm::dvec3(0, kEyeHeight, 0));
        return gpu_scene::View::symmetric(extent, float(fov), glm::mat4(glm::inverse(eye)));
    }
    gpu_scene::View view = gpu_scene::camera_view(scene_, frame, camera_, extent);
    if (asked > 0) view = gpu_scene::View::symmetric(extent, float(asked), view.world_to_view, view.near);
    return view;
}

}  // namespace vesper::drive
