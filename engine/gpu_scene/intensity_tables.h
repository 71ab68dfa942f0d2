// Measured intensities and road surfaces, laid out for the shaders (shared/tables.h). SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "photometry/distribution.h"
#include "photometry/reflection_table.h"

namespace vesper::scene {
struct Scene;
}

namespace vesper::gpu_scene {

/// Every table of a scene, in one buffer of texels. Tables are shared: a thousand lamps of one make need one.
struct IntensityTables {
    struct Intensities {
        float largest = 0;  ///< cd, what the values are relative to
        photometry::Goniometry goniometry = photometry::Goniometry::CGamma;
        uint32_t first = 0;   ///< texel of the first cell; shared::kWindowTexels before it are those of its windows
        glm::uvec2 cells{0};  ///< of azimuth and of the angle from the pole, those outside the range included
        glm::dvec2 low{0}, step{1};  ///< angles of the first node, rad, and between nodes
        bool exact = true;           ///< every angle of the file is a node; otherwise the nodes lie between, step apart
    };
    std::vector<Intensities> intensities;  ///< as Scene::distributions
    uint32_t roads = 0;  ///< texel of the first head; heads are as Scene::reflection_tables; 0: there are none
    std::vector<glm::vec4> texels{glm::vec4(0)};  ///< never empty
};

/// Grids whose nodes include every angle of the file, so that the interpolation between them is the file's own and
/// nothing is lost but what floats round. A file whose angles have no common divisor of at least 0.02 degrees gets
/// nodes 0.1 degrees apart; a road's table whose nodes have none gets nodes kMostRoadCells to its range.
IntensityTables intensity_tables(const scene::Scene& scene);

/// A reflection table as it is rendered.
photometry::ReflectionTable rendered_table(const scene::Scene& scene, size_t index);
/// pi Qd, what a road reflects of light from all sides, as a half float: the G-buffer holds it, and tables are relative
/// to it.
float reflectance_in_diffuse(const photometry::ReflectionTable& rendered);

}  // namespace vesper::gpu_scene
