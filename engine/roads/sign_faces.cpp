// The faces of traffic signs. SPDX-License-Identifier: MIT
#include "roads/sign_faces.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/angle.h"
#include "base/lower.h"

namespace vesper::roads {
namespace {

constexpr double kLayer = 0.002;  // m between prints
constexpr double kThick = 0.02;   // m of a panel
constexpr double kBefore = 0.05;  // m from the signal's place to the back of a panel

enum class Shape : uint8_t { Round, Triangle, Inverted, Octagon, Diamond, Rectangle };

struct Face {
    Shape shape = Shape::Rectangle;
    RoadMaterial rim = RoadMaterial::SignWhite, field = RoadMaterial::SignWhite;
    int number = -1;       ///< a speed, km/h
    bool bar = false;      ///< no entry
    bool stripes = false;  ///< red and white
    bool crossed_out = false;
};

/// The reader looks at the panel from +x: to his right is +y.
struct Panel {
    RoadMesh& mesh;
    BodyFrame frame;
    double width, height;

    glm::dvec3 at(double right, double up, int layer) const {
        return frame.at(kLayer * layer, right * width / 2, height / 2 + up * height / 2);
    }

    std::vector<glm::dvec2> outline(Shape shape, double scale) const {
        std::vector<glm::dvec2> points;
        const auto ring = [&](int corners, double first, double radius) {
            for (int i = 0; i < corners; ++i)
                points.emplace_back(radius * std::cos(first + 2 * kPi * i / corners),
                                    radius * std::sin(first + 2 * kPi * i / corners));
        };
        switch (shape) {
            case Shape::Round:
                ring(24, 0, scale);
                break;
            case Shape::Octagon:
                ring(8, kPi / 8, scale / std::cos(kPi / 8));
                break;
            case Shape::Diamond:
                ring(4, 0, scale);
                break;
            // Scaled about the middle of the triangle, a third up.
            case Shape::Triangle:
                points = {{-scale, -1.0 / 3 - 2.0 / 3 * scale},
                          {scale, -1.0 / 3 - 2.0 / 3 * scale},
                          {0, -1.0 / 3 + 4.0 / 3 * scale}};
                break;
            case Shape::Inverted:
                points = {{-scale, 1.0 / 3 + 2.0 / 3 * scale},
                          {0, 1.0 / 3 - 4.0 / 3 * scale},
                          {scale, 1.0 / 3 + 2.0 / 3 * scale}};
                break;
            case Shape::Rectangle: {
                const double rim = (1 - scale) * std::min(width, height), u = 1 - rim / width, v = 1 - rim / height;
                points = {{-u, -v}, {u, -v}, {u, v}, {-u, v}};
            }
        }
        return points;
    }

    void print(RoadMaterial stuff, const std::vector<glm::dvec2>& points, int layer) const {
        std::vector<glm::dvec3> corners;
        for (const glm::dvec2& p : points) corners.push_back(at(p.x, p.y, layer));
        mesh.polygon(stuff, corners);
    }

    /// A bar between two points, `thick` of the height.
    void bar(RoadMaterial stuff, glm::dvec2 from, glm::dvec2 to, double thick, int layer) const {
        const glm::dvec2 size(width, height), along = glm::normalize((to - from) * size),
                                              side = glm::dvec2(-along.y, along.x) * thick * height / size;
        print(stuff, {from - side, to - side, to + side, from + side}, layer);
    }

    void back(const std::vector<glm::dvec2>& points) const {
        std::vector<glm::dvec3> corners;
        for (const glm::dvec2& p : points)
            corners.push_back(frame.at(-kThick, p.x * width / 2, height / 2 + p.y * height / 2));
        std::reverse(corners.begin(), corners.end());
        mesh.polygon(RoadMaterial::SignBack, corners);
        for (size_t i = 0; i < points.size(); ++i) {
            const glm::dvec2 a = points[i], b = points[(i + 1) % points.size()];
            const auto behind = [&](glm::dvec2 p) {
                return frame.at(-kThick, p.x * width / 2, height / 2 + p.y * height / 2);
            };
            mesh.quad(RoadMaterial::SignBack, at(b.x, b.y, 0), at(a.x, a.y, 0), behind(a), behind(b));
        }
    }

    /// Digits of seven strokes.
    void number(int value) const {
        // Top, upper right, lower right, bottom, lower left, upper left, middle.
        constexpr std::array<uint8_t, 10> kStrokes{0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f};
        const std::string digits = std::to_string(value);
        const double wide = digits.size() > 2 ? 0.26 : 0.36, half = 0.36, gap = wide * 1.45;
        for (size_t i = 0; i < digits.size(); ++i) {
            const double x = (static_cast<double>(i) - (static_cast<double>(digits.size()) - 1) / 2) * gap,
                         l = x - wide / 2, r = x + wide / 2;
            const std::array<std::pair<glm::dvec2, glm::dvec2>, 7> lines{{{{l, half}, {r, half}},
                                                                          {{r, 0}, {r, half}},
                                                                          {{r, -half}, {r, 0}},
                                                                          {{l, -half}, {r, -half}},
                                                                          {{l, -half}, {l, 0}},
                                                                          {{l, 0}, {l, half}},
                                                                          {{l, 0}, {r, 0}}}};
            for (size_t stroke = 0; stroke < lines.size(); ++stroke)
                if (kStrokes[static_cast<size_t>(digits[i] - '0')] >> stroke & 1) {
                    glm::dvec2 a = lines[stroke].first, b = lines[stroke].second;
                    if (a.x == b.x) a.y -= 0.045, b.y += 0.045;
                    bar(RoadMaterial::SignBlack, a, b, 0.06, 2);
                }
        }
    }
};

Face speed_limit(double value) {
    return {Shape::Round, RoadMaterial::SignRed, RoadMaterial::SignWhite,
            std::clamp(static_cast<int>(std::lround(value)), 0, 999)};
}

/// "60" of "60-1"; 0 without digits.
int leading_number(const std::string& text) {
    int value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

/// Signs of Germany, which most files are made with, by their number in the StVO.
Face german(int number, const RoadSignal& s) {
    switch (number) {
        case 205:
            return {Shape::Inverted, RoadMaterial::SignRed, RoadMaterial::SignWhite};
        case 206:
            return {Shape::Octagon, RoadMaterial::SignWhite, RoadMaterial::SignRed};
        case 274:
            return speed_limit(s.value > 0 ? s.value : leading_number(s.subtype));
        case 267:
            return {.shape = Shape::Round, .rim = RoadMaterial::SignWhite, .field = RoadMaterial::SignRed, .bar = true};
        case 278:
        case 280:
        case 282:
            return {.shape = Shape::Round,
                    .rim = RoadMaterial::SignBlack,
                    .field = RoadMaterial::SignWhite,
                    .crossed_out = true};
        case 306:
            return {Shape::Diamond, RoadMaterial::SignWhite, RoadMaterial::SignYellow};
        case 605:
        case 600:
        case 626:
            return {.shape = Shape::Rectangle, .stripes = true};
        default:
            break;
    }
    if (number >= 101 && number < 165) return {Shape::Triangle, RoadMaterial::SignRed, RoadMaterial::SignWhite};
    if (number >= 209 && number < 240) return {Shape::Round, RoadMaterial::SignWhite, RoadMaterial::SignBlue};
    if (number >= 250 && number < 290) return {Shape::Round, RoadMaterial::SignRed, RoadMaterial::SignWhite};
    if (number == 310 || number == 311 || (number >= 415 && number < 420) || number == 436 || number == 438 ||
        number == 439)
        return {Shape::Rectangle, RoadMaterial::SignBlack, RoadMaterial::SignYellow};
    if (number >= 314 && number < 460) return {Shape::Rectangle, RoadMaterial::SignWhite, RoadMaterial::SignBlue};
    return {};
}

Face face_of(const RoadSignal& s) {
    const std::string country = lower(s.country), name = lower(s.name), type = lower(s.type);
    if (country == "de" || country == "ger" || country == "germany" || country == "276")
        if (const int number = leading_number(type); number > 0) return german(number, s);
    if (country == "se" && type == "c") {
        if (s.subtype == "31")
            return speed_limit(s.value < 13 ? 10 * s.value : s.value);  // esmini's catalogue counts in tens
        return {Shape::Round, RoadMaterial::SignRed, RoadMaterial::SignYellow};
    }
    if (country == "se" && type == "a") return {Shape::Triangle, RoadMaterial::SignRed, RoadMaterial::SignYellow};
    const bool speed = name.find("speed") != name.npos || name.find("limit") != name.npos || type == "274" ||
                       (s.unit == "km/h" && s.value > 0) || s.unit == "mph";
    if (speed && s.value > 0) return speed_limit(s.value);
    if (name.find("stop") != name.npos) return {Shape::Octagon, RoadMaterial::SignWhite, RoadMaterial::SignRed};
    if (name.find("yield") != name.npos || name.find("give") != name.npos)
        return {Shape::Inverted, RoadMaterial::SignRed, RoadMaterial::SignWhite};
    return {};
}

}  // namespace

void add_sign(RoadMesh& mesh, const BodyFrame& frame, const RoadSignal& signal, double width, double height) {
    const Face face = face_of(signal);
    // Before the signal's place, where files have poles, and other signs back to back.
    const Panel panel{mesh, frame.moved(kBefore + kThick, 0, 0), width, height};
    const auto outline = panel.outline(face.shape, 1);
    panel.back(outline);
    panel.print(face.rim, outline, 0);
    const double rim = face.rim == face.field                                                  ? 1
                       : face.shape == Shape::Rectangle || face.rim == RoadMaterial::SignWhite ? 0.93
                       : face.shape == Shape::Round                                            ? 0.8
                                                                                               : 0.68;
    if (rim < 1) panel.print(face.field, panel.outline(face.shape, rim), 1);
    if (face.number >= 0) panel.number(face.number);
    if (face.bar) panel.bar(RoadMaterial::SignWhite, {-0.7, 0}, {0.7, 0}, 0.1, 2);
    if (face.crossed_out) panel.bar(RoadMaterial::SignBlack, {-0.5, -0.5}, {0.5, 0.5}, 0.06, 2);
    if (face.stripes)
        for (int i = 0; i < 4; ++i)
            panel.print(RoadMaterial::SignRed,
                        {{-1, -0.9 + 0.5 * i - 0.1},
                         {1, -0.9 + 0.5 * i + 0.15},
                         {1, -0.65 + 0.5 * i + 0.15},
                         {-1, -0.65 + 0.5 * i - 0.1}},
                        1);
}

bool is_painted(const RoadSignal& s) {
    const std::string name = lower(s.name);
    if (name.starts_with("sgrm") || name.find("stopline") != name.npos || name.find("holdingline") != name.npos)
        return true;
    const int number = leading_number(s.type);
    return lower(s.country) == "de" && ((number >= 293 && number <= 299) || number == 341);
}

bool stands_on_ground(const RoadSignal& s) {
    const std::string name = lower(s.name);
    for (const char* word : {"barrier", "beacon", "delineator", "chevron", "bollard"})
        if (name.find(word) != name.npos) return true;
    const int number = leading_number(s.type);  // StVO, annex 4: 600 to 629 stand at works and in bends
    return lower(s.country) == "de" && number >= 600 && number < 630;
}

bool is_traffic_light(const RoadSignal& s) {
    const int number = leading_number(s.type);
    const bool country = s.country.empty() || lower(s.country) == "opendrive" || lower(s.country) == "ger";
    return (s.dynamic && (number >= 1'000'000 || number <= 0)) ||
           (country && number >= 1'000'000 && number < 1'000'100);
}

bool is_for_pedestrians(const RoadSignal& s) {
    return leading_number(s.type) == 1'000'002 || leading_number(s.type) == 1'000'003;
}

}  // namespace vesper::roads
