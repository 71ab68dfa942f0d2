// The options of commands that show luminance on a display. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "tone_chain.h"

namespace vesper {

/// What users write about operators, the eye and its observer.
struct ToneOptions {
    std::string tone_operator = "ward", adapt_to = "operator", ceiling = "operator", preset = "none";
    std::vector<float> gaze{0.5f, 0.5f};
    bool whole_votes = false;
    int foveal_level = 0;
    const CLI::App* command = nullptr;  ///< tells which were given
};

/// Adds them to a command. Numbers go straight to `settings`.
void add_tone_options(CLI::App& command, ToneOptions& options, ToneChainSettings& settings);
/// Takes the rest over. Throws Error.
void apply(const ToneOptions& options, ToneChainSettings& settings);
/// The size of the image that the preset wants, if it wants one and `--size` was not given.
std::string preset_size(const ToneOptions& options, const std::string& size);

}  // namespace vesper
