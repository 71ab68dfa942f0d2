// Edges of surfaces and samples of pixels, as commands take them. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "command_line.h"

#include "io/image_file.h"
#include "render/renderer.h"

namespace vesper::apps {

struct EdgeArguments {
    std::string anti_aliasing = "on";
    uint32_t samples = 1;
};
/// --anti-aliasing and --samples.
void add_edge_options(Command, EdgeArguments&);
void set_edges(const EdgeArguments&, render::RenderSettings&);
/// What a picture's header should say of them.
io::Header describe_edges(const render::RenderSettings&);

}  // namespace vesper::apps
