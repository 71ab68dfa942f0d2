// Study: headlamps by the distance at which a driver sees an obstacle. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "approach.h"
#include "arguments/arguments.h"
#include "arguments/cache_arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/setting_arguments.h"
#include "arguments/thread_arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "beam_plot.h"
#include "gathered_light.h"
#include "gpu_scene/cameras.h"
#include "io/file_gate.h"
#include "print.h"
#include "scene_notes.h"
#include "sightings.h"
#include "study.h"
#include "vision/visibility.h"

namespace vesper::commands {
namespace {

using apps::format;
namespace fs = std::filesystem;

constexpr const char* kOfScene = "scene";              // --beam
constexpr double kLeastPlotted = 0.1;                  // VL
constexpr double kMostDistances = 1000, kReach = 120;  // m, of the plot of a beam

struct HeadlampArguments {
    std::string scene, folder, device, size = "1260x788";
    ApproachSettings approach;
    std::vector<std::string> beams;
    std::vector<double> place, ages{25, 65};
    double from = 100, to = 10, step = 5, level = 7, picture_at = 50;
    unsigned threads = 0;
    apps::SettingArguments light;
    std::string cache;
    apps::ToneArguments tone;
};

/// What is driven again and again.
struct Condition {
    size_t beam = 0;
    bool oncoming = false;
    double age = 0;
};

/// A condition at a distance.
struct Measured {
    double distance = 0;
    render::SeenObstacle seen;
    render::ObstacleVisibility visibility;
};

std::vector<Beam> read_beams(const std::vector<std::string>& files) {
    std::vector<Beam> beams;
    std::set<std::string> names;
    for (const std::string& file : files) {
        const bool of_scene = file == kOfScene;
        beams.push_back({of_scene ? "as in the scene" : one_line(fs::path(file).stem().string()), {}});
        if (!names.insert(beams.back().name).second)
            throw Error("--beam " + one_line(file) + ": a second beam of the name " + beams.back().name);
        if (of_scene) continue;
        io::announce_read(file);
        beams.back().distribution = photometry::read_distribution(file);
    }
    return beams;
}

std::vector<double> distances_of(const HeadlampArguments& a) {
    if (a.from < a.to) throw Error("--from is less than --to: the car drives towards the obstacle");
    if ((a.from - a.to) / a.step > kMostDistances) throw Error("--step: there would be more than 1000 distances");
    std::vector<double> distances;
    for (double k = 0; a.from - k * a.step > a.to - 1e-9 * a.from; ++k) distances.push_back(a.from - k * a.step);
    return distances;
}

/// Why an obstacle has no level.
std::string why_without_level(const render::SeenObstacle& seen) {
    if (std::string why = render::words_of(seen.state); !why.empty()) return why;
    return seen.around + seen.veil < vision::kDarkestBackground ? "too dark" : "too bright";
}

class HeadlampStudy {
public:
    HeadlampStudy(const HeadlampArguments& a, std::vector<Beam> beams, scene::Scene scene)
        : arguments_(a),
          beams_(std::move(beams)),
          distances_(distances_of(a)),
          approach_(std::move(scene), a.approach, beams_),
          page_("Headlamps: who is seen from where") {
        for (const double age : a.ages)
            for (size_t beam = 0; beam < beams_.size(); ++beam)
                for (const bool oncoming : {false, true})
                    if (!oncoming || has_oncoming()) conditions_.push_back({beam, oncoming, age});
        picture_distance_ = *std::ranges::min_element(
            distances_, {}, [&](double distance) { return std::abs(distance - a.picture_at); });
        settings_.obstacles = scene::find_obstacles(approach_.scene(), {a.approach.obstacle}, "--obstacle");
        if (settings_.obstacles.size() != 1)
            throw Error("--obstacle " + one_line(a.approach.obstacle) + ": several nodes with surfaces match");
    }

    void render(const render::ToneChainSettings&);
    void write();

private:
    bool has_oncoming() const { return !arguments_.approach.oncoming.empty(); }
    std::string file(const std::string& name) const { return arguments_.folder + "/" + name; }
    std::string lamps_of(const Condition& c) const { return has_oncoming() ? (c.oncoming ? "on" : "off") : "none"; }
    std::vector<LevelAt> levels_of(size_t condition) const {
        std::vector<LevelAt> levels;
        for (const Measured& m : measured_[condition]) levels.push_back({m.distance, m.visibility.level});
        return levels;
    }
    std::string not_measured(size_t condition) const;
    void add_plot(double age);
    void add_beams();
    void write_rows();

    const HeadlampArguments& arguments_;
    std::vector<Beam> beams_;
    std::vector<double> distances_;
    Approach approach_;
    StudyPage page_;
    std::vector<Condition> conditions_;
    std::vector<std::vector<Measured>> measured_;  // by condition and distance
    double picture_distance_ = 0;
    std::vector<std::vector<StudyPage::Figure>> shown_;  // by beam
    render::RenderSettings settings_;
};

void HeadlampStudy::render(const render::ToneChainSettings& tone) {
    const VkExtent2D extent = apps::parse_size(arguments_.size);
    static_cast<render::ToneChainSettings&>(settings_) = tone;
    apps::apply_settings(arguments_.light, settings_);
    const std::shared_ptr<Cache> cache = apps::cache_of(arguments_.cache);
    gpu::Device device({.select = arguments_.device});
    render::Renderer renderer(device, approach_.scene(), cache);
    make_folder(arguments_.folder);
    const gpu_scene::SceneFrame first = approach_.at(distances_.front(), 0, false);
    apps::give_indirect(renderer, settings_, approach_.scene(), first.world, first.moving, cache.get());
    measured_.resize(conditions_.size()), shown_.resize(beams_.size());
    apps::Progress progress("rendering", unsigned(distances_.size() * conditions_.size()));
    for (const double distance : distances_)
        for (size_t i = 0; i < conditions_.size(); ++i) {
            const Condition& c = conditions_[i];
            const gpu_scene::SceneFrame moment = approach_.at(distance, c.beam, c.oncoming);
            const gpu_scene::View view =
                gpu_scene::camera_view(approach_.scene(), moment, arguments_.approach.camera, extent);
            settings_.scatter.eye.age = settings_.tone.observer.age = c.age;
            const bool shown = distance == picture_distance_ && c.age == arguments_.ages.front();
            renderer.reset_adaptation();
            const render::Frame frame = renderer.render(settings_, view, moment, 0, {.display = shown});
            const render::SeenObstacle& seen = frame.obstacles.front();
            measured_[i].push_back({distance, seen, render::visibility_of(seen, c.age)});
            apps::print_cache_note(frame.maps.note);
            progress.step();
            if (!shown) continue;
            const std::optional<double> level = measured_[i].back().visibility.level;
            const std::string name = format("beam-%zu-%s.png", c.beam + 1, lamps_of(c).c_str());
            apps::write_codes(file(name), frame, settings_.display);
            shown_[c.beam].push_back({name, format("%g m before it, %g years%s: ", distance, c.age,
                                                   has_oncoming() ? (", oncoming lamps " + lamps_of(c)).c_str() : "") +
                                                (level ? format("VL %.1f", *level) : why_without_level(seen))});
        }
}

/// The distances without a level, and why.
std::string HeadlampStudy::not_measured(size_t condition) const {
    std::string text;
    for (const Measured& m : measured_[condition]) {
        if (m.visibility.level) continue;
        text += (text.empty() ? "" : ", ") + format("%g m: ", m.distance) + why_without_level(m.seen);
    }
    return text;
}

void HeadlampStudy::add_plot(double age) {
    apps::LinePlot plot{.title = format("An observer of %g years: visibility level on the way", age),
                        .x_name = "before the obstacle, m",
                        .y_name = "visibility level, magnitude",
                        .lines = {},
                        .log_y = true,
                        .rule = arguments_.level};
    apps::PlotLine darker{.name = "dots: darker than around it", .points = {}, .marks = true};
    for (size_t i = 0; i < conditions_.size(); ++i) {
        const Condition& c = conditions_[i];
        if (c.age != age) continue;
        const std::vector<LevelAt> levels = levels_of(i);
        plot.lines.push_back({.name = one_line(beams_[c.beam].name, 16) + (c.oncoming ? ", oncoming on" : ""),
                              .points = level_line(levels, kLeastPlotted),
                              .dashed = c.oncoming,
                              .colour = c.beam});
        for (const LevelAt& at : levels)
            if (at.level && *at.level < 0)
                darker.points.insert(darker.points.end(),
                                     {{at.distance, std::max(-*at.level, kLeastPlotted)}, {NAN, NAN}});
    }
    darker.colour = 7;
    if (!darker.points.empty()) plot.lines.push_back(darker);
    const std::string name = format("levels-%g.png", age);
    apps::save_plot(file(name), plot);
    page_.plot(name);
}

void HeadlampStudy::add_beams() {
    for (size_t beam = 0; beam < beams_.size(); ++beam) {
        page_.heading(beams_[beam].name);
        page_.pictures(shown_[beam]);
        const std::string name = format("beam-%zu-road.png", beam + 1);
        save_beam_plot(file(name),
                       beams_[beam].name + ": horizontal illuminance of the road, as if nothing stood there", approach_,
                       beam, kReach);
        page_.plot(name);
    }
}

void HeadlampStudy::write_rows() {
    std::vector<std::vector<std::string>> rows;
    const std::vector<std::string> columns{"beam", "oncoming",        "age",          "distance",
                                           "vl",   "vl_without_veil", "luminance",    "around",
                                           "veil", "minutes",         "eye_distance", "state"};
    const auto number = [](const std::optional<double>& value) { return value ? format("%.4g", *value) : ""; };
    for (size_t i = 0; i < conditions_.size(); ++i)
        for (const Measured& m : measured_[i]) {
            const bool known = m.seen.state == render::SeenObstacle::State::Measured;
            const auto luminance = [&](double value) { return known ? format("%.5g", value) : ""; };
            rows.push_back({beams_[conditions_[i].beam].name, lamps_of(conditions_[i]),
                            format("%g", conditions_[i].age), format("%g", m.distance), number(m.visibility.level),
                            number(m.visibility.without_veil), luminance(m.seen.luminance), luminance(m.seen.around),
                            luminance(m.seen.veil), known ? format("%.3f", m.visibility.size) : "",
                            format("%.3f", m.seen.distance),
                            m.visibility.level ? "measured" : why_without_level(m.seen)});
        }
    apps::write_text(file("headlamps.csv"), csv_of(columns, rows));
}

void HeadlampStudy::write() {
    const HeadlampArguments& a = arguments_;
    page_.paragraph(
        format("%s, %s. The car of the camera drives towards it, from %g to %g m in steps of %g m; it stands %.2f m to "
               "the %s of the eye's way. Each of its %u headlamps shines with one of the beams, level and straight "
               "ahead, or as the scene has it.",
               one_line(fs::path(a.scene).filename().string()).c_str(), settings_.obstacles.front().name.c_str(),
               distances_.front(), distances_.back(), a.step, std::abs(approach_.aside()),
               approach_.aside() < 0 ? "left" : "right", approach_.headlamps()));
    page_.paragraph(format(
        "Visibility level VL after Adrian 1989, 0.2 s, %s. The "
        "obstacle is seen where |VL| is at least %g. VL is negative where the obstacle is darker than what "
        "is around it. Where VL changes its sign the obstacle has no contrast and is not seen, however near. "
        "Between distances VL is linear.",
        settings_.glare == render::Glare::None
            ? "without the veil of lamps in the eye (--glare none)"
            : ("with the veil of all lamps in the eye (--glare " + apps::text_of("glare", settings_) + ")").c_str(),
        a.level));
    std::vector<std::vector<std::string>> rows;
    const std::vector<std::string> columns{"beam", "oncoming lamps", "age", "seen", "darker at, m", "not measured"};
    for (size_t i = 0; i < conditions_.size(); ++i) {
        const std::vector<LevelAt> levels = levels_of(i);
        std::string darker;
        for (const LevelAt& at : levels)
            if (at.level && *at.level < 0) darker += (darker.empty() ? "" : " ") + format("%g", at.distance);
        rows.push_back({beams_[conditions_[i].beam].name, lamps_of(conditions_[i]), format("%g", conditions_[i].age),
                        words_of(levels, a.level), darker, not_measured(i)});
    }
    page_.heading("Seen");
    page_.table(columns, rows);
    apps::write_text(file("headlamps-seen.csv"), csv_of(columns, rows));
    for (const double age : a.ages) add_plot(age);
    add_beams();
    write_rows();
    apps::write_text(file("headlamps.html"), page_.html());
    for (const std::vector<std::string>& row : rows)
        apps::print("%s, oncoming lamps %s, %s years: %s%s\n", row[0].c_str(), row[1].c_str(), row[2].c_str(),
                    row[3] == kNotMeasured ? "" : "seen ", row[3].c_str());
    apps::print("%s\n", file("headlamps.html").c_str());
}

void run(HeadlampArguments& a) {
    const render::ToneChainSettings tone = apps::tone_settings(a.tone);
    if (tone.tone_operator == render::Operator::Ldr) throw Error("--operator ldr has no luminances to measure");
    apps::parse_size(a.size);
    if (!a.place.empty()) a.approach.obstacle_place = glm::dvec3(a.place[0], a.place[1], a.place[2]);
    std::ranges::sort(a.ages);
    a.ages.erase(std::unique(a.ages.begin(), a.ages.end()), a.ages.end());
    io::announce_read(a.scene);
    check_folder(a.folder);
    std::vector<Beam> beams = read_beams(a.beams);
    distances_of(a);
    scene::LoadedScene loaded = scene::read_scene(a.scene);
    apps::print_notes(apps::notes_of(loaded, a.scene));
    loaded.scene.name = a.scene;
    HeadlampStudy study(a, std::move(beams), std::move(loaded.scene));
    study.render(tone);
    study.write();
}

}  // namespace

void add_headlamps(apps::Command studies) {
    apps::Command command = studies.add_command(
        "headlamps", "Headlamps: from where a driver sees an obstacle, with and without oncoming lamps");
    const auto a = std::make_shared<HeadlampArguments>();
    a->tone.own.glare = render::Glare::Scatter;
    command.add_option("scene", a->scene, "A .gltf or .glb, as vesper convert writes it").required();
    command.add_option("--output,-o", a->folder, "Folder of the page, its pictures, CSV and plots").required();
    command.add_option("--camera,-c", a->approach.camera, "Name of a camera that rides in a car (default: the first)");
    command
        .add_option("--obstacle", a->approach.obstacle, "Node of the obstacle; *, ? and parent/node, as in --without")
        .required();
    command.add_option("--place-obstacle", a->place, "Where its origin is to be: X,Y,Z in m of the scene")
        .separated_by(',')
        .values(3)
        .check(apps::between(-1e6, 1e6));
    command
        .add_option("--beam", a->beams,
                    "Distribution of each headlamp: .ies, .ldt, .csv or .exr (docs/distributions.md), or scene: those "
                    "of the scene; may be given several times")
        .required()
        .repeats();
    command.add_option("--headlamps", a->approach.headlamps, "Nodes of the car that are its headlamps").shows_default();
    command.add_option("--oncoming", a->approach.oncoming,
                       "Nodes, such as a car, whose lamps are on and off; else there is one way for each beam");
    command
        .add_option("--without", a->approach.without,
                    "Nodes that are left out, such as cars in the way, but for the others; may be given several "
                    "times")
        .repeats();
    command.add_option("--ages", a->ages, "Ages of observers, years")
        .separated_by(',')
        .check(apps::between(1.0, 120.0))
        .shows_default();
    command.add_option("--from", a->from, "First distance from the eye to the middle of the obstacle, m")
        .check(apps::between(1.0, 1000.0))
        .shows_default();
    command.add_option("--to", a->to, "Last distance, m").check(apps::between(1.0, 1000.0)).shows_default();
    command.add_option("--step", a->step, "Between distances, m").check(apps::between(0.1, 1000.0)).shows_default();
    command.add_option("--level", a->level, "Visibility level from which on it is seen")
        .check(apps::between(0.1, 1000.0))
        .shows_default();
    command.add_option("--picture-at", a->picture_at, "Distance of the pictures, m")
        .check(apps::between(0.0, 1000.0))
        .shows_default();
    command.add_option("--size,-s", a->size, "WIDTHxHEIGHT, px").shows_default();
    command.add_option("--device", a->device,
                       "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    apps::add_thread_option(command, a->threads);
    command.add_allow_outside();
    add_light_options(command, a->light, a->cache);
    apps::add_tone_options(command, a->tone);
    command.footer(
        "Example:\n  vesper study headlamps night.gltf --camera driver --obstacle pedestrian_00 "
        "--place-obstacle 2.4,0,-35 \\\n    --without 'car_traffic_*' --oncoming car_traffic_007 --beam low-beam.csv "
        "--beam scene -o out/headlamps\n");
    command.callback([a, command] {
        if (command.count("--age") > 0) throw Error("--age has no meaning here: --ages has the observers");
        apps::use_threads(a->threads);
        run(*a);
    });
}

}  // namespace vesper::commands
