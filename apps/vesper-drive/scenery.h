// A world on the scene's nodes: what moves is posed, and its lamps are lit, frame by frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "settings.h"
#include "signal_lens.h"
#include "traffic/world_file.h"

namespace vesper::drive {

/// Lamps of one name.
struct LampGroup {
    std::string name;
    size_t lamps = 0;
    double candela = 0;  ///< the largest intensity of any of them, as the scene has it
};

/// A scene that is driven in. The animations of the file do not play: what moves is the world's.
class Scenery {
public:
    /// Reads a world (.json), roads (.xodr), or a scene alone (.gltf, .glb), in which one drives straight on over a
    /// plane from the first camera; what is below that camera goes along. `run`: a run that esmini recorded on these
    /// roads, and its scenario (.xosc) where there is one; instead of traffic. Throws Error.
    explicit Scenery(const std::filesystem::path& file, const std::filesystem::path& run = {},
                     const std::filesystem::path& scenario = {});

    const scene::Scene& scene() const { return scene_; }
    const std::shared_ptr<const traffic::WorldDescription>& world() const { return world_; }
    const std::vector<std::string>& notes() const { return notes_; }
    /// The lamps there are by name, as "lamp:NAME" settings have them, sorted.
    std::vector<LampGroup> lamp_groups() const;

    /// Gives settings back if all lamps that they name are here. Throws Error.
    const DriveSettings& check(const DriveSettings&) const;

    /// Where everything stands and how it is lit, with the actors of a World of `world()` after so many seconds.
    gpu_scene::SceneFrame frame(const std::vector<traffic::Actor>&, double seconds, const DriveSettings&) const;
    /// What the camera of the settings sees of that frame.
    gpu_scene::View view(const gpu_scene::SceneFrame&, const std::vector<traffic::Actor>&, const DriveSettings&,
                         VkExtent2D) const;

private:
    enum Role : uint8_t { kFixed, kLow, kHigh, kTail, kBrake, kLeft, kRight };  // in the order of kLampRoles
    struct SwitchedLamp {
        uint32_t node;
        uint32_t actor;  // index, kNone: fixed
        Role role;
        bool by_day;
        uint32_t lens;  // index, kNone: nobody switches it
        std::string name;
    };
    /// Takes its world; names stay. `eye`: a node that goes with the driver's car from where it stands, with all that
    /// is below it.
    void adopt(traffic::WorldFile&, uint32_t eye = scene::kNone);
    /// Throws Error, which begins with `place`, where no lamp of the scene has that name.
    void require_lamp(const std::string& name, const std::string& place) const;
    void require_lamps(const std::vector<std::string>& names, const std::string& place) const;
    void find_lamps(const traffic::LampRoles&, const std::vector<std::string>& by_day);
    bool shines(const SwitchedLamp&, const std::vector<traffic::Actor>&, bool bright) const;

    scene::Scene scene_;
    std::shared_ptr<const traffic::WorldDescription> world_;
    std::vector<std::string> notes_;
    std::vector<glm::dmat4> rest_;  // of each node, in the world
    struct Rider {
        uint32_t node, actor;
        glm::dmat4 offset;  // from the actor's pose
    };
    std::vector<Rider> riders_;  // nodes that move
    std::vector<SwitchedLamp> lamps_;
    std::vector<SignalLens> lenses_;
    std::string camera_;  // of the driver's eye; empty: none
    gpu_scene::AmbientLight night_;
    std::vector<scene::Tunnel> tunnels_;
};

}  // namespace vesper::drive
