// Rules of a template under way. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/lamp_glass.h"
#include "scene/photometry_template.h"
#include "scene/template_kinds.h"

namespace vesper::scene {

/// A rule, and the nodes or materials it is for.
struct TemplateRule {
    SourceReason reason = SourceReason::Name;
    const SourceKind* kind = nullptr;
    std::vector<uint32_t> members;
    nlohmann::ordered_json json;     ///< but name and comment
    std::string comment;             ///< behind the reason
    std::vector<GlassLamp> lamps{};  ///< of a rule for lamps, their places
};

/// Rules for lamps, those of most nodes first. `shining`: per material, whether an emitter rule makes it shine. Counts
/// suns, and nodes without a name.
std::vector<TemplateRule> lamp_rules(const Scene&, const SceneSource&, const std::vector<bool>& shining,
                                     PhotometryTemplate& counts);
/// Rules for emitters, those of the largest area first. Counts materials without a name.
std::vector<TemplateRule> emitter_rules(const Scene&, const SceneSource&, PhotometryTemplate& counts);

/// Gives emitters that are the glass of lamps the luminance and the colour of these, I / A. Limits work: the rules of
/// most lamps and the largest surfaces only.
void match_glass(const Scene&, std::vector<TemplateRule>& emitters, const std::vector<TemplateRule>& lamps);

/// A JSON number with three decimals, which is plenty for suggestions; whole numbers without a point.
nlohmann::ordered_json rounded(double value);
nlohmann::ordered_json rounded(glm::dvec3 values);
nlohmann::ordered_json json_of_patterns(const std::vector<std::string>& patterns);

/// Where a lamp of a node is, and where it shines.
struct LampPlace {
    glm::dvec3 world{0};            ///< m
    glm::dvec3 offset{0};           ///< m, along the node's axes
    std::optional<glm::dvec3> aim;  ///< in the node's frame; none: -Z
    std::optional<glm::dvec3> c0;   ///< in the node's frame: along the road, if the lamp has an arm
    bool surface = false;           ///< a shining surface of the scene shows it
};

/// Finds places of lamps by the surfaces at and below their nodes.
class LampPlaces {
public:
    LampPlaces(const Scene&, const std::vector<bool>& shining);
    /// `foot_above`: the parent's origin is the foot of the lamp's pole.
    LampPlace of(uint32_t node, const SourceKind&, bool has_light, bool foot_above) const;
    /// The axis of that lamp in the world, unit length.
    glm::dvec3 axis(uint32_t node, const LampPlace&) const;
    /// Of the meshes at and below a node, m, in the world.
    const Bounds& below(uint32_t node) const { return below_[node]; }
    /// The middle of these, else the node's origin; m, in the world.
    glm::dvec3 middle(uint32_t node) const;

private:
    struct Part {
        const Primitive* primitive;
        uint32_t node;
    };
    struct Surfaces;
    struct Shape;
    Shape shape_of(const std::vector<Part>&) const;
    void collect(uint32_t node, Surfaces&) const;
    bool shines_beside(uint32_t node) const;
    std::optional<glm::dvec3> off_vehicle(uint32_t node, glm::dvec3 at) const;

    const Scene& scene_;
    const std::vector<bool>& shining_;
    std::vector<glm::dmat4> world_;
    std::vector<uint32_t> first_child_, next_;
    std::vector<Bounds> below_;  ///< of all that is at and below each node, m, in the world
};

}  // namespace vesper::scene
