// A car with exchangeable headlamps that drives towards an obstacle of its scene. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "photometry/distribution.h"
#include "scene/scene.h"

namespace vesper::commands {

/// What is where. Patterns are those of matches_node().
struct ApproachSettings {
    std::string camera;                        ///< rides in the car; empty: the first
    std::string headlamps = "*headlamp*";      ///< nodes of the car, each with lamps at or below it
    std::string obstacle;                      ///< one node
    std::optional<glm::dvec3> obstacle_place;  ///< of the origin of its node, m, world; none: where the scene has it
    std::string oncoming;                      ///< nodes whose lamps are on or off; empty: none
    std::vector<std::string> without;          ///< nodes that are not there, but for the others of this list
};

/// What headlamps shine with: each with this distribution in place of its lamps, level and straight ahead, with place,
/// colour and opening of the first of them; none: as the scene has them.
struct Beam {
    std::string name;
    std::optional<photometry::Distribution> distribution;
};

class Approach {
public:
    /// The scene with a lamp for each beam at each headlamp. Throws Error naming the option that has no match.
    Approach(scene::Scene scene, const ApproachSettings&, const std::vector<Beam>&);

    const scene::Scene& scene() const { return scene_; }
    /// Poses and lamps with the eye so many m before the middle of the obstacle, along the car's way. The way is level,
    /// along the mean axis of the headlamps, through the place of the car in the scene.
    gpu_scene::SceneFrame at(double distance, size_t beam, bool oncoming) const;
    /// How far the obstacle lies to the right of the eye's way, m.
    double aside() const;
    /// Horizontal illuminance by the lamps of a beam, lx, at a place so many m before the eye and to the right of it,
    /// at the height of the origin of the car's node. As if nothing stood between.
    double road_illuminance(size_t beam, double ahead, double right) const;
    glm::dvec3 forward() const { return forward_; }
    uint32_t headlamps() const { return uint32_t(headlamps_.size()); }

private:
    void find_car(const ApproachSettings&);
    void find_obstacle(const ApproachSettings&);
    void leave_out(const ApproachSettings&);
    void add_beam(const photometry::Distribution&, const std::string& name);

    scene::Scene scene_;
    std::vector<glm::dmat4> rest_;  ///< node frames to world
    uint32_t car_ = 0, camera_ = 0, obstacle_ = 0;
    std::vector<uint32_t> headlamps_;           ///< of each its first lamp, nodes
    std::vector<uint32_t> lamps_;               ///< all of theirs, nodes
    std::vector<std::vector<uint32_t>> beams_;  ///< nodes with lamps, by beam
    std::vector<bool> oncoming_;                ///< nodes
    glm::dvec3 forward_{0, 0, -1};              ///< of the car, unit
    glm::dvec3 target_{0};                      ///< the middle of the obstacle
    glm::dmat4 obstacle_pose_{1};
};

}  // namespace vesper::commands
