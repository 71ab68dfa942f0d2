// Light by way of surfaces, as commands take it. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "command_line.h"

#include "base/cache.h"
#include "render/renderer.h"
#include "transport/radiosity.h"

namespace vesper::apps {

struct IndirectArguments {
    std::string indirect = "cached", moving = "off";
    uint32_t reflections = 100;
};
/// --indirect, --reflections and --moving-reflections. `exact`: whether light may be traced for each pixel, too.
void add_indirect_options(Command, IndirectArguments&, bool exact = false);
void set_indirect(const IndirectArguments&, render::RenderSettings&);

/// What surfaces at rest of a scene send each other: from the cache (null: none), or gathered, which it then keeps.
/// Shows its progress, and says if the cache fails.
std::shared_ptr<const transport::Radiosity> gathered(const scene::Scene&, std::span<const glm::dmat4> world,
                                                     const std::vector<bool>& moving, Cache* cache);
/// Gives a renderer what these settings want of it: that, and what surfaces at rest reflect of lamps that move.
void give_indirect(render::Renderer&, const render::RenderSettings&, const scene::Scene&,
                   std::span<const glm::dmat4> world, const std::vector<bool>& moving, Cache* cache);

}  // namespace vesper::apps
