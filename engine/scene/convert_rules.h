// The steps of a conversion. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <span>
#include <tuple>

#include "base/decimal.h"
#include "scene/convert.h"
#include "scene/gltf_reader.h"
#include "scene/photometry.h"

namespace vesper::scene {

/// A conversion under way.
struct Conversion {
    GltfDocument& document;
    const GltfReader& original;  ///< the scene as it was read, unconverted
    const Photometry& photometry;
    ConversionReport& report;
    nlohmann::json lobes = nlohmann::json::array();  ///< of the extras block
    nlohmann::json reflection_tables = nlohmann::json::array(), roads = nlohmann::json::array();          ///< the same
    nlohmann::json retroreflectors = nlohmann::json::array(), retroreflective = nlohmann::json::array();  ///< the same
    nlohmann::json environment{};                                                                         ///< the same
    nlohmann::json openings = nlohmann::json::array(), fixtures = nlohmann::json::array();                ///< the same
    nlohmann::json luminance_pictures = nlohmann::json::array(), luminous = nlohmann::json::array();      ///< the same
    std::map<uint32_t, size_t> picture_of{};  ///< in luminance_pictures, for those of the photometry file
    /// Light profile of EXT_lights_ies for a measured lamp and its opening: length, width, whether round and drawn.
    std::map<std::tuple<uint32_t, double, double, bool, bool>, size_t> profiles{};
    std::vector<uint8_t> profile_bytes{};             ///< a new buffer
    std::vector<std::vector<uint32_t>> lamp_nodes{};  ///< nodes of the file that each lamp rule matches
};

inline constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

/// The object member of that name, made when missing. Throws Error when it is something else.
nlohmann::json& object_member(const GltfDocument& document, nlohmann::json& holder, const std::string& key);
/// Puts an extension on the list of those used.
void use_extension(nlohmann::json& root, const std::string& name);
/// A new buffer that holds these bytes, and the index of a view of it.
size_t add_buffer_view(nlohmann::json& root, std::span<const uint8_t> bytes);
std::string in_quotes(const std::string& name);

/// Names of a node of the file and of as many of those above it as fit into `depth`. `parents` of all nodes.
std::vector<std::string> path_of(std::span<const JsonValue> nodes, const std::vector<uint32_t>& parents, uint32_t node,
                                 size_t depth);
/// For each of these nodes of the file the node that the rule's pattern names as the fixture of its lamp: the nearest
/// of the node itself and those above it that matches, else the only one of the file that does. kNone for nodes that
/// the scene does not show. Throws Error where no node, or more than one, can be meant.
std::vector<uint32_t> named_fixtures(Conversion& conversion, const LampRule& rule, std::span<const uint32_t> nodes,
                                     const std::vector<uint32_t>& parents);

/// Removes the lights there are, puts lamps on nodes.
void convert_lamps(Conversion& conversion);
/// Directional lights, the sky, and what of both is not stated.
void convert_sky(Conversion& conversion);
/// Emission and reflectance of materials.
void convert_materials(Conversion& conversion);
/// Notes that a material of the file shows the picture of a rule. Returns its mean, RGB in cd/m^2.
glm::dvec3 show_picture(Conversion& conversion, const EmitterRule& rule, uint32_t material);
/// Size and luminances of the picture of a rule, for reports.
std::string described_picture(const Conversion& conversion, const EmitterRule& rule);
/// Warns of what cannot be right: sizes, lamps, things that look like lights and were not matched.
void check_plausibility(Conversion& conversion, const std::set<size_t>& lamp_nodes);

/// Warns of sources whose two descriptions, intensity of the lamp and luminance of the surface, disagree by more than
/// 10 %, and of those that would be seen twice. `emitting`: the materials of every emitter rule.
void check_sources(Conversion& conversion, const std::vector<std::vector<uint32_t>>& emitting);

/// A factor as people say it: "12 % more", "33 % less".
std::string deviation(double factor);

/// Warns of surfaces of a converted scene that reflect more than there are.
void check_reflectances(const Scene& converted, ConversionReport& report);

/// Whether a name sounds like a source of light.
bool sounds_like_light(const std::string& name);

}  // namespace vesper::scene
