// Whether a simulator states the middle of its boxes or the ground below them. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "external/message_frame.h"
#include "osi/timeline.h"
#include "rays/ray_caster.h"

namespace vesper::drive {

/// Surfaces that do not move, from above. The scene stays with the caller, as it is.
class GroundBelow {
public:
    /// Nodes at `world`; without the meshes of `moving` (ascending). Throws Error where the scene is too large for it.
    GroundBelow(const scene::Scene&, std::span<const glm::dmat4> world, std::vector<uint32_t> moving);
    /// Height of the first surface below a point of the world, m; none: within `reach` m there is none.
    std::optional<double> height(const glm::dvec3& from, double reach) const;

private:
    rays::RayCaster rays_;
    std::vector<uint32_t> moving_;
};

/// Objects that stand on the ground by either reading of their place. Others are on neither side: without ground near
/// them, lower than 0.6 m, or in between by more than 35 % of half their height.
struct HeightVotes {
    uint64_t middle = 0;  ///< their place is half their height above the ground
    uint64_t ground = 0;  ///< their place is on the ground
    uint64_t all() const { return middle + ground; }
    void add(const osi::MovingObject&, const MessageFrame&, const GroundBelow&);
};

/// Moves an object's place from the ground to the middle of its box, along its own axis.
void raise(osi::MovingObject&);

/// The places of a whole trace are those of the ground: at least 80 % of at least three. Of long traces some 5000
/// objects are looked at.
HeightVotes votes_of(std::span<const osi::Message>, const MessageFrame&, const GroundBelow&);
bool are_at_ground(const HeightVotes&);

/// The note where a sender's objects are raised.
inline constexpr char kRaised[] = "base.position of the objects is taken as the ground below them (--osi-z)";

/// The same while messages come: by the votes of moments, averaged over 15 of them. It is the middle until the average
/// is above 80 % for the ground, and stays the ground until that is below 20 %.
class HeightJudge {
public:
    /// Always one reading.
    explicit HeightJudge(bool at_ground = false) : at_ground_(at_ground) {}
    explicit HeightJudge(std::shared_ptr<const GroundBelow> below) : below_(std::move(below)) {}

    /// Whether the objects of this moment, the next one, are placed at the ground.
    bool take(const osi::Moment&, const MessageFrame&);
    bool at_ground() const { return at_ground_; }

private:
    std::shared_ptr<const GroundBelow> below_;
    double share_ = 0;
    bool at_ground_ = false;
};

}  // namespace vesper::drive
