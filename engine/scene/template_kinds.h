// Kinds of sources, by the words of their names, and their usual photometry. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::scene {

/// Usual values of a kind of source. A kind without `standard` and `candela` lights nothing: only its surface shines.
struct SourceKind {
    const char* name;
    std::string_view compounds;    ///< between commas: beginnings of words, which may be several that are written
                                   ///< together; "street+": before a word for a lamp; "headl ": a whole word
    const char* standard = "";     ///< photometry::standard_lamp()
    double candela = 0;            ///< on the axis
    double inner = 0, outer = 0;   ///< half angles of a spot, degrees; 0: a point
    bool of_vehicle = false;       ///< shines away from the middle of a vehicle
    double kelvin = 0;             ///< colour temperature; 0: `colour`
    glm::dvec3 colour{1};          ///< linear
    double width = 0, height = 0;  ///< of the opening, m
    bool round = false;
    double luminance = 0;  ///< of the surface that shines, cd/m^2
};

/// Words of each part of a name between slashes, the last part first: of the last ten parts, and of 200 bytes each.
std::vector<std::vector<std::string>> parts_of(const std::string& name);

/// The kind of a source by the parts of its name and then of the names above; "lamp" where no word tells.
const SourceKind& kind_of(std::span<const std::vector<std::string>> parts);
/// The kind of a source that nothing is known of.
const SourceKind& plain_lamp();

/// Whether a name is that of a colour of a traffic signal: its words are of a signal, or are below such ones.
bool is_signal_colour(std::span<const std::vector<std::string>> parts);
/// Whether a name is that of a lamp of a vehicle which does not say lamp: "tail_left", "turn signal".
bool is_vehicle_lamp(const std::vector<std::string>& words);
/// Whether a material is named as a window of a house, or as something that is lit.
bool is_window(const std::vector<std::string>& words);
bool says_lit(const std::vector<std::string>& words);

}  // namespace vesper::scene
