// Study: what the foveal level, the size of what the eye takes as one, does to pictures. SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "arguments/arguments.h"
#include "print.h"
#include "study.h"

namespace vesper::commands {
namespace {

using apps::format;

constexpr uint32_t kLevels = 8;

const std::vector<std::string> kMipColumns{"picture",       "operator",           "level",
                                           "degrees",       "adaptation",         "curve_codes",
                                           "largest_codes", "percentile99_codes", "mean_codes"};

/// Levels that the pyramid of a picture has, at most eight.
uint32_t levels_of(const StudyPicture& picture) {
    const uint32_t side = std::max(picture.extent.width, picture.extent.height);
    return std::clamp(uint32_t(std::bit_width(side)) - 1, 1u, kLevels);
}

}  // namespace

void study_mip(Study& study) {
    const std::vector<render::Operator> ops =
        studied_operators(study.arguments, histogram_operators(), "it does not adjust a histogram");
    std::vector<std::vector<std::string>> rows;
    apps::LinePlot summary{.title = "Largest difference of the curve to that of level 1",
                           .x_name = "foveal level",
                           .y_name = "codes",
                           .lines = {}};
    const auto make = [&](size_t condition) {
        const StudyPicture& picture = study.pictures[condition / ops.size()];
        const render::Operator op = ops[condition % ops.size()];
        StudyPart part;
        render::ToneChainSettings settings = study.settings;
        settings.tone_operator = op;
        const std::string stem = picture.name + "-" + apps::name_of(op);
        const std::vector<double> luminances = luminances_of(picture);
        apps::LinePlot plot{.title = stem + ": curves of the levels",
                            .x_name = "luminance of the scene, cd/m\u00b2",
                            .y_name = "display code",
                            .lines = {},
                            .log_x = true};
        part.lines.push_back({.name = stem, .points = {}, .marks = true});
        render::ToneMapped finest;
        std::vector<double> finest_codes;
        for (uint32_t level = 1; level <= levels_of(picture); ++level) {
            settings.foveal_level = level;
            render::ToneMapped got = study.map(picture, settings);
            const std::vector<double> codes = curve_codes(got, op, settings.display, luminances);
            if (level == 1) finest = got, finest_codes = codes;
            Difference d = difference(got, finest, settings.display);
            d.curve = largest_difference(codes, finest_codes);
            const double degrees = gpu_scene::View::symmetric(picture.extent, float(picture.vertical_fov), glm::mat4(1))
                                       .degrees_per_pixel() *
                                   double(1u << level);
            part.rows.push_back({picture.name, apps::name_of(op), std::to_string(level), format("%.4g", degrees),
                                 format("%.5g", double(got.curve.adaptation)), format("%.4f", d.curve),
                                 format("%.0f", d.largest), format("%.0f", d.percentile), format("%.5f", d.mean)});
            part.lines.back().points.push_back({double(level), d.curve});
            plot.lines.push_back({.name = format("level %u, %.3g\u00b0", level, degrees), .points = {}});
            for (size_t i = 0; i < codes.size(); ++i) plot.lines.back().points.push_back({luminances[i], codes[i]});
            const std::string name = stem + "-level" + std::to_string(level);
            apps::write_codes(study.file(name + ".png"), got, settings.display);
            part.shown.push_back({name + ".png", format("level %u: %.3g\u00b0 a texel, adaptation %.4g cd/m\u00b2",
                                                        level, degrees, double(got.curve.adaptation))});
            if (level == 1) continue;
            save_difference(study.file(name + "-difference.png"), got.extent.width, got.extent.height, d.map);
            part.shown.push_back(
                {name + "-difference.png", format("level %u, difference to level 1: ", level) + describe(d)});
        }
        apps::save_plot(study.file(stem + "-curves.png"), plot);
        return part;
    };
    const std::vector<StudyPart> parts = study.parts("mip", study.pictures.size() * ops.size(), make);
    if (parts.empty()) return;
    study.page.paragraph("Differences are of display codes.");
    for (size_t i = 0; i < parts.size(); ++i) {
        const std::string name = study.pictures[i / ops.size()].name, op = apps::name_of(ops[i % ops.size()]);
        rows.insert(rows.end(), parts[i].rows.begin(), parts[i].rows.end());
        summary.lines.push_back(parts[i].lines.front());
        study.page.heading(name + ", " + op);
        study.page.plot(name + "-" + op + "-curves.png");
        study.page.pictures(parts[i].shown);
    }
    apps::save_plot(study.file("mip.png"), summary);
    apps::write_text(study.file("mip.csv"), csv_of(kMipColumns, rows));
    study.page.heading("Summary");
    study.page.plot("mip.png");
    study.page.table(kMipColumns, rows);
}

}  // namespace vesper::commands
