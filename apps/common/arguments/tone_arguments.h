// Arguments of the way from luminance to a display: operator, eye, glare, display, files. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "arguments/command_line.h"

#include "arguments/display_arguments.h"
#include "io/image_file.h"
#include "render/settings.h"
#include "render/tone_rows.h"

namespace vesper::apps {

/// Options of the way from luminance to display codes: those of render::tone_rows(), the gaze, a preset and the
/// display.
struct ToneArguments : DisplayArguments {
    render::ToneChainSettings own;                         ///< defaults of the program
    std::map<std::string_view, std::string> instead = {};  ///< of programs that take lists: in place of what was given
    std::string preset = "none";
    std::vector<float> gaze{0.5f, 0.5f};
    Command command = {};  ///< tells which were given
};
void add_tone_options(Command, ToneArguments&);
/// What they say; throws Error if they contradict each other.
render::ToneChainSettings tone_settings(const ToneArguments&);

/// The value of a setting as users write it.
std::string text_of(std::string_view name, const render::ToneChainSettings&);
/// The name an operator has on the command line.
std::string name_of(render::Operator);
/// Fields of a picture's header: all of render::tone_rows(), as "vesper:age".
io::Header describe_tone(const render::ToneChainSettings&);
/// The same with the settings of light: the header of a picture of codes.
io::Header describe_codes(const std::string& quality, const render::RenderSettings&);
/// Members of a JSON object, in a line: "operator": "irawan", ...
std::string tone_json(const render::ToneChainSettings&);
/// The fields, and what the eye adapted to.
io::Header describe_tone(const render::ToneChainSettings&, const render::ToneMapped&);
/// Nine digits, as in headers.
std::string digits(double value);

/// What codes of a display mean, as a PNG may say. A gamma of 2.2 in Rec. 709 passes for sRGB, as viewers take it.
io::PngColour png_colour_of(const vision::Display&);
/// Writes the codes of a tone-mapped picture: 8 bits a channel, or 16 for a display of 10. Throws Error.
void write_codes(const std::string& file, const render::ToneMapped&, const vision::Display&,
                 const io::Header& texts = {});

}  // namespace vesper::apps
