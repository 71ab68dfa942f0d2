// What frames may leave out, as commands take it. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "command_line.h"

#include "io/image_file.h"
#include "render/quality.h"

namespace vesper::apps {

struct QualityArguments {
    std::string quality = "standard";  ///< of render::qualities()
    std::optional<float> threshold, merge_error, shadow_error;
};
void add_quality_option(Command, QualityArguments&);
/// --threshold, --merge-error and --shadow-error, each of which wins over the set.
void add_bound_options(Command, QualityArguments&);
/// To be called before other bounds are set, such as set_shadows().
void set_quality(const QualityArguments&, render::RenderSettings&);
/// What a picture's header should say of it.
io::Header describe_quality(const QualityArguments&);

}  // namespace vesper::apps
