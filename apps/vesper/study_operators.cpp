// Study: all operators side by side, with what they do to contrast and visibility. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "arguments/arguments.h"
#include "print.h"
#include "study.h"
#include "vision/visibility.h"

namespace vesper::commands {
namespace {

using apps::format;

const std::vector<std::string> kOperatorColumns{"picture",        "operator",       "range_scene", "range_shown",
                                                "contrast_scene", "contrast_shown", "vl_scene",    "vl_shown",
                                                "visible_scene",  "visible_shown",  "lost",        "gained"};

/// Mean luminances, cd/m^2, of squares of about one degree, those without light left out.
std::vector<double> degree_luminances(const StudyPicture& picture) {
    const double side = picture.extent.height / (picture.vertical_fov * 180 / std::numbers::pi);
    const auto cells = [&](uint32_t pixels) { return std::max(1u, uint32_t(std::lround(pixels / side))); };
    const uint32_t columns = std::min(cells(picture.extent.width), picture.extent.width),
                   rows = std::min(cells(picture.extent.height), picture.extent.height);
    std::vector<double> sums(size_t{columns} * rows), counts(sums.size());
    for (uint32_t y = 0; y < picture.extent.height; ++y)
        for (uint32_t x = 0; x < picture.extent.width; ++x) {
            const double l = picture.luminance(size_t{y} * picture.extent.width + x);
            if (!std::isfinite(l)) continue;
            const size_t cell =
                uint64_t{y} * rows / picture.extent.height * columns + uint64_t{x} * columns / picture.extent.width;
            sums[cell] += std::max(l, 0.0), ++counts[cell];
        }
    std::vector<double> means;
    for (size_t i = 0; i < sums.size(); ++i)
        if (sums[i] > 0) means.push_back(sums[i] / counts[i]);
    return means;
}

double percentile(std::vector<double> values, double share) {
    const auto at = values.begin() + std::lround(share * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double log_range(const std::vector<double>& values) {
    return std::log10(percentile(values, 0.99) / percentile(values, 0.01));
}

}  // namespace

void study_operators(Study& study) {
    std::vector<render::Operator> all;
    for (const render::OperatorInfo& op : render::operators())
        if (op.tone_operator != render::Operator::Ldr) all.push_back(op.tone_operator);
    const std::vector<render::Operator> ops = studied_operators(study.arguments, all, "it does not show luminance");
    const double contrast = study.arguments.contrast;
    const vision::Target target{.size = study.arguments.minutes, .age = study.settings.tone.observer.age};
    std::vector<std::vector<std::string>> rows;
    study.page.paragraph(
        format("The target has %g' and a contrast of %g to the mean of each square degree of the picture. Its "
               "visibility level after Adrian 1989 (0.2 s, an observer of %g years), "
               "in the scene and as displayed; it is visible from level 1. Range: log10 of the 99th over the 1st "
               "percentile of square degrees. Lost: share of "
               "square degrees where the target is visible in the scene and not on the display; gained: the reverse.",
               target.size, contrast, target.age));
    const auto make = [&](size_t condition) {
        const StudyPicture& picture = study.pictures[condition / ops.size()];
        const render::Operator op = ops[condition % ops.size()];
        const std::vector<double> backgrounds = degree_luminances(picture), luminances = luminances_of(picture);
        StudyPart part;
        if (backgrounds.empty()) return part;
        render::ToneChainSettings settings = study.settings;
        settings.tone_operator = op;
        const render::ToneMapped got = study.map(picture, settings);
        const auto display = [&](double l) { return render::shown_luminance(op, got.curve, l, settings.display); };
        std::vector<double> contrasts, scene, screen, displayed;
        double visible_scene = 0, visible_shown = 0, lost = 0, gained = 0;
        for (const double l : backgrounds) {
            const double low = display(l), high = display(l * (1 + contrast));
            displayed.push_back(low), contrasts.push_back(high / low - 1);
            scene.push_back(vision::visibility_level(l * (1 + contrast), l, target)),
                screen.push_back(vision::visibility_level(high, low, target));
            const bool in_scene = scene.back() >= 1, on_screen = screen.back() >= 1;
            visible_scene += in_scene, visible_shown += on_screen, lost += in_scene && !on_screen,
                gained += !in_scene && on_screen;
        }
        const double count = double(backgrounds.size());
        part.rows.push_back({picture.name, apps::name_of(op), format("%.3f", log_range(backgrounds)),
                             format("%.3f", log_range(displayed)), format("%g", contrast),
                             format("%.4f", percentile(contrasts, 0.5)), format("%.3f", percentile(scene, 0.5)),
                             format("%.3f", percentile(screen, 0.5)), format("%.4f", visible_scene / count),
                             format("%.4f", visible_shown / count), format("%.4f", lost / count),
                             format("%.4f", gained / count)});
        part.lines.push_back({.name = apps::name_of(op),
                              .points = {},
                              .dashed = op == render::Operator::Durand});  // often over ferwerda
        for (const double l : luminances)
            part.lines.back().points.push_back(
                {l, vision::visibility_level(display(l * (1 + contrast)), display(l), target)});
        const std::string name = picture.name + "-" + apps::name_of(op) + ".png";
        apps::write_codes(study.file(name), got, settings.display);
        part.shown.push_back(
            {name, format("%s: contrast %.3f, visibility level %.2f (scene %.2f), lost %.1f %%, gained %.1f %%",
                          apps::name_of(op).c_str(), percentile(contrasts, 0.5), percentile(screen, 0.5),
                          percentile(scene, 0.5), 100 * lost / count, 100 * gained / count)});
        return part;
    };
    const std::vector<StudyPart> parts = study.parts("operators", study.pictures.size() * ops.size(), make);
    if (parts.empty()) return;
    for (size_t p = 0; p < study.pictures.size(); ++p) {
        const StudyPicture& picture = study.pictures[p];
        const std::vector<double> luminances = luminances_of(picture);
        if (luminances.empty()) continue;
        apps::LinePlot levels{
            .title = picture.name + format(": visibility level of a target of %g', contrast %g", target.size, contrast),
            .x_name = "luminance of the background in the scene, cd/m\u00b2",
            .y_name = "visibility level",
            .lines = {{.name = "scene", .points = {}, .dashed = true}},
            .log_x = true,
            .log_y = true,
            .rule = 1};
        for (const double l : luminances)
            levels.lines[0].points.push_back({l, vision::visibility_level(l * (1 + contrast), l, target)});
        std::vector<StudyPage::Figure> shown;
        for (const StudyPart& part : std::span(parts).subspan(p * ops.size(), ops.size())) {
            rows.insert(rows.end(), part.rows.begin(), part.rows.end());
            levels.lines.insert(levels.lines.end(), part.lines.begin(), part.lines.end());
            shown.insert(shown.end(), part.shown.begin(), part.shown.end());
        }
        if (shown.empty()) continue;
        apps::save_plot(study.file(picture.name + "-visibility.png"), levels);
        study.page.heading(picture.name);
        study.page.pictures(shown);
        study.page.plot(picture.name + "-visibility.png");
    }
    apps::write_text(study.file("operators.csv"), csv_of(kOperatorColumns, rows));
    study.page.heading("All figures");
    study.page.table(kOperatorColumns, rows);
}

}  // namespace vesper::commands
