// Roads: the widest spacing of luminaires that reaches a lighting class, and OpenDRIVE roads lit with it.
//     c++ -std=c++17 main.cpp -o roads $(pkg-config --cflags --libs vesper-roads)
//     roads LUMINAIRE.ldt ROADS.xodr NIGHT.gltf
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>

#include <vesper/roads.hpp>

using namespace vesper::roads;

namespace {

void print(const RoadLayout& layout, const RoadLighting& lighting) {
    const LightingClass* reached = reached_class(lighting);
    std::printf("every %g m: Lav %.3f cd/m2, Uo %.3f, Ul %.3f, TI %.2f %%, EIR %.3f: %s\n", layout.spacing,
                lighting.average_luminance, lighting.overall_uniformity, lighting.longitudinal_uniformity,
                lighting.threshold_increment_percent, lighting.edge_ratio, reached ? reached->name : "no class");
}

/// The widest of some spacings whose lighting fulfils a class, m; 0 without one.
double widest_spacing(RoadLayout layout, const LightingClass& wanted) {
    double widest = 0;
    for (layout.spacing = 20; layout.spacing <= 40; layout.spacing += 5) {
        const RoadLighting lighting = calculate_road_lighting(layout);
        print(layout, lighting);
        if (fulfils(lighting, wanted)) widest = layout.spacing;
    }
    return widest;
}

void run(const char* luminaire, const char* roads, const char* scene) {
    RoadLayout layout;  // 7 m of road of R3, a row on the right, 8 m high
    layout.overhang = 0.5;
    layout.luminaire = luminaire;
    ConvertOptions options;
    options.lamps.spacing = widest_spacing(layout, *find_lighting_class("M5"));
    options.lamps.side = LampSide::Right;
    options.luminaire = luminaire;
    const RoadConversion made = convert_opendrive(roads, scene, options);
    for (const std::string& line : made.parts) std::printf("%s\n", line.c_str());
    for (const std::string& line : made.notes) std::printf("note: %s\n", line.c_str());
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 4) {
        std::fprintf(stderr, "usage: roads LUMINAIRE.ldt ROADS.xodr NIGHT.gltf\n");
        return 2;
    }
    try {
        run(arguments[1], arguments[2], arguments[3]);
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "roads: %s\n", failure.what());
        return 1;
    }
}
