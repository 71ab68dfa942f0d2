// What `vesper inspect` says of each kind of file. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/scene.h"
#include "transport/light_tracer.h"

namespace vesper::commands {

struct InspectArguments {
    std::string file, json, picture, layer, lamp, device;
    unsigned threads = 0;      ///< as apps::use_threads() takes it
    uint32_t lamp_number = 1;  ///< of those that `lamp` names, from 1
    std::vector<std::string> probes, points;
    std::string normal;        ///< of the surfaces at the points; empty: up
    uint32_t paths = 0;        ///< to a point or from a pixel; 0: the standard number
    std::string light;         ///< what files of a picture's light begin with
    std::string camera, size;  ///< of that picture; empty: the first, the standard size
    double low = 0, high = 0;  ///< ends of the colour scale; 0: found
    bool contours = false;
    bool balance = false;             ///< of luminous flux
    std::string photometry_template;  ///< photometry file to make
};

/// A report to print, and the same for programs.
struct Inspection {
    std::string text;
    nlohmann::ordered_json json;
};

/// The notes of reading a file under a heading; empty where there are none.
std::string notes_text(const std::vector<std::string>&);

Inspection inspect_scene(const InspectArguments&);
Inspection inspect_roads(const InspectArguments&);          ///< OpenDRIVE as the scene of vesper convert
Inspection inspect_names(const scene::Scene&);              ///< of nodes, materials and pictures, sorted, some of many
Inspection inspect_light(const InspectArguments&);          ///< at points of a scene
void announce_light_picture(const InspectArguments&);       ///< of the files that the next one writes (FileGate)
Inspection inspect_light_picture(const InspectArguments&);  ///< of what a camera sees; writes the pictures
Inspection inspect_balance(const InspectArguments&);        ///< of a scene's luminous flux
void announce_template(const InspectArguments&);            ///< of the file that the next one writes (FileGate)
Inspection inspect_template(const InspectArguments&);       ///< writes a photometry file for a scene, to be filled in
Inspection inspect_shadow_map(const InspectArguments&);     ///< of a scene; writes the picture if one is wanted
Inspection inspect_distribution(const InspectArguments&);   ///< writes the picture if one is wanted
Inspection inspect_table(const InspectArguments&);          ///< an r-table
Inspection inspect_picture(const InspectArguments&);        ///< writes the picture if one is wanted

/// What reports call the ways of light, in the order of transport::Origin.
constexpr std::array<const char*, transport::kOrigins> kOriginTexts{
    "lamps, directly", "emitting surfaces, directly", "sky, directly", "reflected once", "reflected more often"};

}  // namespace vesper::commands
