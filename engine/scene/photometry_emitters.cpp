// Rules that make materials emit, in the photometry file. SPDX-License-Identifier: MIT
#include <algorithm>

#include "base/error.h"
#include "base/one_line.h"
#include "io/hdr_image.h"
#include "io/read_file.h"
#include "scene/photometry_parts.h"
#include "scene/uri.h"

namespace vesper::scene {
namespace {

constexpr uint64_t kMaxPictureBytes = 256u << 20;
constexpr io::HdrLimits kLimits{16384, uint64_t{1} << 26};
constexpr double kBrightest = 1e10;  // cd/m^2, as luminance_cd_m2

/// The index of the picture a rule wants, read when it is the first to want it.
uint32_t picture_of(const JsonValue& file, const std::filesystem::path& folder, Photometry& made) {
    for (size_t i = 0; i < made.pictures.size(); ++i)
        if (made.pictures[i].picture.name == file.text()) return static_cast<uint32_t>(i);
    EmitterPicture read;
    try {
        const std::filesystem::path path = resolve_uri(folder, file.text());
        read.bytes = io::read_file(path, kMaxPictureBytes);
        io::HdrImage image = io::decode_hdr_image(read.bytes, path.string(), kLimits);
        read.white_luminance = image.white_luminance;
        read.notes = std::move(image.notes);
        try {
            read.picture = photometry::make_luminance_picture(std::move(image), &read.changed);
        } catch (const Error& error) {
            throw Error(one_line(path.string()) + ": " + error.what());
        }
    } catch (const Error& error) {
        file.fail(error.what());
    }
    read.picture.name = file.text();
    made.pictures.push_back(std::move(read));
    return static_cast<uint32_t>(made.pictures.size() - 1);
}

/// "image", and how bright it is.
void read_picture(const JsonValue& source, const std::filesystem::path& folder, Photometry& made, EmitterRule& rule) {
    for (const char* key : {"colour_temperature_K", "colour_rgb", "modulate", "lamp"})
        if (const auto other = source.find(key)) other->fail("is given beside image: one of them is wanted");
    const auto scale = source.find("scale"), luminance = source.find("luminance_cd_m2");
    if (scale && luminance) luminance->fail("is given beside scale: one of them is wanted");
    rule.picture = picture_of(source.at("image"), folder, made);
    const EmitterPicture& picture = made.pictures[rule.picture];
    const double largest = photometry::largest_luminance(picture.picture);
    if (scale) {
        rule.scale = scale->number(0, 1e12);
    } else if (luminance) {
        if (!(largest > 0)) luminance->fail("cannot scale a picture that is black");
        rule.scale = luminance->number(0, kBrightest) / largest;
    } else if (picture.white_luminance > 0) {
        rule.scale = picture.white_luminance;
    } else {
        rule.unit_unknown = true;
    }
    rule.luminance = rule.scale * largest;
    if (!(rule.luminance <= kBrightest * (1 + 1e-12)))
        source.at("image").fail("with its scale the picture has more than 1e10 cd/m^2");
}

/// The lamps whose glass a material is: their openings are what is seen.
std::vector<std::string> read_lamp_names(const JsonValue& source, const Photometry& made) {
    for (const char* key : {"colour_temperature_K", "colour_rgb", "modulate"})
        if (const auto other = source.find(key)) other->fail("follows from the lamp: leave it out");
    std::vector<std::string> names = read_patterns(source, "lamp");
    for (const std::string& name : names) {
        const auto found =
            std::find_if(made.lamps.begin(), made.lamps.end(), [&](const LampRule& r) { return r.name == name; });
        if (found == made.lamps.end()) source.at("lamp").fail("there is no lamp rule of the name '" + name + "'");
        if (!(found->lamp.opening.area() > 0) || !found->lamp.opening.drawn)
            source.at("lamp").fail("the lamp rule '" + name + "' has no opening that is drawn");
    }
    return names;
}

}  // namespace

EmitterRule read_emitter(const JsonValue& source, const std::filesystem::path& folder, Photometry& made) {
    allow_in_rule(source, {"name", "materials", "luminance_cd_m2", "colour_temperature_K", "colour_rgb", "modulate",
                           "lamp", "image", "scale"});
    EmitterRule rule;
    rule.materials = read_patterns(source, "materials");
    rule.name = source.text_or("name", rule.materials.front());
    if (source.find("image")) {
        read_picture(source, folder, made, rule);
        return rule;
    }
    if (const auto scale = source.find("scale")) scale->fail("has a meaning only beside an image");
    if (source.find("lamp")) {
        rule.lamps = read_lamp_names(source, made);
        rule.luminance = source.number_or("luminance_cd_m2", 0, 0, 1e10);
        return rule;
    }
    rule.luminance = source.at("luminance_cd_m2").number(0, 1e10);
    rule.colour = read_colour(source);
    rule.modulate = source.boolean_or("modulate", false);
    return rule;
}

}  // namespace vesper::scene
