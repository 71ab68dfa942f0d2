// Emitting triangles as lights: which of them to look at from a point. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "transport/lanes.h"
#include "transport/patch.h"
#include "transport/surfaces.h"

namespace vesper::transport {

/// The triangles of a scene that emit, as Surfaces has them. Large ones are in parts, so that what is near or bright is
/// chosen often.
class Emitters {
public:
    struct Emitter {
        uint32_t node, primitive, triangle;  ///< as in rays::Hit
        uint8_t halvings;                    ///< of the sides of the triangle: it has 4^halvings parts
        uint8_t part;                        ///< beside each other: at each corner, and between these, a fourth of them
        std::array<glm::dvec3, 3> corners;   ///< of the part, m, world
        glm::dvec3 outwards;                 ///< unit length, where its front faces
        double area;                         ///< of the part, m^2
        double luminance;  ///< cd/m^2, above 0: of its material; of parts about the mean with textures
        bool double_sided;
    };

    /// Some that lie beside each other in the list.
    struct Group {
        size_t first, count;
        glm::dvec3 centre;  ///< of a sphere around them, m
        double radius;      ///< m
        double power;       ///< luminance times area, cd
        bool flat;          ///< one plane, and seen from its front only: `outwards` of the first is that of all
    };

    /// kLanes groups that follow each other. Places are from origin(), m.
    struct GroupLanes {
        Lanes3 centre, outwards;                   ///< outwards: 0 where it is not flat
        Lanes plane{}, flat{}, radius{}, power{};  ///< plane: of flat ones, its distance along `outwards`; else -1
    };

    /// Keeps nothing of the scene. Throws Error with more than kMost in the list.
    static constexpr size_t kMost = size_t{1} << 22;
    Emitters(const scene::Scene& scene, std::span<const glm::dmat4> world, const Surfaces& surfaces);

    std::span<const Emitter> list() const { return list_; }  ///< ascending by node, primitive, triangle and part
    std::span<const Group> groups() const { return groups_; }
    std::span<const GroupLanes> group_lanes() const { return group_lanes_; }
    glm::dvec3 origin() const { return groups_.empty() ? glm::dvec3(0) : groups_[0].centre; }
    size_t group_of(size_t emitter) const { return group_of_[emitter]; }
    /// Of all emitters up to and with each: luminance times area, cd.
    std::span<const double> powers_up_to() const { return powers_up_to_; }
    /// Of the triangle that a ray meets, the part; none if it emits nothing.
    std::optional<size_t> find(const rays::Hit& hit) const;
    /// A place on one, by chance, even over it; both numbers from 0 to 1.
    struct Place {
        glm::dvec3 point{0};  ///< m, world
        rays::Hit hit;        ///< there, at `share` 1
    };
    Place place_on(size_t emitter, glm::dvec2 chance) const;

private:
    void add(const scene::Scene& scene, const Surfaces& surfaces, const Emitter& triangle);  // its parts
    void make_groups();
    void make_group_lanes();

    std::vector<Emitter> list_;
    std::vector<Group> groups_;
    std::vector<GroupLanes> group_lanes_;
    std::vector<uint32_t> group_of_;
    std::vector<double> powers_up_to_;
};

/// The least cosine at an emitter that counts: it is seen from its edge.
constexpr double kLeastLeaving = 1e-9;

/// How often each emitter is looked at from a patch: groups in proportion to about the illuminance that they give if
/// they are seen, their emitters by power.
class EmitterChoice {
public:
    /// Both keep a reference to the emitters. `seen`: factors above 0 on how often each group is chosen; empty: 1.
    EmitterChoice(const Emitters& emitters, const Patch& patch, std::span<const float> seen = {});
    /// For points anywhere: in proportion to the light that each emits.
    explicit EmitterChoice(const Emitters& emitters);

    bool any() const { return !ends_.empty() && ends_.back() > 0; }
    /// `share` from 0 to 1, which is used up: what is left of it is from 0 to 1 again.
    size_t choose(double& share) const;
    double probability(size_t emitter) const;
    /// Of directions `to` a place on an emitter, which is how far away (m): looks in a direction, 1/sr.
    double density(size_t emitter, glm::dvec3 to) const;

private:
    const Emitters& emitters_;
    std::vector<double> ends_;  // sums up to and with each group
};

}  // namespace vesper::transport
