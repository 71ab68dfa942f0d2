// The nodes that photometry rules name as fixtures of lamps. SPDX-License-Identifier: MIT
#include <algorithm>

#include "base/error.h"
#include "scene/apply_rules.h"
#include "scene/fixtures.h"

namespace vesper::scene {
namespace {

/// Which nodes match the pattern, of those that the scene had before.
std::vector<bool> matching_nodes(const Application& application, const std::string& pattern) {
    std::vector<bool> matching(application.nodes);
    for (uint32_t i = 0; i < application.nodes; ++i)
        matching[i] = !application.is_added(i) && matches_node(pattern, application.scene, i);
    return matching;
}

void warn_of_empty(Application& application, const LampRule& rule, const std::vector<uint32_t>& fixtures) {
    const Scene& scene = application.scene;
    const std::vector<bool> has_mesh = nodes_above_meshes(scene);
    for (const uint32_t fixture : fixtures) {
        if (has_mesh[fixture]) continue;
        application.report.warnings.push_back("lamp " + in_quotes(rule.name) + ": its fixture, node " +
                                              in_quotes(scene.nodes[fixture].name) +
                                              ", has no meshes: every mesh hides the lamp");
        return;
    }
}

}  // namespace

std::vector<std::string> path_of(const Scene& scene, uint32_t node, size_t depth) {
    std::vector<std::string> path;
    for (; node != kNone && path.size() < depth; node = scene.nodes[node].parent)
        path.push_back(scene.nodes[node].name);
    return path;
}

std::vector<uint32_t> named_fixtures(Application& application, const LampRule& rule,
                                     const std::vector<uint32_t>& nodes) {
    const Scene& scene = application.scene;
    const std::vector<bool> matching = matching_nodes(application, rule.fixture);
    const auto found = std::count(matching.begin(), matching.end(), true);
    const std::string place = rule.fixture_place + ": ";
    if (found == 0) throw Error(place + "no node of the scene matches " + in_quotes(rule.fixture));
    const auto first = static_cast<uint32_t>(std::find(matching.begin(), matching.end(), true) - matching.begin());
    std::vector<uint32_t> fixtures;
    for (const uint32_t node : nodes) {
        uint32_t above = node;
        while (above != kNone && !matching[above]) above = scene.nodes[above].parent;
        if (above == kNone && found > 1)
            throw Error(place + in_quotes(rule.fixture) + " matches " + std::to_string(found) +
                        " nodes, and none of them is node " + in_quotes(scene.nodes[node].name) +
                        " of the lamp or above it");
        fixtures.push_back(above == kNone ? first : above);
    }
    warn_of_empty(application, rule, fixtures);
    return fixtures;
}

}  // namespace vesper::scene
