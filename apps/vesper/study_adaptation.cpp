// Study: step responses of the operators that remember, into a tunnel and out of it. SPDX-License-Identifier: MIT
#include <cmath>
#include <optional>

#include "analysis/pattanaik.h"
#include "arguments/arguments.h"
#include "print.h"
#include "study.h"

namespace vesper::commands {
namespace {

using apps::format;

const std::vector<std::string> kColumns{"operator", "step",      "seconds",         "luminance", "pigment",
                                        "sigma",    "threshold", "threshold_ratio", "shown"};

std::vector<render::Operator> remembering() {
    std::vector<render::Operator> found;
    for (const render::OperatorInfo& op : render::operators())
        if (op.remembers) found.push_back(op.tone_operator);
    return found;
}

/// 0.01 s and on, ten to a decade.
std::vector<double> moments(double until) {
    std::vector<double> times;
    for (double decade = 0.01; decade <= until; decade *= 10)
        for (const double factor : {1.0, 1.25, 1.6, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
            if (factor * decade <= until * (1 + 1e-9)) times.push_back(factor * decade);
    return times;
}

/// How visible small differences are at a luminance in the state of the eye.
struct Sensitivity {
    double pigment = 0, sigma = 0;
    std::optional<double> threshold;  ///< cd/m^2, where the model has one
    double ratio = 1;                 ///< threshold over that of the eye adapted to this luminance
};

Sensitivity of_eye(const render::ToneMapped& got, const vision::Observer& observer, double luminance) {
    const vision::ReceptorModel cones(vision::ReceptorKind::Cones, observer.observed_cones());
    const double sigma = double(got.curve.cone_sigma), threshold = cones.threshold(luminance, sigma);
    return {double(got.eye.cones.pigment), sigma, threshold, threshold / cones.adapted_threshold(luminance)};
}

/// Pattanaik et al. have responses and no threshold: a constant step of the cones' response p x / (1 + x)
/// needs a difference in inverse proportion to its slope.
Sensitivity of_lagging(const render::ToneMapped& got, double luminance) {
    const auto slope = [&](double adaptation, double pigment) {
        using analysis::pattanaik::kExponent;
        const double x = std::pow(luminance / analysis::pattanaik::cone_sigma(adaptation), kExponent);
        return pigment * kExponent * x / (luminance * (1 + x) * (1 + x));
    };
    const double adaptation = double(got.eye.pattanaik.cones), pigment = double(got.eye.pattanaik.cone_pigment);
    const analysis::pattanaik::State adapted = analysis::pattanaik::adapted(luminance, luminance);
    return {pigment,
            analysis::pattanaik::cone_sigma(adaptation),
            {},
            slope(adapted.cones, adapted.cone_pigment) / slope(adaptation, pigment)};
}

/// A field of one luminance, whose curve says what anything would be shown as.
render::ToneMapped look(Study& study, const render::ToneChainSettings& settings, double luminance, double seconds) {
    constexpr uint32_t kSide = 16;
    const std::vector<float> values(size_t{3} * kSide * kSide, float(luminance));
    return study.mapper.map(settings, {.extent = {kSide, kSide}, .values = values}, float(seconds), {.display = false});
}

struct Step {
    const char* name;
    double from, to;  ///< cd/m^2
};

}  // namespace

void study_adaptation(Study& study) {
    const StudyArguments& a = study.arguments;
    const std::vector<render::Operator> ops = studied_operators(a, remembering(), "it remembers nothing");
    const std::vector<double> times = moments(a.seconds);
    const Step steps[]{{"in", a.outside, a.inside}, {"out", a.inside, a.outside}};
    std::vector<std::vector<std::string>> rows;
    const auto make = [&](size_t condition) {
        const Step& step = steps[condition / ops.size()];
        const render::Operator op = ops[condition % ops.size()];
        StudyPart part;
        render::ToneChainSettings settings = study.settings;
        settings.tone_operator = op;
        const bool dashed = condition % ops.size() > 1;  // thresholds of two may be the same
        part.lines.assign(3, {.name = apps::name_of(op), .points = {}, .dashed = dashed});
        study.mapper.reset_adaptation();
        look(study, settings, step.from, 0);
        double before = 0;
        for (const double t : times) {
            const render::ToneMapped got = look(study, settings, step.to, t - before);
            before = t;
            const Sensitivity s = op == render::Operator::Pattanaik ? of_lagging(got, step.to)
                                                                    : of_eye(got, settings.tone.observer, step.to);
            const double light = render::shown_luminance(op, got.curve, step.to, settings.display);
            part.lines[0].points.push_back({t, s.ratio});
            part.lines[1].points.push_back({t, s.sigma});
            part.lines[2].points.push_back({t, light});
            part.rows.push_back({apps::name_of(op), step.name, format("%g", t), format("%g", step.to),
                                 format("%.5f", s.pigment), format("%.6g", s.sigma),
                                 s.threshold ? format("%.6g", *s.threshold) : "", format("%.5g", s.ratio),
                                 format("%.5g", light)});
        }
        return part;
    };
    const std::vector<StudyPart> parts = study.parts("adaptation", std::size(steps) * ops.size(), make);
    if (parts.empty()) return;
    for (size_t i = 0; i < std::size(steps); ++i) {
        const Step& step = steps[i];
        const std::string title = format("From %g to %g cd/m\u00b2", step.from, step.to),
                          name = std::string("adaptation-") + step.name;
        apps::LinePlot ratio{.title = title + ": threshold over that of the adapted eye",
                             .x_name = "s",
                             .y_name = "threshold, times the adapted one",
                             .lines = {},
                             .log_x = true,
                             .log_y = true,
                             .rule = 1};
        apps::LinePlot sigma{.title = title + ": half saturation of the cones",
                             .x_name = "s",
                             .y_name = "\u03c3, cd/m\u00b2",
                             .lines = {},
                             .log_x = true,
                             .log_y = true};
        apps::LinePlot shown{.title = title + ": what the new luminance is shown as",
                             .x_name = "s",
                             .y_name = "cd/m\u00b2 on the display",
                             .lines = {},
                             .log_x = true};
        for (const StudyPart& part : std::span(parts).subspan(i * ops.size(), ops.size())) {
            rows.insert(rows.end(), part.rows.begin(), part.rows.end());
            ratio.lines.push_back(part.lines[0]), sigma.lines.push_back(part.lines[1]);
            shown.lines.push_back(part.lines[2]);
        }
        study.page.heading(title);
        for (const auto& [plot, kind] :
             {std::pair{&ratio, "threshold"}, std::pair{&sigma, "sigma"}, std::pair{&shown, "shown"}}) {
            apps::save_plot(study.file(name + "-" + kind + ".png"), *plot);
            study.page.plot(name + "-" + kind + ".png");
        }
    }
    study.page.paragraph(
        "The eye is adapted before each step. Thresholds are those of cones for small differences at the new "
        "luminance. Pattanaik et al. 2000 have no "
        "threshold: its ratio is the inverse ratio of slopes of the cones' response, so that a step of constant "
        "response is seen.");
    apps::write_text(study.file("adaptation.csv"), csv_of(kColumns, rows));
    study.page.heading("All figures");
    study.page.table(kColumns, rows);
}

}  // namespace vesper::commands
