// Parts of the photometry file's reader. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "scene/json_value.h"
#include "scene/photometry.h"

namespace vesper::scene {

/// colour_temperature_K or colour_rgb, brought to luminance 1; white where neither is given.
glm::dvec3 read_colour(const JsonValue& holder, double* kelvin = nullptr);

/// Refuses members of a rule, or of the file, other than these and "comment", a text that nothing reads.
void allow_in_rule(const JsonValue& rule, std::vector<const char*> keys);

/// One pattern or several, none empty.
std::vector<std::string> read_patterns(const JsonValue& rule, const char* key);

/// A rule of "emitters", after the lamps were read. Files are relative to `folder`.
EmitterRule read_emitter(const JsonValue& source, const std::filesystem::path& folder, Photometry& made);

/// "sky" with an "image", relative to `folder`.
SkyPicture read_sky_picture(const JsonValue& source, const std::filesystem::path& folder);
DirectionalRule read_directional(const JsonValue& source);

/// "retroreflection" of a surface; and in full, as a converted file has it.
photometry::Retroreflector read_retroreflection(const JsonValue& source);
nlohmann::json json_of(const photometry::Retroreflector&);
photometry::Retroreflector read_whole_retroreflector(const JsonValue& source);

/// What a photometry file that says nothing of ambient light and sky means: a clear night over a big city, 0.02 cd/m^2
/// (0.018 to 0.024 measured over London), and 0.1 lx of sky glow and facades (0.1 to 1 lx in towns).
Photometry with_night_sky(Photometry);

}  // namespace vesper::scene
