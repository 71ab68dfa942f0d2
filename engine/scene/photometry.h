// The photometry file, which makes a database photometric (docs/photometry.md).
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace vesper::scene {

/// A rule that puts a lamp on every node its patterns match.
struct LampRule {
    std::string name;
    std::vector<std::string> nodes;  ///< patterns
    Lamp lamp;                       ///< intensity, lobe, colour, opening; Measured: the factor, an index into measured
    double kelvin = 0;               ///< colour temperature, K; 0 where a colour was given
    std::optional<glm::dvec3> aim;   ///< axis of the lobe in the node's frame, unit length; -Z where missing
    std::optional<glm::dquat> turn;  ///< Measured: from the luminaire's frame to the node's, where they differ
    bool points_down = false;        ///< Measured, type C, without a stated direction: see turn_of()
    glm::dvec3 offset{0};            ///< m, along the node's axes
    std::string fixture = "own";     ///< or "none", or a pattern for the node whose meshes never hide the lamp
    std::string fixture_place;       ///< file and JSON pointer of the line above, for messages
};

/// A distribution used by rules.
struct MeasuredLamp {
    std::string file;       ///< as in the rule
    bool standard = false;  ///< `file` names a lamp that is built in (photometry/standard_lamps.h)
    bool mirror = false;
    size_t lamp_set = 0;
    photometry::Distribution distribution{};
};

/// A picture of a light source used by rules.
struct EmitterPicture {
    std::vector<uint8_t> bytes;              ///< of the file
    photometry::LuminancePicture picture{};  ///< its name is that of the rule
    double white_luminance = 0;              ///< cd/m^2 of the value 1 by the file; 0 if not stated
    uint64_t changed = 0;                    ///< pixels with a negative component, see make_luminance_picture
    std::vector<std::string> notes{};        ///< of its header, see io::HdrImage
};

/// A rule that makes materials emit.
struct EmitterRule {
    std::string name;
    std::vector<std::string> materials;  ///< patterns
    double luminance = 0;                ///< cd/m^2; with lamps only compared; 0 if not given
    std::vector<std::string> lamps;      ///< names of lamp rules whose glass this is: their openings are drawn
    glm::dvec3 colour{1};                ///< linear, luminance 1
    bool modulate = false;      ///< the material's texture times the above; its brightest texel has `luminance`
    uint32_t picture = kNone;   ///< index into Photometry::pictures: the material shows it; its brightest texel has
                                ///< `luminance`
    double scale = 1;           ///< cd/m^2 of the value 1 of the picture
    bool unit_unknown = false;  ///< neither rule nor picture states a unit: the value 1 is 1 cd/m^2
};

/// A rule that changes how materials reflect.
struct SurfaceRule {
    std::string name;
    std::vector<std::string> materials;  ///< patterns
    double reflectance_scale = 1;
    std::optional<double> roughness, metallic;
    std::optional<photometry::ReflectionTable> reflection_table;
    std::optional<photometry::Retroreflector> retroreflector;
};

/// A quantity with a colour of luminance 1.
struct ColouredQuantity {
    double value = 0;
    glm::dvec3 colour{1};
};

/// A picture for a sky.
struct SkyPicture {
    std::string file;  ///< as the photometry file has it
    photometry::Environment environment{};
    uint64_t cleaned = 0;              ///< pixels that were not finite or below 0
    std::vector<std::string> notes{};  ///< of its header, see io::HdrImage
};

/// Light from one direction: the moon, dusk.
struct DirectionalRule {
    std::string name;
    double illuminance = 0;                  ///< on a surface facing it, lx
    glm::dvec3 colour{1};                    ///< linear, luminance 1
    std::optional<double> angular_diameter;  ///< of its disc in the sky, degrees; none: that of sun and moon
    glm::dvec3 direction{0, -1, 0};          ///< in which the light goes, world frame, unit length
};

struct Photometry {
    std::filesystem::path file;
    Transfer transfer{Transfer::Kind::Gamma, 2.2f};
    std::optional<ColouredQuantity> ambient;  ///< illuminance, lx
    std::optional<ColouredQuantity> sky;      ///< luminance, cd/m^2
    std::optional<SkyPicture> sky_picture;    ///< or this
    std::vector<DirectionalRule> directional;
    bool keep_lights = false;
    std::vector<LampRule> lamps;
    std::vector<MeasuredLamp> measured;    ///< each once
    std::vector<EmitterPicture> pictures;  ///< each once
    std::vector<EmitterRule> emitters;
    std::vector<SurfaceRule> surfaces;
};

/// Reads and checks a photometry file. Throws Error naming file, JSON pointer and reason.
Photometry read_photometry(const std::filesystem::path& file);

/// True if a name matches a pattern of `*` (any characters) and `?` (one character).
bool matches_name(const std::string& pattern, const std::string& name);

/// True if a pattern with '/' matches the end of a path: `path` holds the names from the node up to its root. Names of
/// the path are joined with '/', the match begins at the start of a name, and wildcards do not match a '/'. A pattern
/// without '/' is compared with the node's own name. Returns at once when more names are needed than there are slashes.
bool matches_path(const std::string& pattern, const std::vector<std::string>& path);

/// The same for a node of a scene and those above it.
bool matches_node(const std::string& pattern, const Scene&, uint32_t node);

}  // namespace vesper::scene
