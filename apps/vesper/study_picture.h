// Pictures to study: files, or scenes that are rendered once. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arguments/picture_arguments.h"
#include "arguments/setting_arguments.h"
#include "render/tone_mapper.h"

namespace vesper::commands {

/// A picture under study, on the host.
struct StudyPicture {
    std::string name;  ///< what its files begin with
    VkExtent2D extent{};
    std::vector<float> values;                  ///< rows from the top
    uint32_t channels = 3;                      ///< 3, or 4 with alpha that is ignored
    float scale = 1;                            ///< cd/m^2 per unit
    double vertical_fov = 0.7;                  ///< rad
    std::optional<vision::ImageAngles> angles;  ///< of its edges, in place of vertical_fov, where they are known
    bool is_absolute = true;                    ///< neither its unit nor its angle was guessed
    double darkest = 0, brightest = 0;          ///< luminance of pixels with light, cd/m^2

    /// Of the i-th pixel, cd/m^2.
    double luminance(size_t i) const;
    render::HostPicture host() const { return like(values, channels, scale); }
    /// Other values that cover the same angle.
    render::HostPicture like(std::span<const float> of, uint32_t of_channels, float of_scale) const {
        return {extent, of, of_channels, of_scale, vertical_fov, {}, angles ? &*angles : nullptr};
    }
};

/// How pictures are read and scenes are rendered.
struct PictureSource {
    std::string camera, size = "1680x1050";  ///< of a scene
    double start = 0;                        ///< s, of a scene
    apps::SettingArguments light;            ///< of a scene
    std::string cache;                       ///< as apps::cache_of() takes it
    std::string layer;                       ///< of OpenEXR files, see read_hdr_image
    apps::ScaleArguments scale;              ///< of a picture
    double fov = 0;                          ///< angle a picture covers in height, degrees; 0: as its file says, or 40
    bool angle_matters = false;              ///< to the study, so that a guess is noted
};

/// Settings of light and --cache, as far as they have a meaning for a study.
void add_light_options(apps::Command, apps::SettingArguments&, std::string& cache);
void add_source_options(apps::Command, PictureSource&);

/// Throws Error where options of scenes are given and no input is one.
void check_source(const PictureSource&, std::span<const std::string> inputs);

/// A picture without a name. Prints notes. Throws Error if it cannot be read or is black.
StudyPicture read_study_picture(const PictureSource&, gpu::Device&, const render::ToneChainSettings&,
                                const std::string& input);

}  // namespace vesper::commands
