// Shadows of lamps, as commands take them. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "command_line.h"

#include "base/cache.h"
#include "render/renderer.h"

namespace vesper::apps {

struct ShadowArguments {
    std::string shadows = "on", cache;  ///< of the cache: a folder or off; empty: see shadow_cache()
    uint64_t budget = render::kNoShadowBudget;
};
/// --shadows, --shadow-budget and --shadow-cache. The texts say the defaults of the last two.
void add_shadow_options(
    Command, ShadowArguments&, const std::string& budget_default = "all",
    const std::string& cache_default = "VESPER_SHADOW_CACHE, or vesper/shadows in XDG_CACHE_HOME or ~/.cache");
void set_shadows(const ShadowArguments&, render::RenderSettings&);

/// Where distance maps are kept from run to run: as `asked` with --shadow-cache, else as VESPER_SHADOW_CACHE says, else
/// in the folder for caches of the user. Null with "off", or where no folder is known.
std::shared_ptr<Cache> shadow_cache(const std::string& asked);
/// Says on standard error why nothing is kept any more, if there is a reason.
void print_cache_note(const std::string& problem);

}  // namespace vesper::apps
