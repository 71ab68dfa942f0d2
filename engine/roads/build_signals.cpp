// Signs and traffic lights. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/budget.h"
#include "base/luminance.h"
#include "roads/road_lamps.h"
#include "roads/sign_faces.h"
#include "roads/signal_supports.h"

namespace vesper::roads {
namespace {

constexpr size_t kMaxSignals = 20'000;

/// EN 12368: 200 mm lenses, performance level 2: 200 cd on the axis, within it cosine-like.
constexpr double kLens = 0.2;        // m
constexpr float kLensCandela = 200;  // cd
/// Lower edges where the file states none. Traffic lights: RiLSA 2015; signs: VwV-StVO to §§ 39 to 43, III 13.
constexpr double kLightBeside = 2.1, kSignBeside = 2.0, kOverLanes = 4.5;  // m
constexpr double kNoOffset = 0.05;                                         // m
/// The stated height of slender signals that are higher is that of their pole.
constexpr double kWithPole = 1.8, kPoleSlender = 2;  // m; of the width
constexpr double kSmallLens = 0.1;                   // m, where the housing is small

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
    SignalSupports& supports;
    size_t raised = 0;  ///< signals that the file puts on the ground

    bool is_over_lane(const RoadSignal& s) const { return is_lane_below(build, road, s.s, s.t); }

    /// Lights whose id another one has are numbered: "signal_7", "signal_7#2".
    std::string own_name(const std::string& name) {
        if (!build.phases.contains(name)) return name;
        size_t& number = build.light_numbers.try_emplace(name, 1).first->second;
        ++build.lights_renamed;
        std::string own;
        do {
            check_time();
            own = name + "#" + std::to_string(++number);
        } while (build.phases.contains(own));
        return own;
    }

    /// +x is where the signal looks.
    BodyFrame frame_of(const RoadSignal& s) const {
        const BodyFrame frame = frame_at(road, s.s, s.t, s.z_offset);
        return frame.turned(s.heading + (s.orientation == '-' ? 0 : kPi), s.pitch, s.roll);
    }

    /// The signal with the size of its panel or housing, and at the usual height if it would lie on the ground.
    /// `height`: of such a panel or housing, m.
    RoadSignal mounted(RoadSignal s, double height, double beside, bool over_lane) {
        if (std::abs(s.z_offset) > kNoOffset || stands_on_ground(s)) return s;
        ++raised;
        if (s.height > kWithPole && s.height > kPoleSlender * s.width)
            s.z_offset += s.height - height, s.height = height;
        else
            s.z_offset = over_lane ? kOverLanes : beside;
        return s;
    }

    void carry(const RoadSignal& s, const BodyFrame& frame, double width, double height, bool over_lane) {
        supports.carry(mesh, road, s,
                       {.frame = frame,
                        .width = width,
                        .height = height,
                        .ground = surface_point(road, s.s, s.t).position.z,
                        .over_lane = over_lane});
    }

    void sign(const RoadSignal& stated) {
        const bool over_lane = is_over_lane(stated);
        const double width = stated.width > 0.05 ? stated.width : 0.6;
        const RoadSignal s = mounted(stated, std::min(width, 1.0), kSignBeside, over_lane);
        const double height = s.height > 0.05 ? s.height : 0.6;
        const BodyFrame frame = frame_of(s);
        add_sign(mesh, frame, s, width, height);
        carry(s, frame, width, height * 0.9, over_lane);
    }

    /// A housing with lenses, the lit one or all of them as lamps.
    void lamp(const RoadSignal& stated, const SignalPhase& phase) {
        const bool on_foot = is_for_pedestrians(stated), over_lane = is_over_lane(stated);
        const int lenses = on_foot ? 2 : 3;
        const RoadSignal s = mounted(stated, on_foot ? 0.6 : 0.9, kLightBeside, over_lane);
        const double height = s.height > 0.1 ? s.height : on_foot ? 0.6 : 0.9, width = s.width > 0.05 ? s.width : 0.3;
        const BodyFrame frame = frame_of(s);
        const double depth = 0.16, pitch = height / lenses,
                     lens = pitch > 0.22 ? kLens : std::min(kSmallLens, pitch * 0.8);
        add_box(mesh, RoadMaterial::Housing, frame.moved(-depth / 2, 0, 0), depth, width, height);
        // A box has no bottom, and this one is seen from below.
        mesh.quad(RoadMaterial::Housing, frame.at(0, -width / 2, 0), frame.at(-depth, -width / 2, 0),
                  frame.at(-depth, width / 2, 0), frame.at(0, width / 2, 0));
        carry(s, frame.moved(-depth, 0, 0), width, height, over_lane);
        const std::string name = own_name("signal_" + s.id);
        build.phases[name] = phase;
        const SignalAspect aspect = aspect_of(build.options.signals, phase, build.options.signal_time, on_foot);
        const auto lamp = [&](const char* colour, SignalAspect shown, glm::vec3 rgb, int place) {
            if (!build.options.every_lens && aspect != shown) return;
            const BodyFrame out = frame.moved(0.01, 0, height - (place + 0.5) * pitch);
            // It shines along -Z, its X to the right of who stands behind it.
            scene::Node node = node_at(build, name + "/" + colour, out.origin, -out.y, out.z, -out.x);
            node.lamp = lens_light(build, (std::string(colour) + " signal").c_str(), rgb, lens);
            build.scene.nodes.push_back(node);
        };
        lamp("red", SignalAspect::Red, {1, 0.05f, 0.02f}, 0);
        if (!on_foot) lamp("yellow", SignalAspect::Amber, {1, 0.4f, 0}, 1);
        lamp("green", SignalAspect::Green, {0.05f, 1, 0.55f}, lenses - 1);
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
    SignalSupports supports(build);
    size_t signs = 0, lamps = 0, raised = 0;
    const SignalPlan plan(build.network, build.lanes);
    for (uint32_t r = 0; r < build.network.roads.size(); ++r) {
        const Road& road = build.network.roads[r];
        if (road.sections.empty()) continue;
        SignalBuilder builder{build, road, mesh, supports};
        for (uint32_t i = 0; i < road.signals.size(); ++i) {
            const RoadSignal& signal = road.signals[i];
            if (signs + lamps >= kMaxSignals) break;
            if (is_painted(signal)) {
                builder.stop_line(signal);
            } else if (is_traffic_light(signal)) {
                builder.lamp(signal, plan.of(r, i));
                ++lamps;
            } else {
                builder.sign(signal);
                ++signs;
            }
            mesh.place(build.scene, build.materials, "signal " + signal.id);
        }
        raised += builder.raised;
    }
    if (raised > 0)
        build.notes.push_back("signals at zOffset 0: " + std::to_string(raised) +
                              ", mounted as usual: lights 2.1 m, signs 2 m, over lanes 4.5 m above the road");
    if (build.lights_renamed > 0)
        build.notes.push_back("traffic lights with the id of another: " + std::to_string(build.lights_renamed) +
                              ", their lenses are numbered");
    supports.add_arms(mesh);
    mesh.place(build.scene, build.materials, "arms of signals");
    if (signs + lamps > 0)
        build.notes.push_back("signals: " + std::to_string(signs) + " signs, " + std::to_string(lamps) +
                              " traffic lights");
}

}  // namespace vesper::roads
