#include "vision/glare_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/angle.h"
#include "base/error.h"
#include "base/luminance.h"
#include "vision/visibility.h"

namespace vesper::vision {
namespace {

using glm::dvec2, glm::dvec3;

constexpr double kBackground = 10;        // deg about the line of sight
constexpr double kLooked = 0.1;           // deg: nearer is not beside the line of sight
constexpr double kLeastLuminance = 1e-4;  // cd/m^2: what is darker is left out of the log average

// E cos(theta) f(theta), summed.
struct Veils {
    double illuminance = 0, general = 0, road = 0;
};

Veils veils_of(const std::vector<DazzlingLight>& lamps, dvec3 sight, const ScatteringEye& eye) {
    Veils sum;
    for (const DazzlingLight& light : lamps) {
        const double cosine = std::min(glm::dot(light.direction, sight), 1.0),
                     theta = std::acos(cosine) * kDegreesPerRadian;
        if (cosine <= 0) continue;
        const double e = light.illuminance * cosine;
        sum.illuminance += e;
        if (theta < kLooked) continue;
        sum.general += e * cie_general_glare(theta, eye);
        sum.road += e * en13201_glare(theta, eye.age);
    }
    return sum;
}

class Pixels {
public:
    Pixels(const ImageAngles& image, std::span<const float> rgba) : image_(image), rgba_(rgba), pixel_(image.pixel()) {}
    double luminance(int x, int y) const {
        const float* p = &rgba_[4 * (size_t(y) * size_t(image_.width) + size_t(x))];
        const double value = vesper::luminance(dvec3(p[0], p[1], p[2]));
        return std::isfinite(value) ? value : 0;
    }
    /// From the eye; z is -1.
    dvec3 towards(int x, int y) const { return {image_.at(dvec2(x, y) + 0.5), -1}; }
    double solid_angle(dvec3 towards) const { return pixel_.x * pixel_.y * steradians_per_area(dvec2(towards)); }

private:
    const ImageAngles& image_;
    std::span<const float> rgba_;
    dvec2 pixel_;
};

// What is bright is so beside exp(mean ln L) of the pixels that have light, cd/m^2: a sky of 0 says nothing. Where
// lamps are all that has light, the mean of all pixels is less.
double ordinary_luminance(const ImageAngles& image, const Pixels& pixels) {
    double logarithms = 0, lit = 0, sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double value = pixels.luminance(x, y);
            sum += value;
            if (value > kLeastLuminance) logarithms += std::log(value), ++lit;
        }
    return lit > 0 ? std::min(std::exp(logarithms / lit), sum / (double(image.width) * image.height)) : kLeastLuminance;
}

struct Mean {
    double sum = 0, weight = 0;
    void add(double value, double w) { sum += w * value, weight += w; }
    double value() const { return weight > 0 ? sum / weight : 0; }
};

void report_target(const ImageAngles& image, const Pixels& pixels, const std::vector<DazzlingLight>& lamps,
                   const GlareQuestion& question, double source_luminance, GlareReport& report) {
    const dvec2 extent(image.width, image.height);
    const dvec2 low = question.target->corner * extent, high = low + question.target->size * extent,
                border = high - low;
    Mean target, around;
    for (int y = int(std::max(0.0, low.y - border.y)); y < std::min(extent.y, high.y + border.y); ++y)
        for (int x = int(std::max(0.0, low.x - border.x)); x < std::min(extent.x, high.x + border.x); ++x) {
            const bool within = x + 0.5 >= low.x && x + 0.5 < high.x && y + 0.5 >= low.y && y + 0.5 < high.y;
            const double value = pixels.luminance(x, y);
            if (within || value <= source_luminance) (within ? target : around).add(value, 1);
        }
    if (!(target.weight > 0)) throw Error("no pixel has its centre in the target");
    if (!(around.weight > 0))
        throw Error("there is nothing around the target, of a frame of its own width, but sources of glare");
    const dvec2 middle = image.at(0.5 * (low + high));
    report.target = target.value();
    report.around = around.value();
    report.target_veil = veils_of(lamps, glm::normalize(dvec3(middle, -1)), question.eye).general;
    const dvec2 span = border * image.pixel();
    const double steradians = span.x * span.y * steradians_per_area(middle);
    Target seen{.age = question.eye.age};
    seen.size = disc_minutes(steradians);
    if (report.around + report.target_veil > 0)
        report.visibility =
            visibility_level(report.target + report.target_veil, report.around + report.target_veil, seen);
}

}  // namespace

GlareReport report_glare(const ImageAngles& image, std::span<const float> rgba, std::span<const DazzlingLight> outside,
                         const GlareQuestion& question) {
    const Pixels pixels(image, rgba);
    const dvec3 sight = glm::normalize(dvec3(image.at(question.gaze * dvec2(image.width, image.height)), -1));
    const double source_luminance =
        question.source_luminance ? *question.source_luminance : kSourceContrast * ordinary_luminance(image, pixels);
    const double wide = std::cos(kBackground / kDegreesPerRadian);
    std::vector<DazzlingLight> lamps(outside.begin(), outside.end());
    Mean background;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double value = pixels.luminance(x, y);
            const dvec3 towards = pixels.towards(x, y);
            if (value > source_luminance)
                lamps.push_back({glm::normalize(towards), value * pixels.solid_angle(towards)});
            else if (glm::dot(towards, sight) > wide * glm::length(towards))
                background.add(value, pixels.solid_angle(towards));
        }
    const Veils veils = veils_of(lamps, sight, question.eye);
    GlareReport report{.background = background.value(),
                       .illuminance = veils.illuminance,
                       .veil = veils.general,
                       .road_veil = veils.road};
    const double average = question.average_luminance.value_or(report.background);
    report.increment = veils.road > 0 ? threshold_increment(veils.road, average) : 0;
    if (question.target) report_target(image, pixels, lamps, question, source_luminance, report);
    return report;
}

}  // namespace vesper::vision
