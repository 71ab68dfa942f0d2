// Reading a run: the table, the entities of its scenario, lamps that follow from how it goes.
// SPDX-License-Identifier: MIT
#include "roads/esmini_run.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "base/error.h"
#include "base/one_line.h"
#include "roads/esmini_parts.h"

namespace vesper::roads {
namespace {

constexpr double kBrakeLampDeceleration =
    0.7;  // m/s^2, UN Regulation 13-H: brake lamps of regenerative braking may come on from 0.7
constexpr double kStanding = 0.05;  // m/s
constexpr double kSpan = 0.25;      // s over which a change of speed is looked at

RunEntity::Kind kind_of(const XmlElement& element, const Parameters& scope) {
    using Kind = RunEntity::Kind;
    if (element.name() == "Pedestrian")
        return resolved(element, "pedestrianCategory", scope).value_or("") == "animal" ? Kind::Animal
                                                                                       : Kind::Pedestrian;
    if (element.name() != "Vehicle") return Kind::Object;
    const std::string category = resolved(element, "vehicleCategory", scope).value_or("car");
    if (category == "truck" || category == "semitrailer") return Kind::Truck;
    if (category == "trailer") return Kind::Trailer;
    if (category == "bus" || category == "tram" || category == "train") return Kind::Bus;
    if (category == "motorbike") return Kind::Motorcycle;
    if (category == "bicycle") return Kind::Bicycle;
    return Kind::Car;
}

void describe(RunEntity& entity, const XmlElement& element, const Parameters& scope) {
    entity.kind = kind_of(element, scope);
    if (const auto performance = element.child("Performance")) {
        entity.acceleration = std::max(0.0, number_in(*performance, "maxAcceleration", scope, 0));
        entity.deceleration = std::max(0.0, number_in(*performance, "maxDeceleration", scope, 0));
    }
    const auto box = element.child("BoundingBox");
    if (!box) return;
    if (const auto centre = box->child("Center"))
        entity.centre = {number_in(*centre, "x", scope, 0), number_in(*centre, "y", scope, 0),
                         number_in(*centre, "z", scope, 0)};
    if (const auto size = box->child("Dimensions")) {
        entity.length = std::max(0.0, number_in(*size, "length", scope, 0));
        entity.width = std::max(0.0, number_in(*size, "width", scope, 0)),
        entity.height = std::max(0.0, number_in(*size, "height", scope, 0));
    }
}

void describe_entities(ScenarioFile& scenario, EsminiRun& run) {
    for (const XmlElement& each : scenario.root().children_of("Entities", "ScenarioObject")) {
        const auto name = resolved(each, "name", scenario.parameters());
        const auto entity = std::find_if(run.entities.begin(), run.entities.end(),
                                         [&](const RunEntity& e) { return name && e.name == *name; });
        if (entity == run.entities.end()) {
            run.notes.push_back(each.place() + ": '" + name.value_or("") + "' is not in the table");
            continue;
        }
        if (const auto reference = each.child("CatalogReference")) {
            const auto entry = scenario.find(*reference, scenario.parameters());
            if (entry)
                describe(*entity, entry->element, declared(entry->element, entry->parameters));
            else
                run.notes.push_back(reference->place() + ": no catalog has '" +
                                    resolved(*reference, "entryName", scenario.parameters()).value_or("") + "'");
        }
        for (const char* kind : {"Vehicle", "Pedestrian", "MiscObject"})
            if (const auto inside = each.child(kind))
                describe(*entity, *inside, declared(*inside, scenario.parameters()));
    }
}

bool has_lamps(const RunEntity& entity) {
    using Kind = RunEntity::Kind;
    return entity.kind == Kind::Car || entity.kind == Kind::Truck || entity.kind == Kind::Bus ||
           entity.kind == Kind::Motorcycle;
}

/// Lamps nobody sets, from how the vehicle moves.
void derive(RunEntity& entity, RunLamp lamp, const auto& is_on) {
    if (entity.stated[static_cast<size_t>(lamp)]) return;
    std::vector<LampEvent>& events = entity.lamps[static_cast<size_t>(lamp)];
    bool was = false;
    for (const RunPose& pose : entity.poses)
        if (const bool on = is_on(pose); on != was) {
            events.push_back({.time = pose.time, .mode = on ? LampEvent::Mode::On : LampEvent::Mode::Off});
            was = on;
        }
}

void derive_lamps(RunEntity& entity) {
    if (!has_lamps(entity)) return;
    derive(entity, RunLamp::LowBeam, [](const RunPose&) { return true; });
    derive(entity, RunLamp::Reversing, [](const RunPose& pose) { return pose.speed < -kStanding; });
    // Standing counts only after having moved: parked cars show no brake lamps.
    bool moved = false;
    derive(entity, RunLamp::Brake, [&](const RunPose& pose) {
        const double before = std::abs(pose_at(entity, pose.time - kSpan).speed),
                     after = std::abs(pose_at(entity, pose.time + kSpan).speed);
        const double speed = std::abs(pose.speed);
        moved = moved || speed > 1;
        const double span = std::min(pose.time + kSpan, entity.poses.back().time) -
                            std::max(pose.time - kSpan, entity.poses.front().time);
        return (span > 0 && (before - after) / span > kBrakeLampDeceleration && after < speed + 1e-9) ||
               (moved && speed < kStanding);
    });
}

EsminiRun read_checked(const std::filesystem::path& table, const std::optional<std::filesystem::path>& scenario,
                       const RoadNetwork* roads) {
    EsminiRun run;
    read_table(table, run);
    if (scenario) {
        ScenarioFile file(*scenario);
        if (!file.root().child("Storyboard"))
            run.notes.push_back(file.root().place() + ": has no Storyboard: it sets no lamps");
        const auto header = file.root().child("FileHeader");
        if (header && header->text_or("revMajor", "1") == "0")
            run.notes.push_back(header->place() +
                                ": OpenSCENARIO 0.9 has other elements than 1.0 to 1.3, which are understood");
        for (const XmlElement& each : file.root().children_of("RoadNetwork", "LogicFile"))
            run.road_file = resolved(each, "filepath", file.parameters()).value_or("");
        describe_entities(file, run);
        play_storyboard(file, roads, run);
    }
    for (RunEntity& entity : run.entities) derive_lamps(entity);
    return run;
}

}  // namespace

EsminiRun read_esmini_run(const std::filesystem::path& table, const std::optional<std::filesystem::path>& scenario,
                          const RoadNetwork* roads) {
    try {
        return read_checked(table, scenario, roads);
    } catch (const std::bad_alloc&) {
        throw OutOfHostMemory(one_line(table.string()) + ": not enough memory");
    }
}

}  // namespace vesper::roads
