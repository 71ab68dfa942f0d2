#include "scene/obstacles.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/one_line.h"
#include "scene/fixtures.h"
#include "scene/photometry.h"

namespace vesper::scene {
namespace {

Bounds bounds_of(const Mesh& mesh) {
    Bounds all;
    for (const Primitive& primitive : mesh.primitives)
        if (!primitive.bounds.empty()) all.add(primitive.bounds.low), all.add(primitive.bounds.high);
    return all;
}

}  // namespace

std::vector<Obstacle> find_obstacles(const Scene& scene, const std::vector<std::string>& patterns,
                                     const std::string& place) {
    const std::vector<bool> has_surfaces = nodes_above_meshes(scene);
    std::vector<bool> matches(scene.nodes.size());
    for (const std::string& pattern : patterns) {
        bool any = false;
        for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
            if (!has_surfaces[i] || !matches_node(pattern, scene, i)) continue;
            matches[i] = any = true;
        }
        if (!any) throw Error(place + " " + one_line(pattern) + ": no node of the scene that has surfaces matches it");
    }
    std::vector<uint32_t> owner(scene.nodes.size(), kNone);  // the nearest match, at or above
    std::map<uint32_t, Obstacle> found;                      // by node
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        owner[i] = matches[i] ? i : node.parent == kNone ? kNone : owner[node.parent];
        if (owner[i] == kNone || node.mesh == kNone) continue;
        const Bounds bounds = bounds_of(scene.meshes[node.mesh]);
        if (!bounds.empty()) found[owner[i]].parts.push_back({i, bounds});
    }
    if (found.size() > kMostObstacles)
        throw Error(place + ": " + std::to_string(found.size()) + " nodes match, and at most " +
                    std::to_string(kMostObstacles) + " can be watched");
    std::vector<Obstacle> obstacles;
    std::map<std::string, unsigned> named;
    for (auto& [node, obstacle] : found) {
        const std::string& name = scene.nodes[node].name;
        const unsigned number = ++named[name];
        obstacle.name = number == 1 ? name : name + "#" + std::to_string(number);
        obstacles.push_back(std::move(obstacle));
    }
    return obstacles;
}

}  // namespace vesper::scene
