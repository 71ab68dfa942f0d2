// A world on the scene's nodes: what moves is posed, and its lamps are lit, frame by frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "external/external_places.h"
#include "external/stationary.h"
#include "render/renderer.h"
#include "session/settings.h"
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
    /// plane from the first camera; what is below that camera goes along. Objects of messages take the place of
    /// traffic. Throws Error.
    explicit Scenery(const std::filesystem::path& file, const MessageSource& = {});

    const scene::Scene& scene() const { return scene_; }
    const std::shared_ptr<const traffic::WorldDescription>& world() const { return world_; }
    const std::vector<std::string>& notes() const { return notes_; }
    /// Gives away those of the source's file.
    std::vector<osi::Message> take_messages() { return std::move(messages_); }
    /// For the objects of messages.
    ExternalPlaces external_places() const;
    const MessageFrame& message_frame() const { return message_frame_; }
    const std::vector<SignalLens>& lenses() const { return lenses_; }
    /// The lamps there are by name, as "lamp:NAME" settings have them, sorted.
    std::vector<LampGroup> lamp_groups() const;

    /// Gives settings back if all lamps that they name are here. Throws Error.
    const DriveSettings& check(const DriveSettings&) const;

    /// Where everything stands and how it is lit, with the actors of a World of `world()`. `external`: lenses and sun,
    /// as another program has them; the sun of the settings goes before.
    gpu_scene::SceneFrame frame(const std::vector<traffic::Actor>&, const DriveSettings&,
                                const ExternalState& external = {}) const;
    /// What the camera of the settings sees of that frame.
    gpu_scene::View view(const gpu_scene::SceneFrame&, const std::vector<traffic::Actor>&, const DriveSettings&,
                         VkExtent2D) const;

private:
    static constexpr size_t kFixed = ~size_t{0};
    struct SwitchedLamp {
        uint32_t node;
        uint32_t actor;  // index, kNone: fixed
        size_t role;     // of traffic::kLampRoles, or kFixed
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
    std::shared_ptr<const GroundBelow> ground_below() const;
    /// `known`: where the roads have things of their own.
    void draw_stationary(std::span<const glm::dvec3> known);
    /// Makes the places of all messages of a trace the middles of boxes.
    void read_heights();
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
    MessageSource source_;
    std::vector<osi::Message> messages_;
    std::vector<osi::StationaryObject> stationary_;      // of a trace
    std::vector<std::pair<uint32_t, double>> standing_;  // its nodes, without signs, and half their heights
    ExternalBodies bodies_;
    MessageFrame message_frame_;
    std::vector<SignalLens> lenses_;
    std::string camera_;  // of the driver's eye; empty: none
    gpu_scene::AmbientLight night_;
    std::vector<scene::Tunnel> tunnels_;
};

}  // namespace vesper::drive
