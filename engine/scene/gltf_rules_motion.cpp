// Rules of glTF 2.0 for animations, skins and cameras. SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <map>

#include "scene/gltf_rules.h"
#include "scene/json_text.h"

namespace vesper {
namespace {

using nlohmann::json;

bool is_float(const json& accessor) { return whole_member(accessor, "componentType") == 5126 && !true_member(accessor, "normalized"); }

/// Whether numbers of a type are floats, or integers that are normalized.
bool is_float_or_normalized(const json& accessor) {
    const uint64_t type = whole_member(accessor, "componentType");
    return is_float(accessor) || (type >= 5120 && type <= 5123 && true_member(accessor, "normalized"));
}

/// Whether a JSON pointer of the KHR_animation_pointer extension leads somewhere: properties that are not written have their defaults.
bool leads_somewhere(const json& root, std::string_view pointer) {
    const json* at = &root;
    if (pointer.empty() || pointer[0] != '/') return false;
    while (!pointer.empty()) {
        const size_t end = std::min(pointer.find('/', 1), pointer.size());
        const std::string step = json_pointer_key(pointer.substr(1, end - 1));
        pointer.remove_prefix(end);
        if (at->is_array()) {
            size_t index = 0;
            const auto [last, wrong] = std::from_chars(step.data(), step.data() + step.size(), index);
            if (wrong != std::errc() || last != step.data() + step.size() || index >= at->size()) return false;
            at = &(*at)[index];
        } else if (at->is_object()) {
            const auto found = at->find(step);
            if (found == at->end()) return at != &root;
            at = &*found;
        } else {
            return false;
        }
    }
    return true;
}

void check_pointer(const json& root, const json& target, const std::string& at, const RuleNote& note) {
    const json& extension = object_member(object_member(target, "extensions"), "KHR_animation_pointer");
    if (extension.empty()) return;
    if (target.contains("node")) note(at + "/node", "stands beside a pointer");
    if (text_member(target, "path") != "pointer") note(at + "/path", "is not pointer, and there is one");
    if (const std::string_view pointer = text_member(extension, "pointer"); extension.contains("pointer") && !leads_somewhere(root, pointer)) note(at + "/extensions/KHR_animation_pointer/pointer", "leads nowhere");
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
        check_pointer(lists_.root(), target, at + "/target", note_);
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

/// How nodes hang on one another. They were read: each hangs on one at most, and none goes round in circles.
struct Tree {
    std::vector<uint32_t> root, place, below;  ///< of each: what it hangs on in the end, its place in order of depth, and how many follow there, itself included, that hang on it

    explicit Tree(const GltfLists& lists) : root(lists.count("nodes"), UINT32_MAX), place(root.size()), below(root.size(), 1) {
        const size_t nodes = root.size();
        std::vector<uint32_t> parents(nodes, UINT32_MAX), order, waiting;
        std::vector<std::vector<uint32_t>> children(nodes);
        lists.each("nodes", [&](const json& n, const std::string&, uint32_t parent) {
            for (const json& c : array_member(n, "children"))
                if (const uint64_t child = whole_number(c).value_or(UINT64_MAX); child < nodes) parents[child] = parent, children[parent].push_back(uint32_t(child));
        });
        for (uint32_t i = 0; i < nodes; ++i) {
            if (parents[i] != UINT32_MAX) continue;
            for (waiting.push_back(i); !waiting.empty();) {
                const uint32_t node = waiting.back();
                waiting.pop_back();
                root[node] = i, place[node] = uint32_t(order.size());
                order.push_back(node);
                waiting.insert(waiting.end(), children[node].begin(), children[node].end());
            }
        }
        for (size_t i = order.size(); i-- > 0;)
            if (parents[order[i]] != UINT32_MAX) below[parents[order[i]]] += below[order[i]];
    }
    bool hangs_on(uint32_t node, uint32_t above) const { return place[node] >= place[above] && place[node] - place[above] < below[above]; }
};

/// Skins, and the nodes that have them.
class Skins {
public:
    Skins(const GltfLists& lists, const RuleNote& note) : lists_(lists), note_(note), tree_(lists), roots_(lists.count("skins"), UINT32_MAX) {}

    void check() {
        lists_.each("skins", [&](const json& s, const std::string& at, uint32_t i) { skin(s, at, i); });
        scenes_.resize(tree_.root.size());
        lists_.each("scenes", [&](const json& scene, const std::string&, uint32_t number) {
            for (const json& node : array_member(scene, "nodes"))
                if (const uint64_t listed = whole_number(node).value_or(UINT64_MAX); listed < scenes_.size()) scenes_[listed].push_back(number);
        });
        lists_.each("nodes", [&](const json& n, const std::string& at, uint32_t i) { node(n, at, i); });
    }

private:
    void skin(const json& skin, const std::string& at, uint32_t number) {
        const json& joints = array_member(skin, "joints");
        if (const json* matrices = lists_.named(skin, "inverseBindMatrices", "accessors")) {
            if (text_member(*matrices, "type") != "MAT4" || !is_float(*matrices)) note_(at + "/inverseBindMatrices", "has an accessor of a format that it cannot have");
            if (whole_member(*matrices, "count") < joints.size()) note_(at + "/inverseBindMatrices", "has less than the " + std::to_string(joints.size()) + " matrices of its joints");
        }
        const uint64_t skeleton = whole_member(skin, "skeleton", UINT64_MAX);
        bool common = true, below = true;
        for (const json& joint : joints) {
            const uint64_t node = whole_number(joint).value_or(UINT64_MAX);
            if (node >= tree_.root.size()) continue;
            if (roots_[number] == UINT32_MAX) roots_[number] = tree_.root[node];
            common &= roots_[number] == tree_.root[node];
            below &= skeleton >= tree_.root.size() || tree_.hangs_on(uint32_t(node), uint32_t(skeleton));
        }
        if (!common) note_(at + "/joints", "hang on no common node");
        if (common && !below) note_(at + "/skeleton", "is no node that all joints hang on");
        if (!common) roots_[number] = UINT32_MAX;
    }

    // Scenes that show a mesh have the joints of its skin.
    void node(const json& node, const std::string& at, uint32_t number) {
        const uint64_t skin = whole_member(node, "skin", UINT64_MAX);
        if (skin >= roots_.size() || roots_[skin] == UINT32_MAX || !node.contains("mesh")) return;
        const uint32_t own = tree_.root[number], joints = roots_[skin];
        if (own == joints) return;
        for (const uint32_t scene : scenes_[own]) {
            if (++steps_ > kMostSteps) return;
            if (!std::binary_search(scenes_[joints].begin(), scenes_[joints].end(), scene)) return note_(at + "/skin", "has joints that are not in every scene of the node");
        }
    }

    static constexpr uint64_t kMostSteps = 1'000'000;  // scenes of nodes that are looked at

    const GltfLists& lists_;
    const RuleNote& note_;
    const Tree tree_;
    std::vector<uint32_t> roots_;                // of each skin: what all its joints hang on in the end
    std::vector<std::vector<uint32_t>> scenes_;  // that list a node, in order
    uint64_t steps_ = 0;
};

}  // namespace

void check_animations(const GltfLists& lists, const RuleNote& note) {
    lists.each("animations", [&](const json& a, const std::string& at, uint32_t) { Animation(lists, note, a, at).check(); });
}

void check_skins(const GltfLists& lists, const RuleNote& note) {
    if (lists.count("skins") > 0) Skins(lists, note).check();
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
