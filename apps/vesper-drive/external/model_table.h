// Which meshes and lamps the objects of other programs have (docs/osi.md). SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traffic/world_file.h"

namespace vesper::drive {

struct Model {
    std::string place;                        ///< of its entry: file and JSON pointer
    std::string reference;                    ///< what model_reference is; * stands for any characters
    std::filesystem::path scene, photometry;  ///< a glTF file; applied to it when it is loaded, or empty
    double turn = 0;                          ///< rad about +Y from the front of the model to -Z
    size_t places = 4;                        ///< so many at once
    traffic::LampRoles roles;

    bool is_meant_by(const std::string& model_reference) const;
};

/// Throws Error, naming file, place and reason.
std::vector<Model> read_models(const std::filesystem::path&);

}  // namespace vesper::drive
