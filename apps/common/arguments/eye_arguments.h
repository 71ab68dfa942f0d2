// The options of the eye that looks: operator, observer, what it adapts to. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "arguments/command_line.h"

#include "render/tone_chain.h"

namespace vesper::apps {

/// Part of ToneArguments.
struct EyeArguments {
    std::string tone_operator = "irawan", adapt_to = "operator", ceiling = "operator", preset = "none";
    std::vector<float> gaze{0.5f, 0.5f};
    bool whole_votes = false;
    int foveal_level = 0;
    Command command;  ///< tells which were given
};

/// Adds them to a command. Numbers of the observer and the histogram go straight to the settings.
void add_eye_options(Command command, EyeArguments& arguments, render::HistogramSettings& histogram,
                     render::ToneSettings& tone);
/// Takes the rest over.
void apply(const EyeArguments& arguments, render::ToneChainSettings& settings);

}  // namespace vesper::apps
