// Luminous flux of a scene: what is emitted, and where it goes. SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include "arguments/cache_arguments.h"
#include "base/one_line.h"
#include "gathered_light.h"
#include "inspect.h"
#include "print.h"
#include "scene/placement.h"
#include "scene/read_scene.h"
#include "transport/flux_balance.h"
#include "transport/path_check.h"

namespace vesper::commands {
namespace {

constexpr uint32_t kReflections = 32;
constexpr double kRight = 0.05;  // of the light: more is said to be lost or gained, if it is three standard errors

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
    const transport::PathCheck check = transport::check_by_paths(scene, world, moving, *radiosity, kReflections);
    made.text += apps::format(
        "\nLight between surfaces, with the sky, mean of %u places:\n"
        "  %-26s %10.4g lx\n  %-26s %10.4g lx\n  %-26s %10.1f %%, std. error %.1f %%\n",
        check.places, "of cells", check.cells, "of paths of rays", check.paths, "of cells, to that of paths",
        100 * check.ratio(), 100 * check.error);
    const double off = check.ratio() - 1;
    if (check.paths > 0 && std::abs(off) > kRight && std::abs(off) > 3 * check.error)
        made.text += apps::format("  This scene %s %.0f %% of that light; --paths of vesper render does not.\n",
                                  off < 0 ? "loses" : "gains", 100 * std::abs(off));
    made.json["light_between_surfaces"] = {{"places", check.places},
                                           {"cells_lx", check.cells},
                                           {"paths_lx", check.paths},
                                           {"ratio", check.ratio()},
                                           {"standard_error", check.error}};
    return made;
}

}  // namespace vesper::commands
