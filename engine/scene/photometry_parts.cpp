// Skies, directional lights and retroreflection in the photometry file. SPDX-License-Identifier: MIT
#include "scene/photometry_parts.h"

#include <algorithm>

#include "base/angle.h"
#include "base/decimal.h"
#include "base/error.h"
#include "io/hdr_image.h"
#include "io/named_file.h"

namespace vesper::scene {
namespace {

std::vector<double> numbers_of(const JsonValue& list) {
    std::vector<double> numbers;
    for (const JsonValue& element : list.elements()) numbers.push_back(element.number());
    return numbers;
}

photometry::Retroreflector checked(const JsonValue& source, photometry::Retroreflector made) {
    try {
        photometry::check_retroreflector(made);
    } catch (const Error& error) {
        source.fail(error.what());
    }
    return made;
}

/// The factor that the sky's values are multiplied by.
double factor_of(const JsonValue& source, const photometry::Environment& e, double white_luminance) {
    const auto scale = source.find("scale"), luminance = source.find("luminance_cd_m2"),
               illuminance = source.find("illuminance_lx");
    if (scale && luminance) luminance->fail("is given beside scale: one of them is wanted");
    if (illuminance && (scale || luminance))
        illuminance->fail("is given beside scale or luminance_cd_m2: one of them is wanted");
    if (scale) return scale->number(0, 1e12);
    if (!luminance && !illuminance) return white_luminance > 0 ? white_luminance : 1;
    const JsonValue& stated = luminance ? *luminance : *illuminance;
    const double has = luminance ? photometry::sky_luminance(e) : photometry::horizontal_illuminance(e);
    if (!(has > 0)) stated.fail("cannot scale a sky that is black above the horizon");
    return stated.number(0, 1e6) / has;
}

}  // namespace

SkyPicture read_sky_picture(const JsonValue& source, const std::filesystem::path& folder) {
    source.allow_only({"image", "scale", "luminance_cd_m2", "illuminance_lx", "rotation_deg"});
    const JsonValue file = source.at("image");
    SkyPicture sky{.file = file.text()};
    double white = 0;
    try {
        const io::HdrImage image = io::read_hdr_image(io::named_file(folder, sky.file));
        white = image.white_luminance;
        sky.notes = image.notes;
        sky.environment = photometry::make_environment(image, &sky.cleaned);
    } catch (const Error& error) {
        file.fail(error.what());
    }
    try {
        const double factor = factor_of(source, sky.environment, white);
        sky.environment = photometry::scaled(std::move(sky.environment), factor);
    } catch (const Error& error) {
        source.fail(error.what());
    }
    const bool stated = source.find("scale") || source.find("luminance_cd_m2") || source.find("illuminance_lx");
    if (!stated && !(white > 0))
        sky.notes.push_back("does not say how much its value 1 is (whiteLuminance): taken for 1 cd/m^2, which makes " +
                            decimal(photometry::sky_luminance(sky.environment)) + " cd/m^2 in the mean and " +
                            decimal(photometry::horizontal_illuminance(sky.environment)) +
                            " lx on the ground; \"scale\", \"luminance_cd_m2\" or \"illuminance_lx\" states it");
    sky.environment.rotation = source.number_or("rotation_deg", 0, -360, 360) * kRadiansPerDegree;
    return sky;
}

DirectionalRule read_directional(const JsonValue& source) {
    allow_in_rule(source, {"name", "illuminance_lx", "angular_diameter_deg", "direction", "azimuth_deg",
                           "elevation_deg", "colour_temperature_K", "colour_rgb"});
    DirectionalRule rule;
    rule.name = source.text_or("name", "directional light");
    rule.illuminance = source.at("illuminance_lx").number(0, 2e5);
    if (const auto diameter = source.find("angular_diameter_deg"))
        rule.angular_diameter = diameter->number(0, kMostAngularDiameter);
    rule.colour = read_colour(source);
    if (const auto direction = source.find("direction")) {
        for (const char* key : {"azimuth_deg", "elevation_deg"})
            if (const auto angle = source.find(key)) angle->fail("is given beside direction: one of them is wanted");
        const auto v = direction->numbers<3>();
        const glm::dvec3 axis(v[0], v[1], v[2]);
        if (!(glm::length(axis) > 1e-6)) direction->fail("must not be of length 0");
        rule.direction = glm::normalize(axis);
    } else {
        const double azimuth = source.at("azimuth_deg").number(-360, 360),
                     elevation = source.at("elevation_deg").number(-90, 90);
        rule.direction = -photometry::direction_of(azimuth * kRadiansPerDegree, elevation * kRadiansPerDegree);
    }
    return rule;
}

photometry::Retroreflector read_retroreflection(const JsonValue& source) {
    source.allow_only({"class", "table", "r_l_mcd", "scale"});
    const auto named = source.find("class"), table = source.find("table"), marking = source.find("r_l_mcd");
    if (int(named.has_value()) + int(table.has_value()) + int(marking.has_value()) != 1)
        source.fail("must have one of class, table and r_l_mcd");
    photometry::Retroreflector made;
    if (named) {
        try {
            made = photometry::retroreflective_class(named->text());
        } catch (const Error& error) {
            named->fail(error.what());
        }
    } else if (marking) {
        made = photometry::retroreflective_marking(marking->number(1, 1e4));
        made.name = "R_L " + std::to_string(int(marking->number())) + " mcd/(m^2 lx)";
    } else {
        table->allow_only({"name", "observation_deg", "r_a", "entrance_deg", "entrance_factor"});
        made = {table->text_or("name", "table"),
                numbers_of(table->at("observation_deg")),
                numbers_of(table->at("r_a")),
                {5, 30, 50, 80},
                {1, 0.5, 0.15, 0}};
        if (const auto entrance = table->find("entrance_deg")) {
            made.entrance = numbers_of(*entrance);
            made.entrance_factor = numbers_of(table->at("entrance_factor"));
        } else if (const auto factor = table->find("entrance_factor")) {
            factor->fail("has a meaning only beside entrance_deg");
        }
    }
    return checked(source, photometry::rescaled(made, source.number_or("scale", 1, 1e-3, 1e3)));
}

nlohmann::json json_of(const photometry::Retroreflector& r) {
    return {{"name", r.name},
            {"observation_deg", r.observation},
            {"coefficient", r.coefficient},
            {"entrance_deg", r.entrance},
            {"entrance_factor", r.entrance_factor},
            {"marking", r.marking}};
}

photometry::Retroreflector read_whole_retroreflector(const JsonValue& source) {
    source.allow_only({"name", "observation_deg", "coefficient", "entrance_deg", "entrance_factor", "marking"});
    return checked(source, {source.text_or("name", ""), numbers_of(source.at("observation_deg")),
                            numbers_of(source.at("coefficient")), numbers_of(source.at("entrance_deg")),
                            numbers_of(source.at("entrance_factor")), source.boolean_or("marking", false)});
}

Photometry with_night_sky(Photometry p) {
    if (p.sky_picture) return p;
    if (!p.sky) p.sky = ColouredQuantity{0.02};
    if (!p.ambient) p.ambient = ColouredQuantity{0.1};
    return p;
}

}  // namespace vesper::scene
