// What `vesper render` says of its pictures: in their headers and in its statistics. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "io/image_file.h"
#include "render_arguments.h"

namespace vesper::commands {

/// The settings of light, as asked for.
apps::RecordedSettings recorded_of(const RenderArguments& arguments);

/// The header of a picture of luminances.
io::Header describe_frame(const RenderArguments& arguments, const gpu::Device& device, const gpu_scene::View& view,
                          const render::Frame& frame, const vision::GlareReport& glare, double seconds);

/// Of --stats-json.
std::string statistics_json(const RenderArguments& arguments, const render::Frame& frame);
/// Of --stats; `milliseconds`: of each frame, on the host's clock.
void print_statistics(const RenderArguments& arguments, const gpu::Device& device, const render::Renderer& renderer,
                      const render::Frame& frame, std::vector<double> milliseconds);

}  // namespace vesper::commands
