// Radiosity of small scenes. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "base/luminance.h"
#include "scene/scene.h"
#include "transport/radiosity.h"

namespace vesper::test {

/// Of cells as large as large scenes have, and with as few rays: for tests that need no less.
constexpr transport::RadiositySettings kMetreCells{.cell_size = 1, .fine_cells = 0};

inline transport::Radiosity gathered(const scene::Scene& scene,
                                     const transport::RadiositySettings& settings = kMetreCells,
                                     const std::vector<bool>& moving = {}) {
    return transport::gather_radiosity(scene, scene::world_transforms(scene, 0), moving, settings).value();
}

/// One number for each cell.
inline std::vector<double> lux(const std::vector<glm::vec3>& illuminance) {
    std::vector<double> values;
    for (const glm::vec3& rgb : illuminance) values.push_back(luminance(glm::dvec3(rgb)));
    return values;
}

/// Mean over the area of the cells of surfaces for which `counts(index, middle)` holds.
template <class Counts>
double mean_over(const transport::Radiosity& radiosity, const std::vector<double>& values, const Counts& counts) {
    double sum = 0, area = 0;
    for (size_t i = 0; i < radiosity.cells(); ++i) {
        const uint32_t number = radiosity.numbers[i];
        if (radiosity.grid.is_air(number) || !counts(i, radiosity.grid.middle(number))) continue;
        sum += double(radiosity.areas[i]) * values[i], area += double(radiosity.areas[i]);
    }
    return sum / area;
}
inline double mean_over_all(const transport::Radiosity& radiosity, const std::vector<double>& values) {
    return mean_over(radiosity, values, [](size_t, glm::dvec3) { return true; });
}

}  // namespace vesper::test
