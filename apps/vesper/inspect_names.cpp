// The names in a scene, which rules of photometry go by. SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include "base/one_line.h"
#include "inspect.h"
#include "print.h"

namespace vesper::commands {
namespace {

constexpr size_t kMostPrinted = 30, kMostWritten = 10'000;  // names, of each kind

using Names = std::map<std::string, size_t>;  // and how many have it

template <class Things>
Names names_of(const Things& things) {
    Names names;
    for (const auto& thing : things)
        if (!thing.name.empty()) ++names[thing.name];
    return names;
}

std::string text_of(const char* kind, const Names& names, size_t number) {
    std::string text = apps::format("%s: %zu, of %zu names", kind, number, names.size());
    size_t printed = 0;
    for (const auto& [name, times] : names) {
        if (printed == kMostPrinted) break;
        text += (printed++ ? ", " : ": ") + one_line(name, 60);
        if (times > 1) text += apps::format(" (%zu)", times);
    }
    if (names.size() > printed)
        text += apps::format(", ... and %zu more (--json has the first %zu)", names.size() - printed,
                             std::min(names.size(), kMostWritten));
    return text + "\n";
}

nlohmann::ordered_json json_of(const Names& names) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& [name, times] : names) {
        if (list.size() == kMostWritten) break;
        list.push_back({{"name", name}, {"number", times}});
    }
    return list;
}

}  // namespace

Inspection inspect_names(const scene::Scene& scene) {
    const Names nodes = names_of(scene.nodes), materials = names_of(scene.materials), pictures = names_of(scene.images);
    size_t left_out = 0;
    for (const Names* each : {&nodes, &materials, &pictures})
        left_out += each->size() - std::min(each->size(), kMostWritten);
    return {"\n" + text_of("nodes", nodes, scene.nodes.size()) +
                text_of("materials", materials, scene.materials.size()) +
                text_of("pictures", pictures, scene.images.size()),
            {{"nodes", json_of(nodes)},
             {"materials", json_of(materials)},
             {"pictures", json_of(pictures)},
             {"left_out", left_out}}};
}

}  // namespace vesper::commands
