// Luminous flux of a scene: what is emitted, and where it goes. SPDX-License-Identifier: MIT
#include <array>

#include "arguments/cache_arguments.h"
#include "base/one_line.h"
#include "gathered_light.h"
#include "inspect.h"
#include "print.h"
#include "scene/placement.h"
#include "scene/read_scene.h"
#include "transport/flux_balance.h"

namespace vesper::commands {
namespace {

constexpr uint32_t kReflections = 32;

struct FluxRow {
    const char *text, *key;
    double lumen;
};

}  // namespace

Inspection inspect_balance(const InspectArguments& arguments) {
    const scene::Scene scene = scene::read_scene(arguments.file).scene;
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const std::vector<bool> moving = scene::animated_nodes(scene);
    const auto cache = apps::cache_of({});
    const auto radiosity = apps::gathered(scene, world, moving, cache.get());
    const transport::FluxBalance b = transport::flux_balance(scene, world, moving, *radiosity, kReflections);
    const std::array<FluxRow, 7> rows{{{"emitted by lamps", "lamps", b.lamps},
                                       {"emitted by surfaces", "emitters", b.emitters},
                                       {"emitted", "emitted", b.emitted()},
                                       {"absorbed by surfaces", "absorbed", b.absorbed},
                                       {"to the sky, directly", "sky_directly", b.sky_directly},
                                       {"to the sky, reflected", "sky_reflected", b.sky_reflected},
                                       {"absorbed, and to the sky", "found", b.found()}}};
    Inspection made;
    made.text = apps::format("%s: luminous flux at rest, without its sky; %zu cells of %.3g m\n\n",
                             one_line(arguments.file).c_str(), radiosity->cells(), radiosity->grid.size);
    for (const FluxRow& row : rows) {
        const double share = b.emitted() > 0 ? 100 * row.lumen / b.emitted() : 0;
        made.text += apps::format("  %-26s %10.4g lm   %6.1f %%\n", row.text, row.lumen, share);
        made.json["flux_lm"][row.key] = row.lumen;
    }
    return made;
}

}  // namespace vesper::commands
