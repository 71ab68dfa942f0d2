// What is rendered. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "scene/scene.h"

namespace vesper::bench {

inline constexpr uint32_t kOwnLamps = ~0u;  ///< as many as a scene has

/// The scenes of a benchmark by name: "rivoli", the night street; "rivoli-measured", the same with measured lamps and
/// road; "street" and "town", generated; or a glTF file. Converted files live as long as this, in a temporary folder.
class Scenes {
public:
    Scenes();
    ~Scenes();
    Scenes(const Scenes&) = delete;
    Scenes& operator=(const Scenes&) = delete;

    /// Converts what has to be. Throws Error.
    void prepare(const std::string& name);
    /// Reads or generates one that was prepared, from its file on. `lamps`: of generated ones, how many, if
    /// kOwnLamps 256 of the street and 4,096 of the town; of others, those nearest the camera at the start of its path,
    /// all if kOwnLamps. `triangles`: of generated ones, at least; `luminaire`: likewise (street.h). Throws Error.
    scene::Scene load(const std::string& name, uint32_t lamps, uint64_t triangles, const std::string& luminaire,
                      const std::string& camera) const;

    /// An empty folder of that name beside the files.
    std::string folder(const std::string& name) const;

private:
    std::string folder_;
    std::map<std::string, std::string> files_;  // by name of the scene
};

/// Whether a scene is made here.
bool is_generated(const std::string& name);

/// Takes the light from all lamps but the `count` nearest to `eye` at the start; the first of equals stay. Throws Error
/// if there are fewer.
void keep_nearest_lamps(scene::Scene& scene, glm::vec3 eye, uint32_t count);

}  // namespace vesper::bench
