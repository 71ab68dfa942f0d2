// What frames may leave out, as commands take it. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// What is recorded of a frame: the set, and the bounds that held, as the options take them.
struct RecordedQuality {
    std::string name = "standard";
    double threshold = 0, merge_error = 0, shadow_error = 0, reflections_left_out = 0;  ///< the first in lx
    /// Whether the bounds, as RenderSettings holds them, are equal.
    bool bounds_equal(const RecordedQuality&) const;
};
RecordedQuality recorded_quality(const QualityArguments&, const render::RenderSettings&);
/// Of the defaults.
RecordedQuality recorded_standard();

/// Names, as statistics have them, and texts. Numbers read back to the last bit of a float.
std::vector<std::pair<std::string, std::string>> quality_texts(const RecordedQuality&);
/// The same as members of a JSON object, in a line.
std::string quality_json(const RecordedQuality&);
/// The same for people: "standard (0.001 lx, merge error 0.001, shadow error 0.005, reflections 0.002)".
std::string quality_words(const RecordedQuality&);
/// The same for a picture's header.
io::Header describe_quality(const RecordedQuality&);

}  // namespace vesper::apps
