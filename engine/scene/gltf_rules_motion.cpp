// Rules of glTF 2.0 for animations, skins and cameras. SPDX-License-Identifier: MIT
#include <map>
#include <set>

#include "scene/gltf_rules.h"

namespace vesper {
namespace {

using nlohmann::json;

bool is_float(const json& accessor) { return whole_member(accessor, "componentType") == 5126 && !true_member(accessor, "normalized"); }

/// Whether numbers of a type are floats, or integers that are normalized.
bool is_float_or_normalized(const json& accessor) {
    const uint64_t type = whole_member(accessor, "componentType");
    return is_float(accessor) || (type >= 5120 && type <= 5123 && true_member(accessor, "normalized"));
}

class Animation {
public:
    Animation(const GltfLists& lists, const RuleNote& note, const json& animation, const std::string& at) : lists_(lists), note_(note), animation_(animation), at_(at) {}

    void check() {
        GltfLists::each_of(array_member(animation_, "samplers"), at_ + "/samplers", [&](const json& s, const std::string& at, uint32_t) { input(s, at); });
        GltfLists::each_of(array_member(animation_, "channels"), at_ + "/channels", [&](const json& c, const std::string& at, uint32_t i) { channel(c, at, i); });
    }

private:
    void input(const json& sampler, const std::string& at) {
        const json* times = lists_.named(sampler, "input", "accessors");
        if (!times) return;
        if (text_member(*times, "type") != "SCALAR" || !is_float(*times)) note_(at + "/input", "has an accessor of a format that it cannot have");
        if (!times->contains("min") || !times->contains("max")) note_(at + "/input", "has an accessor without min and max");
        if (text_member(sampler, "interpolation") == "CUBICSPLINE" && whole_member(*times, "count") < 2) note_(at + "/input", "has less than the two keys of a spline");
    }

    void channel(const json& channel, const std::string& at, uint32_t number) {
        const json& samplers = array_member(animation_, "samplers");
        const uint64_t sampler = whole_member(channel, "sampler", UINT64_MAX);
        if (channel.contains("sampler") && sampler >= samplers.size()) return note_(at + "/sampler", "names none of the " + std::to_string(samplers.size()) + " samplers");
        const json& target = object_member(channel, "target");
        const std::string_view path = text_member(target, "path");
        const json* node = lists_.named(target, "node", "nodes");
        if (!node || path.empty()) return;
        if (const auto [first, added] = moved_.try_emplace({whole_member(target, "node"), std::string(path)}, number); !added)
            note_(at + "/target", "moves what channel " + std::to_string(first->second) + " moves");
        if (path != "weights" && path != "translation" && path != "rotation" && path != "scale") return;  // of extensions
        uint64_t targets = 1;
        if (path == "weights") {
            const json* mesh = lists_.named(*node, "mesh", "meshes");
            const json& primitives = mesh ? array_member(*mesh, "primitives") : array_member(*node, "");
            targets = !primitives.empty() && primitives[0].is_object() ? array_member(primitives[0], "targets").size() : 0;
            if (targets == 0) note_(at + "/target", "moves weights of a mesh without morph targets");
        } else if (node->contains("matrix")) {
            note_(at + "/target", "moves a node that has a matrix");
        }
        if (sampler < samplers.size() && samplers[sampler].is_object()) output(samplers[sampler], path, targets, at_ + "/samplers/" + std::to_string(sampler) + "/output");
    }

    void output(const json& sampler, std::string_view path, uint64_t targets, const std::string& at) {
        const json *times = lists_.named(sampler, "input", "accessors"), *values = lists_.named(sampler, "output", "accessors");
        if (!times || !values) return;
        const std::string_view type = path == "weights" ? "SCALAR" : path == "rotation" ? "VEC4" : "VEC3";
        const bool integers = path == "weights" || path == "rotation";
        if (text_member(*values, "type") != type || !(integers ? is_float_or_normalized(*values) : is_float(*values))) note_(at, "has an accessor of a format that it cannot have");
        const uint64_t keys = whole_member(*times, "count"), wanted = keys * targets * (text_member(sampler, "interpolation") == "CUBICSPLINE" ? 3 : 1);
        if (keys < UINT32_MAX && targets > 0 && whole_member(*values, "count") != wanted) note_(at, "has not the " + std::to_string(wanted) + " values of its keys");
    }

    const GltfLists& lists_;
    const RuleNote& note_;
    const json& animation_;
    const std::string& at_;
    std::map<std::pair<uint64_t, std::string>, uint32_t> moved_;
};

/// The node that each hangs on in the end. Nodes were read, so none goes round in circles.
std::vector<uint32_t> roots_of(const GltfLists& lists) {
    const size_t nodes = lists.count("nodes");
    std::vector<uint32_t> parents(nodes, UINT32_MAX), roots(nodes, UINT32_MAX), way;
    lists.each("nodes", [&](const json& n, const std::string&, uint32_t parent) {
        for (const json& c : array_member(n, "children"))
            if (const uint64_t child = whole_number(c).value_or(UINT64_MAX); child < nodes && child != parent) parents[child] = parent;
    });
    for (uint32_t i = 0; i < nodes; ++i) {
        way.clear();
        uint32_t at = i;
        for (; roots[at] == UINT32_MAX && parents[at] != UINT32_MAX && way.size() <= nodes; at = parents[at]) way.push_back(at);
        const uint32_t root = roots[at] == UINT32_MAX ? at : roots[at];
        roots[at] = root;
        for (const uint32_t node : way) roots[node] = root;
    }
    return roots;
}

}  // namespace

void check_animations(const GltfLists& lists, const RuleNote& note) {
    lists.each("animations", [&](const json& a, const std::string& at, uint32_t) { Animation(lists, note, a, at).check(); });
}

void check_skins(const GltfLists& lists, const RuleNote& note) {
    if (lists.count("skins") == 0) return;
    const std::vector<uint32_t> roots = roots_of(lists);
    lists.each("skins", [&](const json& skin, const std::string& at, uint32_t) {
        const json& joints = array_member(skin, "joints");
        if (const json* matrices = lists.named(skin, "inverseBindMatrices", "accessors")) {
            if (text_member(*matrices, "type") != "MAT4" || !is_float(*matrices)) note(at + "/inverseBindMatrices", "has an accessor of a format that it cannot have");
            if (whole_member(*matrices, "count") < joints.size()) note(at + "/inverseBindMatrices", "has less than the " + std::to_string(joints.size()) + " matrices of its joints");
        }
        std::set<uint32_t> found;
        for (const json& joint : joints)
            if (const uint64_t node = whole_number(joint).value_or(UINT64_MAX); node < roots.size()) found.insert(roots[node]);
        if (const uint64_t node = whole_member(skin, "skeleton", UINT64_MAX); node < roots.size()) found.insert(roots[node]);
        if (found.size() > 1) note(at + "/joints", "hang on no common node");
    });
}

void check_cameras(const GltfLists& lists, const RuleNote& note) {
    lists.each("cameras", [&](const json& camera, const std::string& at, uint32_t) {
        if (camera.contains("perspective") && camera.contains("orthographic")) note(at, "is both perspective and orthographic");
        if (const std::string type(text_member(camera, "type")); (type == "perspective" || type == "orthographic") && !camera.contains(type)) note(at, "has no " + type + " to its type");
        for (const char* kind : {"perspective", "orthographic"}) {
            const json& lens = object_member(camera, kind);
            const std::string place = at + "/" + kind;
            const auto near = number_member(lens, "znear"), far = number_member(lens, "zfar");
            if (near && far && *far <= *near) note(place + "/zfar", "is not beyond znear");
            for (const char* width : {"xmag", "ymag"})
                if (number_member(lens, width) == 0.0) note(place + "/" + width, "is zero");
        }
    });
}

}  // namespace vesper
