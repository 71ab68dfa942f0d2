// Sizes and angles of pictures, as commands take them. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>
#include "arguments/command_line.h"

#include "io/hdr_image.h"
#include "vision/image_angles.h"

namespace vesper::apps {

/// WIDTHxHEIGHT, px, with sides from `least` to `most`. Throws Error.
VkExtent2D parse_size(const std::string& text, unsigned least = 1, unsigned most = 16384);

/// Of the option that names a layer of an OpenEXR file, as read_hdr_image takes it.
constexpr const char* kLayerHelp =
    "OpenEXR: name of the layer or part to take (default: the one without a name, or the only one)";

/// --unit and --exposure: the luminance that pictures are shown with.
struct ScaleArguments {
    std::string scale = "auto";  ///< or cd/m^2 of a picture's 1.0
    double exposure = 0;         ///< stops that luminance is raised by
};
constexpr const char* kScaleHelp =
    "cd/m^2 of a picture's 1.0; auto: as its header says, or, where it names no unit, as such a scene may have";
void add_scale_options(Command, ScaleArguments&, const char* help = kScaleHelp);

/// How a picture is asked for.
struct PictureRequest {
    ScaleArguments scale;
    double fov = 0;              ///< angle it covers in height, degrees; 0: not given
    bool angle_matters = false;  ///< whether a guessed angle is noted
    bool to_white =
        false;  ///< its values are relative to white (Operator::Ldr): 1.0 stays 1 where neither option nor file tell
    double held = 0;  ///< cd/m^2 of 1.0 in the sequence so far, which holds for pictures without a unit; 0: none yet
};

/// What the values of a picture and its height stand for.
struct PictureMeaning {
    double unit = 1;           ///< cd/m^2 of its 1.0 before --exposure; 0: it has neither unit nor light
    double scale = 1;          ///< the same as it is shown, with --exposure
    std::string scale_source;  ///< where the unit is from: option, header, auto, sequence, or none
    double fov = 40;         ///< angle it covers in height, degrees: as given, as the file says (Vesper's pictures and
                             ///< Radiance's), or 40
    bool fov_known = false;  ///< and not 40 for want of an angle
    std::optional<vision::ImageAngles> angles;  ///< of its edges, as its header has them; none where --fov is given
    std::vector<std::string> notes;             ///< what was taken for granted, and what of the file was passed over
    std::string scale_note;                     ///< likewise, of a unit that was found for this picture alone
};
PictureMeaning meaning_of(const io::HdrImage&, const PictureRequest&);

}  // namespace vesper::apps
