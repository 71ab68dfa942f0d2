#include "scene/gltf_patch.h"

#include <algorithm>
#include <numbers>

#include "base/error.h"
#include "scene/gltf_parts.h"
#include "scene/half_sky.h"
#include "scene/uri.h"

namespace vesper::scene {
namespace {

using nlohmann::json;
constexpr const char *kLights = "KHR_lights_punctual", *kMeasured = "EXT_lights_ies";

/// A new buffer that holds these bytes, and the index of a view of it.
size_t add_buffer_view(json& root, std::span<const uint8_t> bytes) {
    root["bufferViews"].push_back(
        {{"buffer", root.contains("buffers") ? root["buffers"].size() : 0}, {"byteLength", bytes.size()}});
    root["buffers"].push_back(
        {{"byteLength", bytes.size()}, {"uri", encode_data_uri("application/octet-stream", bytes)}});
    return root["bufferViews"].size() - 1;
}

void remove_extension(json& holder) {
    const auto extensions = holder.find("extensions");
    if (extensions == holder.end()) return;
    if (extensions->is_object())
        for (const char* name : {kLights, kMeasured}) extensions->erase(name);
    if (extensions->empty()) holder.erase("extensions");
}

void remove_from_list(json& root, const char* list) {
    const auto names = root.find(list);
    if (names == root.end()) return;
    for (const char* name : {kLights, kMeasured})
        names->erase(std::remove(names->begin(), names->end(), json(name)), names->end());
    if (names->empty()) root.erase(list);
}

void remove_lights(json& root) {
    remove_extension(root);
    if (root.contains("nodes"))
        for (json& node : root["nodes"]) remove_extension(node);
    remove_from_list(root, "extensionsUsed");
    remove_from_list(root, "extensionsRequired");
}

/// Appends to the list of lights of an extension of the root.
void add_lights(const GltfDocument& document, json& root, const char* extension, const json& lights) {
    if (lights.empty()) return;
    json& list = object_member(document, object_member(document, root, "extensions"), extension)["lights"];
    for (const json& light : lights) list.push_back(light);
    use_extension(root, extension);
}

/// For each node of the scene its index in the file; kNone for those that the file does not have.
std::vector<uint32_t> file_nodes_of(const GltfReader& reader, const PhotometryReport& report) {
    std::vector<uint32_t> made(reader.scene.nodes.size(), kNone);
    for (uint32_t i = 0; i < reader.node_of.size(); ++i) {
        const uint32_t before = reader.node_of[i], now = before == kNone ? kNone : report.node_of[before];
        if (now != kNone) made[now] = i;
    }
    return made;
}

/// Appends a node that rules made. Returns its index.
uint32_t add_node(json& root, const Node& node, uint32_t parent) {
    json made = {{"name", node.name}};
    const glm::dvec3& t = node.translation;
    if (t != glm::dvec3(0)) made["translation"] = {t.x, t.y, t.z};
    const glm::quat& q = node.rotation;
    if (q != glm::quat(1, 0, 0, 0)) made["rotation"] = {q.x, q.y, q.z, q.w};
    const auto index = static_cast<uint32_t>(root.contains("nodes") ? root["nodes"].size() : 0);
    root["nodes"].push_back(std::move(made));
    if (parent != kNone)
        root["nodes"][parent]["children"].push_back(index);
    else if (root.contains("scenes") && !root["scenes"].empty())  // else every node without a parent is shown
        root["scenes"][root.value("scene", size_t{0})]["nodes"].push_back(index);
    return index;
}

/// Nodes that rules made, and the lamps of all.
void write_nodes(const GltfDocument& document, json& root, const Scene& scene, const std::vector<LampUse>& uses,
                 std::vector<uint32_t>& file_nodes, const std::vector<bool>& of_rules) {
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (of_rules[i]) file_nodes[i] = add_node(root, node, node.parent == kNone ? kNone : file_nodes[node.parent]);
        if (file_nodes[i] == kNone || node.lamp == kNone || uses[node.lamp].value.is_null()) continue;
        object_member(document, root["nodes"][file_nodes[i]], "extensions")[uses[node.lamp].extension] =
            uses[node.lamp].value;
    }
}

json environment_of(json& root, const photometry::Environment& e, const std::string& name) {
    const HalfSky halves = half_floats_of(e);
    return {{"bufferView", add_buffer_view(root, halves.bytes)},
            {"width", e.width},
            {"height", e.height},
            {"scale", halves.scale},
            {"rotation_deg", std::clamp(e.rotation * 180 / std::numbers::pi, -360.0, 360.0)},
            {"name", name}};
}

}  // namespace

json& object_member(const GltfDocument& document, json& holder, const std::string& key) {
    json& member = holder[key];
    if (member.is_null()) member = json::object();
    if (!member.is_object()) throw Error(document.name() + ": \"" + key + "\" must be an object");
    return member;
}

void use_extension(json& root, const std::string& name) {
    json& used = root["extensionsUsed"];
    if (std::find(used.begin(), used.end(), json(name)) == used.end()) used.push_back(name);
}

json patch_gltf(GltfDocument& document, const GltfReader& reader, const SceneBefore& before,
                const Photometry& photometry, const PhotometryReport& report) {
    const Scene& scene = reader.scene;
    const bool keep = photometry.keep_lights;
    json& root = document.edit();
    if (!keep) remove_lights(root);
    const LampParts lamps = lamp_parts(scene, keep ? before.lights : 0, keep ? before.profiles : 0,
                                       [&](std::span<const uint8_t> bytes) { return add_buffer_view(root, bytes); });
    add_lights(document, root, kLights, lamps.lights);
    add_lights(document, root, kMeasured, lamps.profiles);
    std::vector<uint32_t> file_nodes = file_nodes_of(reader, report);
    std::vector<bool> of_rules(scene.nodes.size(), true);
    for (const uint32_t now : report.node_of)
        if (now != kNone) of_rules[now] = false;
    write_nodes(document, root, scene, lamps.uses, file_nodes, of_rules);
    json luminous = patch_materials(document, reader, before);
    json block = photometry_block(scene, lamps, file_nodes);
    if (scene.environment)
        block["environment"] = environment_of(root, *scene.environment, photometry.sky_picture->file);
    for (size_t i = 0; i < report.pictures.size(); ++i)
        block["luminance_pictures"].push_back(
            {{"name", photometry.pictures[report.pictures[i]].picture.name},
             {"bufferView", add_buffer_view(root, photometry.pictures[report.pictures[i]].bytes)}});
    if (!luminous.empty()) block["luminous"] = std::move(luminous);
    return block;
}

}  // namespace vesper::scene
