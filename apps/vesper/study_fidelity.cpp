// Study: what displays show of the contrast of a scene, operator by operator. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "analysis/contrast_fidelity.h"
#include "analysis/display_light.h"
#include "analysis/fixations.h"
#include "analysis/saliency_mapper.h"
#include "arguments/arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "plots/false_colour.h"
#include "print.h"
#include "render/passes/saliency.h"
#include "render/retina.h"
#include "scene/display_file.h"
#include "study.h"

namespace vesper::commands {
namespace {

using apps::format;

const std::vector<std::string> kFidelityColumns{"picture", "display",  "operator",  "seen",
                                                "lost",    "invented", "amplified", "saliency"};
constexpr apps::CanvasColour kLost{1, 0.25, 0.2}, kInvented{0.3, 0.55, 1}, kAmplified{0.35, 0.9, 0.3};

struct NamedScreen {
    std::string name;
    vision::Display display;
};

std::vector<NamedScreen> screens_of(const Study& study) {
    const std::string& one = study.arguments.tone.display;
    std::vector<NamedScreen> screens;
    if (!study.arguments.displays.empty() && !one.empty()) throw Error("--displays: stands in place of --display");
    for (const std::string& name : study.arguments.displays) {
        apps::DisplayArguments described = study.arguments.tone;  // each with what --display-ambient and others change
        described.display = name;
        screens.push_back({name, apps::display_of(described)});
    }
    if (screens.empty())
        screens.push_back({one.empty() ? vision::known_displays().front().name : one, study.settings.display});
    return screens;
}

/// A scene as its eye sees it.
struct SeenScene {
    std::vector<float> retina;  ///< cd/m^2
    analysis::SaliencyMap saliency;
    double pixels_per_degree = 0;
};

class Eye {
public:
    Eye(Study& study, analysis::SaliencyMapper& saliency) : study_(study), saliency_(saliency) {}

    std::vector<float> retina(const render::HostPicture& picture) const {
        return render::retinal_luminance(study_.mapper, picture,
                                         eye::ScatterSettings{.eye = study_.settings.scatter.eye});
    }
    /// Without a map where a picture is too small for one.
    analysis::SaliencyMap saliency(const render::HostPicture& picture) const {
        return render::saliency_pairs(picture.extent).empty() ? analysis::SaliencyMap{} : saliency_.map(picture);
    }
    SeenScene scene(const StudyPicture& picture) const {
        try {
            return {retina(picture.host()), saliency(picture.host()), render::pixels_per_degree(picture.host())};
        } catch (const Error& error) {
            throw Error(one_line(picture.name) + ": " + error.what());
        }
    }

private:
    Study& study_;
    analysis::SaliencyMapper& saliency_;
};

std::string name_of_file(const StudyPicture& picture, const std::string& display, render::Operator op) {
    std::string name = picture.name + "-" + display + "-" + apps::name_of(op);
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
}

/// Lost, invented and amplified contrast in their colours over the scene in dim greys.
void save_map(const std::string& file, const StudyPicture& picture, const SeenScene& scene,
              const analysis::ContrastFidelity& found) {
    constexpr uint32_t kWidest = 840;
    const VkExtent2D full = picture.extent;
    const double zoom = std::min(1.0, double(kWidest) / full.width);
    const uint32_t width = std::max(1u, uint32_t(full.width * zoom)),
                   height = std::max(1u, uint32_t(full.height * zoom));
    const auto small = [&](const std::vector<float>& values) {
        return apps::resized({full.width, full.height, values}, width, height);
    };
    const apps::ValuePicture lost = small(found.lost), invented = small(found.invented),
                             amplified = small(found.amplified);
    const std::vector<uint8_t> rgba = apps::tinted(small(scene.retina), [&](size_t i) -> apps::Tint {
        const double l = double(lost.values[i]), v = double(invented.values[i]), a = double(amplified.values[i]),
                     sum = l + v + a;
        if (!(sum > 0)) return {};
        // One octave of six is seen as a colour, too.
        return {(l * kLost + v * kInvented + a * kAmplified) / sum, std::sqrt(std::min(1.0, sum))};
    });
    apps::Canvas canvas(std::max(width, 320u), height + 24);
    canvas.pixels(0, 0, width, height, rgba);
    double x = 4;
    for (const auto& [name, colour] :
         {std::pair("lost", kLost), std::pair("invented", kInvented), std::pair("amplified", kAmplified)}) {
        canvas.fill({x, double(height) + 6}, {12, 12}, colour);
        canvas.text({x + 17, double(height) + 12}, name, 12);
        x += 90;
    }
    canvas.save(file);
}

}  // namespace

void study_fidelity(Study& study) {
    std::vector<render::Operator> all;
    for (const render::OperatorInfo& op : render::operators())
        if (op.tone_operator != render::Operator::Ldr) all.push_back(op.tone_operator);
    const std::vector<render::Operator> ops = studied_operators(study.arguments, all, "it does not show luminance");
    const std::vector<NamedScreen> screens = screens_of(study);
    if (study.settings.glare != render::Glare::None)
        throw Error("--glare: light is scattered in the eye of the driver and in that of the display's observer");
    for (const StudyPicture& picture : study.pictures)
        if (!picture.is_absolute)
            throw Error(one_line(picture.name) +
                        ": its unit and its angle are needed: --unit N, cd/m^2 of its 1.0, and --fov DEGREES");
    analysis::SaliencyMapper saliency(study.device);
    const Eye eye(study, saliency);
    const vision::ScatteringEye& scatters = study.settings.scatter.eye;
    const analysis::ContrastEye contrast_eye{.age = scatters.age, .scatters = scatters};
    study.page.paragraph(
        format("An observer of %g years, adapted to the scene and to the display in turn. Shares of all places and "
               "octaves of frequency. Seen: contrast of at least %g thresholds in the scene. Lost: seen in the scene, "
               "below one threshold on the display. Invented: the reverse. Amplified: seen in the scene, and at least "
               "%g times as many thresholds on the display. Saliency: rank correlation of what draws the eye in the "
               "scene and on the display.",
               contrast_eye.age, analysis::kSeen, analysis::kAmplified));
    std::vector<SeenScene> scenes;
    for (const StudyPicture& picture : study.pictures) scenes.push_back(eye.scene(picture));
    const size_t of_picture = screens.size() * ops.size();
    const auto make = [&](size_t condition) {
        const StudyPicture& picture = study.pictures[condition / of_picture];
        const SeenScene& scene = scenes[condition / of_picture];
        const auto& [display_name, display] = screens[condition % of_picture / ops.size()];
        const render::Operator op = ops[condition % ops.size()];
        render::ToneChainSettings settings = study.settings;
        settings.tone_operator = op, settings.display = display;
        const render::ToneMapped got = study.map(picture, settings);
        const std::vector<float> light = analysis::DisplayLight(display).of_words(got.display);
        const render::HostPicture shown = picture.like(light, 3, 1);
        const std::vector<float> retina = eye.retina(shown);
        const analysis::ContrastFidelity found = analysis::contrast_fidelity(
            {picture.extent.width, picture.extent.height, scene.pixels_per_degree, scene.retina, retina}, contrast_eye);
        const std::optional<double> kept =
            analysis::rank_correlation(scene.saliency.values, eye.saliency(shown).values);
        const double seen = analysis::mean_of(found.seen), lost = analysis::mean_of(found.lost),
                     invented = analysis::mean_of(found.invented), amplified = analysis::mean_of(found.amplified);
        const std::string name = name_of_file(picture, display_name, op), op_name = apps::name_of(op);
        StudyPart part;
        part.rows.push_back({picture.name, display_name, op_name, format("%.4f", seen), format("%.4f", lost),
                             format("%.4f", invented), format("%.4f", amplified), kept ? format("%.3f", *kept) : ""});
        apps::write_codes(study.file(name + ".png"), got, display);
        save_map(study.file(name + "-map.png"), picture, scene, found);
        part.shown = {{name + ".png", format("%s on %s", op_name.c_str(), display_name.c_str())},
                      {name + "-map.png", format("of %.1f %% seen, lost %.1f %%; invented %.1f %%, amplified %.1f %%",
                                                 100 * seen, 100 * lost, 100 * invented, 100 * amplified)}};
        return part;
    };
    const std::vector<StudyPart> parts = study.parts("fidelity", study.pictures.size() * of_picture, make);
    if (parts.empty()) return;
    std::vector<std::vector<std::string>> rows;
    for (size_t p = 0; p < study.pictures.size(); ++p) {
        std::vector<StudyPage::Figure> shown;
        for (const StudyPart& part : std::span(parts).subspan(p * of_picture, of_picture)) {
            rows.insert(rows.end(), part.rows.begin(), part.rows.end());
            shown.insert(shown.end(), part.shown.begin(), part.shown.end());
        }
        study.page.heading(study.pictures[p].name);
        study.page.pictures(shown);
    }
    apps::write_text(study.file("fidelity.csv"), csv_of(kFidelityColumns, rows));
    study.page.heading("All figures");
    study.page.table(kFidelityColumns, rows);
}

}  // namespace vesper::commands
