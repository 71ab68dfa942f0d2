// A display: luminance of its codes. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "io/primaries.h"

namespace vesper::vision {

/// How codes become light (electro-optical transfer function).
enum class Eotf : uint8_t {
    Gamma,  ///< black + (peak - black) V^gamma
    Srgb,   ///< black + (peak - black) times the curve of IEC 61966-2-1
    Pq,     ///< absolute, SMPTE ST 2084, as far as the display goes: from black to peak
    Table,  ///< measured
};

/// Names in files and commands.
constexpr std::array<std::pair<const char*, Eotf>, 4> kEotfNames{
    {{"gamma", Eotf::Gamma}, {"srgb", Eotf::Srgb}, {"pq", Eotf::Pq}, {"table", Eotf::Table}}};

/// One measurement of a display in the dark.
struct DisplaySample {
    double code = 0;       ///< [0, 1]: 1 is the largest code
    double luminance = 0;  ///< cd/m^2
};

constexpr double kLeastBlack = 1e-6;  ///< cd/m^2: least luminance of code 0, reflected light included

/// A display and the light that falls on it (Mantiuk, Daly and Kerofsky 2008): it shows a code V in [0, 1] with
/// L(V) = emitted(V) + reflection * ambient / pi.
struct Display {
    float peak = 100;          ///< cd/m^2, of code 1 in the dark
    float black = 0.1f;        ///< cd/m^2, of code 0 in the dark
    float gamma = 2.2f;        ///< of Eotf::Gamma
    float ambient = 5;         ///< illuminance on the screen, lx
    float reflection = 0.01f;  ///< diffuse reflectance of the screen
    Eotf eotf = Eotf::Gamma;
    uint32_t bits = 8;  ///< of a channel's code: 8 or 10
    io::Primaries primaries = io::kRec709;
    /// Of Eotf::Table: from code 0 (luminance `black`) to code 1 (luminance `peak`); codes and luminances ascend.
    std::vector<DisplaySample> table;

    /// Luminance of code 0 and of code 1, cd/m^2.
    float low() const { return black + reflection * ambient / std::numbers::pi_v<float>; }
    float high() const { return peak + reflection * ambient / std::numbers::pi_v<float>; }
    uint32_t largest_code() const { return (1u << bits) - 1; }
};

/// Throws Error with the reason if a value is out of range.
void check_display(const Display&);

/// Luminance of codes, cd/m^2 in the dark. A table is interpolated by a monotone cubic (Fritsch and Carlson 1980) of
/// (L - black)^(1 / 2.2), nearly straight for most displays.
class DisplayCurve {
public:
    explicit DisplayCurve(const Display&);
    double emitted(double code) const;  ///< of a code in [0, 1]; others are clamped

private:
    Eotf eotf_;
    double peak_, black_, gamma_;
    std::vector<double> codes_, roots_, slopes_;  // of a table: (L - black)^(1 / 2.2), and its derivative by code
};

/// SMPTE ST 2084: luminance, cd/m^2, of a signal in [0, 1].
double pq_luminance(double signal);

struct NamedDisplay {
    const char* name;
    const char* description;
    Display display;
};
/// Displays with a name. The first is the default.
const std::vector<NamedDisplay>& known_displays();
/// Names of the known displays, separated by commas.
std::string known_display_names();

}  // namespace vesper::vision
