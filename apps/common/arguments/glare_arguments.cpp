#include "arguments/glare_arguments.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "arguments/tone_arguments.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/luminance.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "photometry/table.h"
#include "print.h"

namespace vesper::apps {
namespace {

using vision::GlareReport;

constexpr size_t kMostLamps = 10000;
constexpr uint64_t kMostLampBytes = 4u << 20;  // of their file

struct Named {
    const char* name;
    double GlareReport::*value;
};
constexpr Named kNames[]{{"veil", &GlareReport::veil},
                         {"road_veil", &GlareReport::road_veil},
                         {"ti", &GlareReport::increment},
                         {"background", &GlareReport::background},
                         {"glare_lux", &GlareReport::illuminance},
                         {"target", &GlareReport::target},
                         {"around", &GlareReport::around},
                         {"target_veil", &GlareReport::target_veil},
                         {"visibility", &GlareReport::visibility},
                         {"pupil", &GlareReport::pupil},
                         {"eye_seed", &GlareReport::eye_seed}};

/// A row of words: no cell of it begins as a number does.
bool is_heading(const std::vector<std::string_view>& cells) {
    return std::none_of(cells.begin(), cells.end(), [](std::string_view cell) {
        const size_t first = cell.find_first_not_of("\" \t");
        return first != cell.npos && std::string_view("0123456789+-.").find(cell[first]) != std::string_view::npos;
    });
}

/// Headings name the columns, or their units, and nothing else.
void check_heading(const photometry::LineReader& lines, const std::vector<std::string_view>& cells) {
    static const std::set<std::string> kColumns[]{
        {"azimuth", "az", "right", "horizontal", "h", "deg", "degree", "degrees"},
        {"elevation", "el", "up", "vertical", "v", "deg", "degree", "degrees"},
        {"illuminance", "e", "ev", "lx", "lux"}};
    static const std::set<std::string> kOthers{"angle", "to",        "the",      "of",        "at",
                                               "in",    "eye",       "lamp",     "light",     "source",
                                               "glare", "direction", "position", "intensity", "v"};
    constexpr const char* kWanted =
        "the columns are azimuth (to the right, degrees), elevation (up, degrees) and illuminance at the eye (lx)";
    if (cells.size() != 3) lines.fail(kWanted);
    for (size_t i = 0; i < cells.size(); ++i) {
        bool named = false;
        for (const std::string& word : photometry::words_of(cells[i])) {
            named |= kColumns[i].contains(word);
            if (!kColumns[i].contains(word) && !kOthers.contains(word))
                lines.fail(photometry::quoted(word) + " in " + photometry::quoted(cells[i]) + ": " + kWanted);
        }
        if (!named) lines.fail(photometry::quoted(cells[i]) + ": " + kWanted);
    }
}

/// Semicolons and tabs leave the comma to decimals.
char separator_of(std::string_view line) {
    if (line.find(';') != line.npos) return ';';
    return std::count(line.begin(), line.end(), '\t') == 2 ? '\t' : ',';
}

}  // namespace

void add_glare_options(Command command, GlareArguments& a) {
    command.help_group("Glare");
    command.add_option("--lamps", a.lamps,
                       "CSV file of lamps on other screens, to be scattered into this one with --glare cie, spencer or "
                       "ward: degrees to the right, degrees up, lx at the eye");
    command
        .add_option("--target", a.target,
                    "X,Y,WIDTH,HEIGHT, parts of the image from its top left: prints how visible it is, as logs and "
                    ".exr files say it, too")
        .separated_by(',')
        .values(4)
        .check(between(0.0, 1.0));
    command.help_group();
}

std::vector<eye::OffscreenLamp> read_lamps(const std::string& file) {
    std::vector<eye::OffscreenLamp> lamps;
    if (file.empty()) return lamps;
    const std::vector<uint8_t> bytes = io::read_file(file, kMostLampBytes);
    photometry::LineReader lines(bytes, one_line(file));
    while (const auto line = lines.next()) {
        const std::string_view text = photometry::trimmed(*line);
        if (text.empty() || text.front() == '#') continue;
        const char separator = separator_of(text);
        const auto fields = photometry::fields_of(text, separator, 3);
        if (lamps.empty() && is_heading(fields)) {
            check_heading(lines, fields);
            continue;
        }
        std::optional<double> values[3];
        for (size_t i = 0; i < 3 && fields.size() == 3; ++i)
            values[i] = photometry::number_of(fields[i], separator != ',');
        if (!values[0] || !values[1] || !values[2]) lines.fail("expected degrees to the right, degrees up, lx");
        const double azimuth = *values[0], elevation = *values[1], lux = *values[2];
        if (std::abs(azimuth) > 180 || std::abs(elevation) > 90 || lux < 0 || lux > 1e9)
            lines.fail("degrees of -180 to 180 and -90 to 90 and 0 to 1e9 lx are expected");
        if (lamps.size() == kMostLamps) lines.fail("more than " + std::to_string(kMostLamps) + " lamps");
        const double a = azimuth / kDegreesPerRadian, e = elevation / kDegreesPerRadian;
        lamps.push_back({{std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e)}, glm::dvec3(lux)});
    }
    return lamps;
}

GlareReport glare_of(const GlareArguments& arguments, const render::ToneChainSettings& settings,
                     const render::ToneMapped& shown, const vision::ImageAngles& image,
                     const std::vector<eye::OffscreenLamp>& outside) {
    std::vector<vision::DazzlingLight> lamps;
    for (const eye::OffscreenLamp& lamp : outside) lamps.push_back({lamp.direction, luminance(lamp.illuminance)});
    vision::GlareQuestion question{.eye = settings.scatter.eye, .gaze = glm::dvec2(settings.tone.gaze)};
    if (const auto& t = arguments.target; t.size() == 4)
        question.target = vision::MarkedTarget{{t[0], t[1]}, {t[2], t[3]}};
    GlareReport report;
    try {
        report = vision::report_glare(image, shown.scene, lamps, question);
    } catch (const Error& error) {
        throw Error(std::string("--target: ") + error.what());
    }
    report.pupil = shown.pupil;
    if (settings.glare == render::Glare::Scatter && settings.scatter.has_corona())
        report.eye_seed = settings.scatter.aperture.seed;
    return report;
}

void check_target(const GlareArguments& arguments, const render::ToneChainSettings& settings) {
    if (!arguments.target.empty() && settings.tone_operator == render::Operator::Ldr)
        throw Error("--target: the ldr operator has no luminances to measure");
}

std::string target_line(const GlareReport& r) {
    return format("target %.4g cd/m^2 on %.4g cd/m^2, veil %.4g cd/m^2, visibility level %.3g\n", r.target, r.around,
                  r.target_veil, r.visibility);
}

io::Header describe_glare(const GlareReport& report) {
    io::Header header;
    for (const Named& n : kNames) header.emplace_back(std::string("vesper:glare:") + n.name, digits(report.*n.value));
    return header;
}

std::string glare_columns() {
    std::string text;
    for (const Named& n : kNames) text += std::string(",") + n.name;
    return text;
}

std::string glare_values(const GlareReport& report) {
    std::string text;
    for (const Named& n : kNames) text += format(",%.9g", report.*n.value);
    return text;
}

std::string glare_sources_heading() { return "frame,lamp,azimuth,elevation,distance,candela,lux,veil,inside\n"; }

std::string glare_sources_lines(unsigned frame, const scene::Scene& scene, std::vector<gpu_scene::GlareSource> sources,
                                const vision::ScatteringEye& eye) {
    std::stable_sort(sources.begin(), sources.end(),
                     [](const gpu_scene::GlareSource& a, const gpu_scene::GlareSource& b) {
                         return luminance(a.illuminance) > luminance(b.illuminance);
                     });
    std::string text;
    for (const gpu_scene::GlareSource& s : sources) {
        const double cosine = -s.direction.z, theta = std::acos(std::clamp(cosine, -1.0, 1.0)) * kDegreesPerRadian,
                     lux = luminance(s.illuminance);
        std::string name = scene.nodes[s.node].name;
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ' ');
        text += format("%u,%s,%.4f,%.4f,%.3f,%.6g,%.6g,%.6g,%.3f\n", frame, name.c_str(),
                       std::atan2(s.direction.x, -s.direction.z) * kDegreesPerRadian,
                       std::asin(s.direction.y) * kDegreesPerRadian, s.distance, s.candela, lux,
                       lux * cosine * vision::cie_general_glare(std::max(theta, 0.1), eye), s.inside);
    }
    return text;
}

}  // namespace vesper::apps
