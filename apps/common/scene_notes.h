// What is said of a scene that was read. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/one_line.h"
#include "scene/read_scene.h"

namespace vesper::apps {

/// For who forgot to convert a scene; empty for those who did not.
inline std::string photometry_note(const scene::LoadedScene& loaded, const std::string& file) {
    return loaded.photometric ? ""
                              : one_line(file) +
                                    " has no photometry: read as plain glTF (sRGB textures, no ambient light, a black "
                                    "sky); see vesper convert --help";
}

/// That, and the notes of its reading.
inline std::vector<std::string> notes_of(const scene::LoadedScene& loaded, const std::string& file) {
    std::vector<std::string> notes = loaded.notes;
    if (!loaded.photometric) notes.push_back(photometry_note(loaded, file));
    return notes;
}

}  // namespace vesper::apps
