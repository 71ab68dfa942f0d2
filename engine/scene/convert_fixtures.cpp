// The nodes that photometry rules name as fixtures of lamps. SPDX-License-Identifier: MIT
#include <algorithm>

#include "base/error.h"
#include "scene/convert_rules.h"
#include "scene/fixtures.h"

namespace vesper::scene {
namespace {

/// Which nodes of the file match the pattern, of those that the scene shows. `parents` may end before the nodes that
/// the conversion has added.
std::vector<bool> matching_nodes(const Conversion& conversion, const std::string& pattern,
                                 const std::vector<uint32_t>& parents) {
    const size_t depth = static_cast<size_t>(std::count(pattern.begin(), pattern.end(), '/')) + 1;
    const auto nodes = conversion.document.list("nodes");
    std::vector<bool> matching(parents.size());
    for (uint32_t i = 0; i < parents.size(); ++i)
        matching[i] =
            conversion.original.node_of[i] != kNone && matches_path(pattern, path_of(nodes, parents, i, depth));
    return matching;
}

void warn_of_empty(Conversion& conversion, const LampRule& rule, const std::vector<uint32_t>& fixtures) {
    const Scene& scene = conversion.original.scene;
    const std::vector<bool> has_mesh = nodes_above_meshes(scene);
    for (const uint32_t fixture : fixtures) {
        if (fixture == kNone || has_mesh[conversion.original.node_of[fixture]]) continue;
        conversion.report.warnings.push_back("lamp " + in_quotes(rule.name) + ": its fixture, node " +
                                             in_quotes(scene.nodes[conversion.original.node_of[fixture]].name) +
                                             ", has no meshes: every mesh hides the lamp");
        return;
    }
}

}  // namespace

std::vector<std::string> path_of(std::span<const JsonValue> nodes, const std::vector<uint32_t>& parents, uint32_t node,
                                 size_t depth) {
    std::vector<std::string> path;
    for (; node != kNone && path.size() < depth; node = parents[node]) path.push_back(nodes[node].text_or("name", ""));
    return path;
}

std::vector<uint32_t> named_fixtures(Conversion& conversion, const LampRule& rule, std::span<const uint32_t> nodes,
                                     const std::vector<uint32_t>& parents) {
    const std::vector<bool> matching = matching_nodes(conversion, rule.fixture, parents);
    const auto found = std::count(matching.begin(), matching.end(), true);
    const std::string place = rule.fixture_place + ": ";
    if (found == 0) throw Error(place + "no node of the scene matches " + in_quotes(rule.fixture));
    const auto first = static_cast<uint32_t>(std::find(matching.begin(), matching.end(), true) - matching.begin());
    std::vector<uint32_t> fixtures;
    for (const uint32_t node : nodes) {
        fixtures.push_back(kNone);
        const uint32_t shown = conversion.original.node_of[node];
        if (shown == kNone) continue;
        uint32_t above = node;
        while (above != kNone && !matching[above]) above = parents[above];
        if (above == kNone && found > 1)
            throw Error(place + in_quotes(rule.fixture) + " matches " + std::to_string(found) +
                        " nodes, and none of them is node " + in_quotes(conversion.original.scene.nodes[shown].name) +
                        " of the lamp or above it");
        fixtures.back() = above == kNone ? first : above;
    }
    warn_of_empty(conversion, rule, fixtures);
    return fixtures;
}

}  // namespace vesper::scene
