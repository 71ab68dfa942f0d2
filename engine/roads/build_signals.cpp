// Signs and traffic lights. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/luminance.h"
#include "roads/road_lamps.h"
#include "roads/sign_faces.h"

namespace vesper::roads {
namespace {

constexpr size_t kMaxSignals = 20'000;
constexpr double kPole = 0.6;  // m; a pole among the objects within this stands for the signal's

/// EN 12368: 200 mm lenses, performance level 2: 200 cd on the axis, within it cosine-like.
constexpr double kLens = 0.2;        // m
constexpr float kLensCandela = 200;  // cd
constexpr double kSmallLens = 0.1;   // m, where the housing is small

bool has_pole(const Road& road, const RoadSignal& signal) {
    return std::any_of(road.objects.begin(), road.objects.end(), [&](const RoadObject& object) {
        return object.type.find("pole") != object.type.npos &&
               std::hypot(object.s - signal.s, object.t - signal.t) < kPole;
    });
}

uint32_t lens_light(RoadBuild& build, const char* name, glm::vec3 colour, double diameter) {
    for (uint32_t i = 0; i < build.scene.lamps.size(); ++i)
        if (build.scene.lamps[i].name == name && build.scene.lamps[i].opening.length == diameter) return i;
    scene::Lamp lamp{.name = name, .kind = scene::Lamp::Kind::Spot};
    lamp.intensity = static_cast<float>(kLensCandela * diameter * diameter / (kLens * kLens));
    lamp.colour = glm::vec3(glm::dvec3(colour) / luminance(glm::dvec3(colour)));
    lamp.inner_cone = 0.09f, lamp.outer_cone = 0.7f;
    lamp.opening.length = lamp.opening.width = diameter, lamp.opening.round = true;
    build.scene.lamps.push_back(lamp);
    return static_cast<uint32_t>(build.scene.lamps.size() - 1);
}

struct SignalBuilder {
    RoadBuild& build;
    const Road& road;
    RoadMesh& mesh;

    /// +x is where the signal looks.
    BodyFrame frame_of(const RoadSignal& s) const {
        const BodyFrame frame = frame_at(road, s.s, s.t, s.z_offset);
        return frame.turned(s.heading + (s.orientation == '-' ? 0 : kPi), s.pitch, s.roll);
    }

    void pole(const RoadSignal& s, const BodyFrame& frame, double height) {
        if (has_pole(road, s)) return;
        const double ground = std::min(build.ground.height(glm::dvec2(frame.origin)), frame.origin.z) - 0.2;
        BodyFrame foot = frame_at(road, s.s, s.t, 0);
        foot.origin = {frame.origin.x - frame.x.x * 0.06, frame.origin.y - frame.x.y * 0.06, ground};
        add_cylinder(mesh, RoadMaterial::PoleSteel, foot, height > 1.5 ? 0.06 : 0.035,
                     frame.origin.z + height - ground);
    }

    void sign(const RoadSignal& s) {
        const double width = s.width > 0.05 ? s.width : 0.6, height = s.height > 0.05 ? s.height : 0.6;
        const BodyFrame frame = frame_of(s);
        add_sign(mesh, frame, s, width, height);
        if (width < 2) return pole(s, frame, height * 0.9);
        // Boards stand on two.
        for (const double side : {-0.35, 0.35}) pole(s, frame.moved(0, side * width, 0), height * 0.9);
    }

    /// A housing with lenses, the lit one or all of them as lamps. Without a scenario, cars wait: red for them, green
    /// for people on foot.
    void lamp(const RoadSignal& s) {
        const bool on_foot = is_for_pedestrians(s);
        const int lenses = on_foot ? 2 : 3;
        const double height = s.height > 0.1 ? s.height : on_foot ? 0.6 : 0.9, width = s.width > 0.05 ? s.width : 0.3;
        const BodyFrame frame = frame_of(s);
        const double depth = 0.16, pitch = height / lenses,
                     lens = pitch > 0.22 ? kLens : std::min(kSmallLens, pitch * 0.8);
        add_box(mesh, RoadMaterial::Housing, frame.moved(-depth / 2, 0, 0), depth, width, height);
        // A box has no bottom, and this one is seen from below.
        mesh.quad(RoadMaterial::Housing, frame.at(0, -width / 2, 0), frame.at(-depth, -width / 2, 0),
                  frame.at(-depth, width / 2, 0), frame.at(0, width / 2, 0));
        pole(s, frame.moved(-depth, 0, 0), height);
        const std::string name = "signal_" + s.id;
        const auto lamp = [&](const char* colour, glm::vec3 rgb, int place) {
            if (!build.options.every_lens && colour != std::string(on_foot ? "green" : "red")) return;
            const BodyFrame out = frame.moved(0.01, 0, height - (place + 0.5) * pitch);
            // It shines along -Z, its X to the right of who stands behind it.
            scene::Node node = node_at(build, name + "/" + colour, out.origin, -out.y, out.z, -out.x);
            node.lamp = lens_light(build, (std::string(colour) + " signal").c_str(), rgb, lens);
            build.scene.nodes.push_back(node);
        };
        lamp("red", {1, 0.05f, 0.02f}, 0);
        if (!on_foot) lamp("yellow", {1, 0.4f, 0}, 1);
        lamp("green", {0.05f, 1, 0.55f}, lenses - 1);
    }

    /// A line across the lanes of one direction.
    void stop_line(const RoadSignal& s) {
        const LaneSection& section = road.sections[road.section_at(std::clamp(s.s, 0.0, road.length - 1e-6))];
        const int side = (s.orientation == '-') == road.right_hand ? 1 : -1;
        int first = 0, last = 0;
        for (int id = side; section.find(id); id += side)
            if (is_driven(section.find(id)->type)) {
                if (first == 0) first = id;
                last = id;
            }
        if (first == 0) return;
        const double from = lane_border(road, section, first - side, s.s), to = lane_border(road, section, last, s.s);
        const auto corner = [&](double ds, double t) {
            const RoadPoint p = surface_point(road, s.s + ds, t);
            return p.position + p.up * (kMarkHeight + 0.003);
        };
        const double right = std::min(from, to), left = std::max(from, to);
        mesh.quad(RoadMaterial::MarkWhite, corner(-0.25, right), corner(0.25, right), corner(0.25, left),
                  corner(-0.25, left));
    }
};

}  // namespace

void build_signals(RoadBuild& build) {
    RoadMesh mesh(build.network);
    size_t signs = 0, lamps = 0;
    for (const Road& road : build.network.roads) {
        if (road.sections.empty()) continue;
        SignalBuilder builder{build, road, mesh};
        for (const RoadSignal& signal : road.signals) {
            if (signs + lamps >= kMaxSignals) break;
            if (is_painted(signal)) {
                builder.stop_line(signal);
            } else if (is_traffic_light(signal)) {
                builder.lamp(signal);
                ++lamps;
            } else {
                builder.sign(signal);
                ++signs;
            }
            mesh.place(build.scene, build.materials, "signal " + signal.id);
        }
    }
    if (signs + lamps > 0)
        build.notes.push_back("signals: " + std::to_string(signs) + " signs, " + std::to_string(lamps) +
                              " traffic lights");
}

}  // namespace vesper::roads
