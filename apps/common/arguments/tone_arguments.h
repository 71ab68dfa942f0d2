// What commands that show luminance on a display share: operator, display, files. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "arguments/command_line.h"

#include "arguments/display_arguments.h"
#include "arguments/eye_arguments.h"
#include "io/image_file.h"
#include "render/tone_chain.h"

namespace vesper::apps {

/// Options of the way from luminance to display codes.
struct ToneArguments : DisplayArguments {
    EyeArguments eye;
    std::string glare = "none", pupil = "photopic", gamut = "luminance";
    double iris = vision::ScatteringEye{}.pigmentation;
    uint32_t eye_seed = vision::ApertureSettings{}.seed;
    bool lashes = false;
    double histogram_low = 1e-4, histogram_high = 1e6;  ///< cd/m^2
    render::HistogramSettings histogram;
    render::ToneSettings tone;
};
void add_tone_options(Command, ToneArguments&);
/// What they say; throws Error if they contradict each other.
render::ToneChainSettings tone_settings(const ToneArguments&);

/// The name an operator has on the command line.
std::string name_of(render::Operator);
std::string name_of(eye::ScatterSettings::Model);
/// What --glare takes.
const std::vector<std::string>& glare_names();
/// What --gamut takes.
const std::vector<std::string>& gamut_names();
/// What a picture's header should say of how it is shown.
io::Header describe_tone(const render::ToneChainSettings&, const render::ToneMapped&);
/// Nine digits, as in headers.
std::string digits(double value);

/// What codes of a display mean, as a PNG may say. A gamma of 2.2 in Rec. 709 passes for sRGB, as viewers take it.
io::PngColour png_colour_of(const vision::Display&);
/// Writes the codes of a tone-mapped picture: 8 bits a channel, or 16 for a display of 10. Throws Error.
void write_codes(const std::string& file, const render::ToneMapped&, const vision::Display&,
                 const io::Header& texts = {});

}  // namespace vesper::apps
