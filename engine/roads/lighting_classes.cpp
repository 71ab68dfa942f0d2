// Lighting classes for motorised traffic (EN 13201-2:2015, Table 1). SPDX-License-Identifier: MIT
#include <vesper/road_lighting.hpp>

namespace vesper::roads {

const std::array<LightingClass, 6>& lighting_classes() {
    static constexpr std::array<LightingClass, 6> kClasses{{{"M1", 2.00, 0.40, 0.70, 10, 0.35},
                                                            {"M2", 1.50, 0.40, 0.70, 10, 0.35},
                                                            {"M3", 1.00, 0.40, 0.60, 15, 0.30},
                                                            {"M4", 0.75, 0.40, 0.60, 15, 0.30},
                                                            {"M5", 0.50, 0.35, 0.40, 15, 0.30},
                                                            {"M6", 0.30, 0.35, 0.40, 20, 0.30}}};
    return kClasses;
}

const LightingClass* find_lighting_class(const std::string& name) {
    for (const LightingClass& c : lighting_classes())
        if (name == c.name) return &c;
    return nullptr;
}

bool fulfils(const RoadLighting& lighting, const LightingClass& wanted) {
    if (lighting.wet) return lighting.overall_uniformity >= wanted.wet_uniformity;
    return lighting.average_luminance >= wanted.average_luminance &&
           lighting.overall_uniformity >= wanted.overall_uniformity &&
           lighting.longitudinal_uniformity >= wanted.longitudinal_uniformity &&
           lighting.threshold_increment_percent <= wanted.threshold_increment_percent &&
           lighting.edge_ratio >= wanted.edge_ratio;
}

const LightingClass* reached_class(const RoadLighting& lighting) {
    if (lighting.wet) return nullptr;
    for (const LightingClass& c : lighting_classes())
        if (fulfils(lighting, c)) return &c;
    return nullptr;
}

}  // namespace vesper::roads
