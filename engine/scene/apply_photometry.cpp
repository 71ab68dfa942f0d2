// The rules of a photometry file: the table of contents. SPDX-License-Identifier: MIT
#include "scene/apply_photometry.h"

#include "base/error.h"
#include "base/one_line.h"
#include "scene/apply_rules.h"
#include "scene/photometry_parts.h"

namespace vesper::scene {
namespace {

/// A scene has so many lamps at most, and it is the photometry file that asks for more.
void check_count(const Application& application) {
    size_t placed = application.photometry.directional.size();
    for (const auto& nodes : application.lamp_nodes) placed += nodes.size();
    if (placed > kMaxLamps)
        throw Error(one_line(application.photometry.file.string()) + ": /lamps: " + std::to_string(placed) +
                    " lamps, more than the limit of " + std::to_string(kMaxLamps));
}

void describe_rest(const Application& application, const Photometry& stated) {
    const Photometry& p = application.photometry;
    auto& changes = application.report.changes;
    const bool gamma = p.transfer.kind == Transfer::Kind::Gamma;
    changes.push_back("textures: " + std::to_string(application.scene.images.size()) +
                      " pictures kept as they are, read as reflectance by " +
                      (gamma ? "code^" + decimal(p.transfer.gamma) : "the sRGB curve"));
    if (p.ambient)
        changes.push_back("ambient: " + decimal(p.ambient->value) + " lx, in pictures without indirect light");
    if (p.sky) changes.push_back("sky: " + decimal(p.sky->value) + " cd/m^2");
    if (p.ambient.has_value() != stated.ambient.has_value() || p.sky.has_value() != stated.sky.has_value())
        changes.push_back("ambient and sky: what is not stated is that of a clear night over a city");
}

}  // namespace

std::string in_quotes(const std::string& name) { return "'" + one_line(name) + "'"; }

PhotometryReport apply_photometry(Scene& scene, const Photometry& photometry, const std::string& name,
                                  const SceneSource& source) {
    const Photometry rules = with_night_sky(photometry);
    PhotometryReport report;
    Application application{
        scene, rules, report, source, name, static_cast<uint32_t>(scene.nodes.size()), shown_images(scene)};
    apply_lamps(application);
    check_count(application);
    apply_materials(application);
    apply_sky(application);
    describe_rest(application, photometry);
    put_in_order(application);
    check_reflectances(scene, report);
    return report;
}

}  // namespace vesper::scene
