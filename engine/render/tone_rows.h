// The settings between the light of a frame and its codes: a row each. SPDX-License-Identifier: MIT
//
// From a row come the command-line option, the setting of vesper-drive and its switch there, the word of
// VesperToneSettings::options in C, the fields of pictures, and the table in docs/tone-settings.md. Its default is that
// of the member that it sets. The gaze, a place, and the display, a file, are not in the table.
#pragma once

#include <span>
#include <string_view>

#include "render/setting.h"
#include "render/tone_chain.h"

namespace vesper::render {

using ToneRow = SettingOf<ToneChainSettings>;

/// All rows, in the order of the stages: those of the operators behind those of the curve.
std::span<const ToneRow> tone_rows();
/// By its name, with dashes or underscores. Throws Error if there is none.
const ToneRow& tone_row(std::string_view name);

/// Throws Error where settings, each in its range, contradict each other.
void check_tone(const ToneChainSettings&);

}  // namespace vesper::render
