// Nodes whose names say that they are lamps. SPDX-License-Identifier: MIT
#include "scene/template_candidates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/budget.h"
#include "scene/apply_rules.h"
#include "scene/template_patterns.h"

namespace vesper::scene {
namespace {

using Words = std::vector<std::string>;

constexpr double kWidest = 3, kWidestNamed = 8;  // m, of one lamp with its arms; of one whose name says lamp
constexpr double kLongestVehicle = 20;           // m
constexpr double kHighest = 15;                  // m, of one lamp with its pole
constexpr double kBeside = 1;                    // m: a part and its lamp stand in one such square or in the next one

/// Parts of a lamp that do not shine, or are told by another part.
constexpr std::string_view kPassive[] = {"pole",   "post",  "mast",    "base",   "foot",  "arm",    "bracket", "mount",
                                         "socket", "cable", "housing", "holder", "frame", "stand",  "box",     "glass",
                                         "cover",  "shade", "lens",    "metal",  "chain", "switch", "collider"};
/// Things that carry lamps.
constexpr std::string_view kPoles[] = {"pole",   "poles", "post",  "mast",   "column",
                                       "pillar", "pylon", "pfahl", "pfosten"};

bool is_in(std::span<const std::string_view> known, const std::string& word) {
    return std::ranges::find(known, word) != known.end();
}
bool has_one_of(const Words& words, std::span<const std::string_view> wanted) {
    return std::ranges::any_of(words, [&](const std::string& word) { return is_in(wanted, word); });
}

/// The words of a name that another does not have, as a name.
std::string added_words(const Words& words, const Words& known) {
    std::string added;
    for (const std::string& word : words)
        if (std::ranges::find(known, word) == known.end()) added += word + " ";
    return added;
}

/// Whether the words of a name are those of the name above, of any lamp and of parts of lamps.
bool says_no_more(const Words& words, const Words& above) {
    return std::ranges::all_of(words, [&](const std::string& word) {
        return sounds_like_light(word) || is_in(kPassive, word) || std::ranges::find(above, word) != above.end();
    });
}

bool is_plain(std::span<const Words> parts) { return &kind_of(parts) == &plain_lamp(); }

/// Lamps that shine, by parent, first word and place, to find those beside a part.
class Standing {
public:
    void add(uint32_t parent, const std::string& word, glm::dvec3 at) {
        words_.insert({parent, word});
        squares_.insert({parent, word, square(at.x), square(at.z)});
    }
    bool any(uint32_t parent, const std::string& word) const { return words_.contains({parent, word}); }
    bool any_beside(uint32_t parent, const std::string& word, glm::dvec3 at) const {
        for (const double x : {-1.0, 0.0, 1.0})
            for (const double z : {-1.0, 0.0, 1.0})
                if (squares_.contains({parent, word, square(at.x) + x, square(at.z) + z})) return true;
        return false;
    }

private:
    static double square(double m) { return std::isfinite(m) ? std::floor(m / kBeside) : 0; }
    std::set<std::pair<uint32_t, std::string>> words_;
    std::set<std::tuple<uint32_t, std::string, double, double>> squares_;
};

}  // namespace

LampCandidates::LampCandidates(const Scene& scene, const SceneSource& source, const LampPlaces& places)
    : scene_(scene),
      sounding_(scene.nodes.size()),
      covered_(scene.nodes.size()),
      extent_(scene.nodes.size()),
      lamps_(scene.nodes.size()) {
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        check_time();
        if (marked(source.added, i)) continue;
        sounding_[i] = sounds_like_light(scene.nodes[i].name) || is_signal_colour(parts(i, 1)) ||
                       is_vehicle_lamp(parts_of(scene.nodes[i].name)[0]);
    }
    measure(places);
    find_holders();
    drop_other_parts(places);
    count_lamps();
}

std::vector<Words> LampCandidates::parts(uint32_t i, size_t most_above) const {
    std::vector<Words> all;
    for (size_t level = 0; i != kNone && level <= most_above; ++level, i = scene_.nodes[i].parent)
        for (Words& words : parts_of(scene_.nodes[i].name)) all.push_back(std::move(words));
    return all;
}

bool LampCandidates::has_light(uint32_t i) const {
    const uint32_t lamp = scene_.nodes[i].lamp;
    return lamp != kNone && scene_.lamps[lamp].kind != Lamp::Kind::Directional;
}

void LampCandidates::measure(const LampPlaces& places) {
    for (auto i = static_cast<uint32_t>(scene_.nodes.size()); i-- > 0;) {
        const Bounds& meshes = places.below(i);
        if (!meshes.empty()) extent_[i].add(meshes.low), extent_[i].add(meshes.high);
        const uint32_t parent = scene_.nodes[i].parent;
        if (parent == kNone) continue;
        if (!extent_[i].empty()) extent_[parent].add(extent_[i].low), extent_[parent].add(extent_[i].high);
        if (meshes.empty() && (sounding_[i] || has_light(i))) extent_[parent].add(glm::vec3(places.middle(i)));
    }
}

bool LampCandidates::fits(uint32_t node, double width) const {
    if (extent_[node].empty()) return true;
    const glm::dvec3 size = glm::dvec3(extent_[node].high) - glm::dvec3(extent_[node].low);
    return std::max(size.x, size.z) <= width && size.y <= kHighest;
}

void LampCandidates::drop(uint32_t i) {
    sounding_[i] = false;
    if (!has_light(i)) ++left_out_;
}

/// Chooses between nodes named as lamps and the nearest such ones above them.
void LampCandidates::find_holders() {
    const std::vector<Node>& nodes = scene_.nodes;
    std::map<std::pair<uint32_t, std::string>, size_t> alike;  // nodes of a family below each parent
    for (uint32_t i = 0; i < nodes.size(); ++i)
        if (sounding_[i]) ++alike[{nodes[i].parent, family_of(nodes[i].name)}];
    std::vector<uint32_t> above(nodes.size(), kNone);
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        check_time();
        const uint32_t parent = nodes[i].parent;
        if (parent != kNone) above[i] = sounding_[parent] ? parent : above[parent];
        const uint32_t holder = above[i];
        if (!sounding_[i] || holder == kNone) continue;
        const std::string added = added_words(parts_of(nodes[i].name)[0], parts_of(nodes[holder].name)[0]);
        const bool copy = added.empty() && alike[{parent, family_of(nodes[i].name)}] > 1;
        if (copy || !fits(holder, kWidestNamed) || sounds_like_light(added) || is_signal_colour(parts(i, 1)))
            covered_[holder] = true;
        else
            drop(i);  // "street_lamp_01/street_lamp_01_mesh" says nothing that the node above does not
    }
}

/// Where lamps below a node have kinds, "lamps" beside them is their glass; beside "lamp_head", so is "lamp_pole".
/// Below "street_lamp_01", a mesh is the body of the "light" that has none. The node above is one lamp, or a vehicle;
/// elsewhere "lamp_shade" is a part of the "lamp" that it stands at.
void LampCandidates::drop_other_parts(const LampPlaces& places) {
    std::set<uint32_t> known, of_vehicles, meshless;
    Standing standing;
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < sounding_.size(); ++i) {
        check_time();
        if (!has(i)) continue;
        found.push_back(i);
        const auto own = parts_of(scene_.nodes[i].name);
        const uint32_t parent = scene_.nodes[i].parent;
        const SourceKind& kind = kind_of(std::span(own).first(1));
        if (&kind != &plain_lamp()) (kind.of_vehicle ? of_vehicles : known).insert(parent);
        if (scene_.nodes[i].mesh == kNone) meshless.insert(parent);
        if (!own[0].empty() && !has_one_of(own[0], kPassive)) standing.add(parent, own[0][0], places.middle(i));
    }
    for (const uint32_t i : found) {
        check_time();
        const auto all = parts(i, 0);
        const Words& own = all[0];
        const uint32_t parent = scene_.nodes[i].parent;
        const bool below = parent != kNone, mesh = below && scene_.nodes[i].mesh != kNone;
        const bool one = below && fits(parent, covered_[parent] ? kWidestNamed : kWidest);
        const bool kinds = mesh && ((one && known.contains(parent)) ||
                                    (of_vehicles.contains(parent) && fits(parent, kLongestVehicle)));
        const bool glass = kinds && is_plain(all) && says_no_more(own, parts_of(scene_.nodes[parent].name)[0]);
        const bool body = mesh && one && covered_[parent] && meshless.contains(parent);
        const bool passive = has_one_of(own, kPassive);
        const bool beside = passive && is_plain(all) && standing.any_beside(parent, own[0], places.middle(i));
        if (glass || body || beside || (passive && one && standing.any(parent, own[0]))) drop(i);
    }
}

void LampCandidates::count_lamps() {
    for (auto i = static_cast<uint32_t>(scene_.nodes.size()); i-- > 0;)
        if (const uint32_t parent = scene_.nodes[i].parent; parent != kNone)
            lamps_[parent] += lamps_[i] + (has(i) || has_light(i) ? 1 : 0);
}

bool LampCandidates::is_foot(uint32_t node) const {
    if (node == kNone) return false;
    const std::string& name = scene_.nodes[node].name;
    const bool tells = lamps_[node] == 1 || sounds_like_light(name) || has_one_of(parts_of(name)[0], kPoles);
    return tells && fits(node, kWidestNamed);
}

}  // namespace vesper::scene
