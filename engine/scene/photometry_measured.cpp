// Measured lamps in the photometry file: file, flux, pose. SPDX-License-Identifier: MIT
#include "scene/photometry_measured.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/error.h"
#include "base/lower.h"
#include "io/named_file.h"
#include "photometry/eulumdat.h"
#include "photometry/standard_lamps.h"
#include "scene/photometry_parts.h"

namespace vesper::scene {
namespace {

/// The index of the distribution a rule wants, read when it is the first to want it.
uint32_t measured_lamp(const JsonValue& source, const std::filesystem::path& folder, Photometry& made) {
    const auto standard = source.find("standard");
    if (standard && source.find("file")) standard->fail("is given beside file: one of them is wanted");
    if (standard && source.find("lamp_set")) standard->fail("lamp_set is for EULUMDAT (.ldt), not for a built-in lamp");
    const JsonValue file = standard ? *standard : source.at("file");
    MeasuredLamp wanted{.file = file.text(),
                        .standard = standard.has_value(),
                        .mirror = source.boolean_or("mirror", false),
                        .lamp_set = source.integer_or("lamp_set", 0, 1000)};
    for (size_t i = 0; i < made.measured.size(); ++i) {
        const MeasuredLamp& known = made.measured[i];
        if (known.file == wanted.file && known.standard == wanted.standard && known.mirror == wanted.mirror &&
            known.lamp_set == wanted.lamp_set)
            return static_cast<uint32_t>(i);
    }
    try {
        const std::filesystem::path path = standard ? std::filesystem::path() : io::named_file(folder, wanted.file);
        if (wanted.lamp_set > 0 && lower(path.extension().string()) != ".ldt")
            throw Error("lamp_set is for EULUMDAT (.ldt)");
        if (standard)
            wanted.distribution = photometry::standard_lamp(wanted.file);
        else
            wanted.distribution = wanted.lamp_set > 0 ? photometry::read_eulumdat(path, wanted.lamp_set)
                                                      : photometry::read_distribution(path);
    } catch (const Error& error) {
        file.fail(error.what());
    }
    if (wanted.mirror) wanted.distribution = photometry::mirrored(wanted.distribution);
    made.measured.push_back(std::move(wanted));
    return static_cast<uint32_t>(made.measured.size() - 1);
}

double factor_of(const JsonValue& source, const photometry::Distribution& distribution) {
    double factor = source.number_or("flux_scale", 1, 0, 1e6);
    if (const auto flux = source.find("flux_lm")) {
        if (source.find("flux_scale")) flux->fail("is given beside flux_scale: one of them is wanted");
        const double measured = photometry::luminous_flux(distribution);
        if (!(measured > 0)) flux->fail("cannot scale a distribution without any flux");
        factor = flux->number(0, 1e9) / measured;
    }
    if (const auto maintenance = source.find("maintenance_factor")) {
        if (!(maintenance->number(0, 1) > 0)) maintenance->fail("must be more than 0");
        factor *= maintenance->number(0, 1);
    }
    return factor * source.number_or("dimming", 1, 0, 1);
}

std::optional<glm::dvec3> direction(const JsonValue& source, const char* key) {
    const auto value = source.find(key);
    if (!value) return std::nullopt;
    const auto v = value->numbers<3>();
    const glm::dvec3 axis(v[0], v[1], v[2]);
    if (!(glm::length(axis) > 1e-6)) value->fail("must not be of length 0");
    return glm::normalize(axis);
}

/// The part of an axis at right angles to the aim.
glm::dvec3 across(glm::dvec3 axis, glm::dvec3 aim) { return axis - aim * glm::dot(axis, aim); }

/// From the luminaire's frame (distribution.h) to the node's.
glm::dquat pose_of(const JsonValue& source, photometry::Goniometry goniometry) {
    const bool c = goniometry == photometry::Goniometry::CGamma;
    if (const auto wrong = source.find(c ? "up" : "c0"))
        wrong->fail(c ? "is for distributions of type A and B: this one is of type C and wants c0"
                      : "is for distributions of type C: this one is of type A or B and wants up");
    const glm::dvec3 aim = direction(source, "aim").value_or(glm::dvec3(0, 0, -1));
    const auto stated = direction(source, c ? "c0" : "up");
    const glm::dvec3 second = across(stated.value_or(glm::dvec3(0, 1, 0)), aim);
    const bool parallel = glm::length(second) < 1e-6;
    if (stated && parallel) source.at(c ? "c0" : "up").fail("must not be parallel to aim");
    glm::dquat pose = turn_to(aim);
    if (stated || (!c && !parallel)) {
        const glm::dvec3 axis = glm::normalize(second), z = -aim;
        const glm::dmat3 frame =
            c ? glm::dmat3(axis, glm::cross(z, axis), z) : glm::dmat3(glm::cross(axis, z), axis, z);
        pose = glm::normalize(glm::quat_cast(frame));
    }
    const auto angle = [&](const char* key) { return source.number_or(key, 0, -360, 360) * kRadiansPerDegree; };
    pose *= glm::angleAxis(-angle("yaw_deg"), glm::dvec3(0, 1, 0));
    pose *= glm::angleAxis(angle("pitch_deg"), glm::dvec3(1, 0, 0));
    pose *= glm::angleAxis(angle("rotation_deg"), glm::dvec3(0, 0, 1));
    return pose;
}

}  // namespace

bool is_turned_down(const LampRule& rule, const glm::dmat4& world) {
    const glm::dvec3 axis(-world[2]);
    constexpr double kMostAway = 0.70710678118654752;  // cosine of 45 degrees
    return rule.points_down && glm::length(axis) > 0 && -axis.y < kMostAway * glm::length(axis);
}

glm::dquat turn_of(const LampRule& rule, const glm::dmat4& world) {
    const glm::dquat stated = rule.turn ? *rule.turn : turn_to(rule.aim.value_or(glm::dvec3(0, 0, -1)));
    if (!is_turned_down(rule, world)) return stated;
    const glm::dmat3 axes(world);
    if (!(std::abs(glm::determinant(axes)) > 0)) return stated;
    const glm::dvec3 down = glm::inverse(axes) * glm::dvec3(0, -1, 0);
    return glm::normalize(turn_to(glm::normalize(down)) * stated);
}

glm::dquat turn_to(glm::dvec3 axis) {
    const glm::dvec3 from(0, 0, -1);
    const double cosine = glm::dot(from, axis);
    if (cosine < -1 + 1e-12) return {0, 0, 1, 0};  // half a turn about Y
    const glm::dvec3 normal = glm::cross(from, axis);
    return glm::normalize(glm::dquat(1 + cosine, normal.x, normal.y, normal.z));
}

void read_measured(const JsonValue& source, const std::filesystem::path& folder, Photometry& made, LampRule& rule) {
    allow_in_rule(source, {"name",       "nodes",
                           "type",       "file",
                           "standard",   "lamp_set",
                           "mirror",     "flux_lm",
                           "flux_scale", "maintenance_factor",
                           "dimming",    "colour_temperature_K",
                           "colour_rgb", "offset_m",
                           "aim",        "up",
                           "c0",         "rotation_deg",
                           "pitch_deg",  "yaw_deg",
                           "opening",    "fixture"});
    rule.lamp.kind = Lamp::Kind::Measured;
    rule.lamp.distribution = measured_lamp(source, folder, made);
    const photometry::Distribution& distribution = made.measured[rule.lamp.distribution].distribution;
    rule.lamp.intensity = static_cast<float>(factor_of(source, distribution));
    if (!std::isfinite(rule.lamp.intensity)) source.fail("the factors multiply to a number that is not finite");
    const glm::dquat pose = pose_of(source, distribution.goniometry);
    if (std::abs(pose.w) < 1 - 1e-12) rule.turn = pose;
    const auto is_stated = [&](const char* key) { return source.find(key).has_value(); };
    rule.points_down = distribution.goniometry == photometry::Goniometry::CGamma && !is_stated("aim") &&
                       !is_stated("yaw_deg") && !is_stated("pitch_deg");
}

}  // namespace vesper::scene
