// Light of other pictures of one eye: added up, and scattered into a picture, against the sum over every pixel of all
// of them. SPDX-License-Identifier: MIT
#include "base/angle.h"
#include "passes/eye_scatter_reference.h"
#include "passes/light_sums_reference.h"

#include <algorithm>
#include <array>
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace vesper::reference {
namespace {

using vision::EyePicture, vision::EyeScatter;

constexpr int kGuard = vision::LightElsewhere::kGuard;
constexpr ivec2 kStrip(4, 32);

/// A screen: angles of its edges from its axis, and how that is turned, degrees; with its border.
EyePicture screen(ivec2 pixels, double left, double right, double down, double up, double yaw, double pitch = 0,
                  double roll = 0) {
    const auto tangent = [](double degrees) { return std::tan(degrees * kRadiansPerDegree); };
    const dvec2 low(tangent(left), tangent(down)), high(tangent(right), tangent(up)),
        border = double(kGuard) * (high - low) / dvec2(pixels);
    glm::dmat4 turn = glm::rotate(glm::dmat4(1), yaw * kRadiansPerDegree, dvec3(0, 1, 0));
    turn = glm::rotate(glm::rotate(turn, pitch * kRadiansPerDegree, dvec3(1, 0, 0)), -roll * kRadiansPerDegree,
                       dvec3(0, 0, 1));
    return {{pixels.x + 2 * kGuard, pixels.y + 2 * kGuard, low - border, high + border}, glm::dmat3(turn), kGuard};
}

/// Luminance by direction (frame of the eye, of unit length), cd/m^2.
using Lamp = std::function<double(dvec3)>;

/// With so many samples of each pixel along either axis that pictures agree about its light.
Plane picture_of(const EyePicture& p, const Lamp& light, int samples = 3) {
    Plane plane({p.image.width, p.image.height});
    for (int y = 0; y < plane.size.y; ++y)
        for (int x = 0; x < plane.size.x; ++x) {
            double sum = 0;
            for (int i = 0; i < samples * samples; ++i)
                sum += light(p.turn * direction_of(p.image, dvec2(x, y) + (dvec2(i % samples, i / samples) + 0.5) /
                                                                              double(samples)));
            sum /= samples * samples;
            plane[{x, y}] = dvec3(sum, 0.5 * sum, 0.25 * sum);
        }
    return plane;
}

std::vector<float> rgba(const Plane& plane) {
    std::vector<float> values;
    for (const dvec3 t : plane.texels)
        for (const double c : {t.x, t.y, t.z, 1.0}) values.push_back(float(c));
    return values;
}

bool has(const EyePicture& p, dvec3 d) {
    const dvec3 v = glm::transpose(p.turn) * d;
    if (!(v.z < 0)) return false;
    const dvec2 t = dvec2(v) / -v.z;
    return t.x > p.image.low.x && t.x < p.image.high.x && t.y > p.image.low.y && t.y < p.image.high.y;
}

/// Everything once: each direction as the own picture has it, or as that of the nearest middle. Pixels of others are
/// taken in 4 x 4 parts.
class Exact {
public:
    Exact(const EyeScatter& psf, const std::vector<EyePicture>& pictures, const std::vector<Plane>& scenes, size_t own)
        : psf_(psf), own_(pictures[own]), scene_(scenes[own]) {
        const auto middle = [](const EyePicture& p) {
            return glm::normalize(p.turn * direction_of(p.image, 0.5 * dvec2(p.image.width, p.image.height)));
        };
        for (size_t j = 0; j < pictures.size(); ++j) {
            if (j == own) continue;
            const EyePicture& p = pictures[j];
            for (int y = 0; y < scenes[j].size.y; ++y)
                for (int x = 0; x < scenes[j].size.x; ++x)
                    for (int i = 0; i < 16 && scenes[j].at({x, y}).x > 0; ++i) {
                        const dvec3 there = direction_of(p.image, dvec2(x, y) + (dvec2(i % 4, i / 4) + 0.5) / 4.0),
                                    d = p.turn * there;
                        bool here = !has(own_, d);
                        for (size_t k = 0; k < pictures.size(); ++k)
                            if (k != own && k != j && has(pictures[k], d) &&
                                glm::dot(d, middle(pictures[k])) > glm::dot(d, middle(p)))
                                here = false;
                        if (here) others_.push_back({d, scenes[j].at({x, y}).x * solid_angle(p.image, there, 1.0 / 4)});
                    }
        }
    }
    double at(ivec2 to) const {
        double sum = exact_at(psf_, own_.image, scene_, {}, to).x;
        const dvec3 axis = own_.turn * direction_of(own_.image, dvec2(to) + 0.5);
        for (const auto& [direction, lux] : others_) {
            const double theta = degrees_apart(axis, direction);  // nothing from 100 degrees on
            sum += psf_(std::min(theta, 90.0)) * std::clamp(10 - theta / 10, 0.0, 1.0) * lux;
        }
        return sum;
    }
    /// What all light of others veils from 90 degrees.
    double least() const {
        double lux = 0;
        for (const auto& other : others_) lux += other.second;
        return psf_(90) * lux;
    }

private:
    const EyeScatter& psf_;
    EyePicture own_;
    const Plane& scene_;
    std::vector<std::pair<dvec3, double>> others_;
};

/// What a picture takes of all.
std::vector<std::vector<glm::vec3>> taken(const vision::LightElsewhere& elsewhere, const std::vector<LightSums>& sums) {
    std::vector<std::vector<glm::vec3>> light;
    for (size_t i = 0; i < sums.size(); ++i) light.push_back(sums[i].at(elsewhere.nodes(i)));
    return light;
}

/// What falls on the retina of one of them.
Plane retina(const EyeScatter& psf, const std::vector<EyePicture>& pictures, const std::vector<Plane>& scenes,
             size_t own, const std::vector<vision::UnseenLamp>& lamps = {}) {
    std::vector<LightSums> sums;
    for (size_t i = 0; i < pictures.size(); ++i) sums.emplace_back(pictures[i].image, rgba(scenes[i]));
    const vision::LightElsewhere elsewhere(psf, pictures, own);
    const vision::OffscreenLight beyond = elsewhere.of(taken(elsewhere, sums), lamps);
    return scatter(scenes[own], vision::fit_scatter(psf, pictures[own].image, kStrip), {}, {}, beyond);
}

/// A patch of `radius` degrees about a direction, with an edge of a tenth of that.
Lamp patch(double yaw, double pitch, double radius) {
    const dvec3 at(-std::sin(yaw * kRadiansPerDegree) * std::cos(pitch * kRadiansPerDegree),
                   std::sin(pitch * kRadiansPerDegree),
                   -std::cos(yaw * kRadiansPerDegree) * std::cos(pitch * kRadiansPerDegree));
    return [=](dvec3 d) { return 1000 * std::clamp((radius - degrees_apart(d, at)) / (0.1 * radius) + 0.5, 0.0, 1.0); };
}

/// Errors of the veil in what is shown of each picture, where its own light does not drown it. 2 % rms and 6 % anywhere
/// is what the pyramid has of its own light further than 10 px (docs/glare.md: 1.5 % and 5.4 %), and what tents and
/// splines of light from beyond add, 1 %.
void expect_everywhere(const std::vector<EyePicture>& pictures, const Lamp& light, double rms = 0.02,
                       double largest = 0.06, int samples = 3) {
    const EyeScatter psf = eye::eye_scatter({});
    std::vector<Plane> scenes;
    for (const EyePicture& p : pictures) scenes.push_back(picture_of(p, light, samples));
    std::mt19937 random(4);
    for (size_t own = 0; own < pictures.size(); ++own) {
        const Plane seen = retina(psf, pictures, scenes, own);
        const Exact exact(psf, pictures, scenes, own);
        double squares = 0, worst = 0;
        int count = 0;
        ivec2 where(0);
        const auto look = [&](ivec2 at) {
            bool lit = false;  // within 3 px: there its own core counts, which other tests have
            for (int i = 0; i < 49; ++i) lit = lit || scenes[own].at(at + ivec2(i % 7, i / 7) - 3).x > 0;
            if (lit) return;
            const double want = exact.at(at), error = (seen.at(at).x - want) / std::max(want, exact.least());
            squares += error * error, ++count;
            if (std::abs(error) > std::abs(worst)) worst = error, where = at - kGuard;
        };
        const ivec2 shown = seen.size - 2 * kGuard;
        for (int i = 0; i < 120; ++i)
            look(kGuard + ivec2(int(random() % uint32_t(shown.x)), int(random() % uint32_t(shown.y))));
        for (int i = 0; i < 40; ++i)  // along the edges
            for (int side = 0; side < 2; ++side) {
                look(kGuard + ivec2(side * (shown.x - 1), i * (shown.y - 1) / 39));
                look(kGuard + ivec2(i * (shown.x - 1) / 39, side * (shown.y - 1)));
            }
        EXPECT_GT(count, 20) << "picture " << own;
        EXPECT_LT(std::sqrt(squares / count), rms) << "picture " << own;
        EXPECT_LT(std::abs(worst), largest) << "picture " << own << " at " << where.x << ", " << where.y;
    }
}

std::vector<EyePicture> three(ivec2 pixels = {150, 94}) {
    return {screen(pixels, -24, 24, -15.6, 15.6, 48), screen(pixels, -24, 24, -15.6, 15.6, 0),
            screen(pixels, -24, 24, -15.6, 15.6, -48)};
}

TEST(LightElsewhere, AreasGoOnAcrossSeams) {
    expect_everywhere(three(), patch(34, 3, 6));
    expect_everywhere(three(), patch(26, -4, 3));  // over the seam, into the middle one
    expect_everywhere(three(), patch(55, 0, 12));
}

// A lamp of half a pixel's radius, nearer and nearer to the seam: what a single pixel of the pyramid has of another.
TEST(LightElsewhere, SmallLightsAreWhereTheyAre) {
    for (const double yaw : {25.9, 31.1, 47.2, 66.0})
        expect_everywhere(three(), patch(yaw, 5.3, 0.15), 0.025, 0.08, 12);
}

/// Adds a lamp of 1 lx to a picture that has it, over the four nearest pixels, its middle where it is.
void add_lamp(const EyePicture& p, dvec3 direction, Plane& plane) {
    if (!has(p, direction)) return;
    const dvec3 d = glm::transpose(p.turn) * direction;
    const dvec2 at = p.image.pixels_at(dvec2(d) / -d.z) - 0.5, first = glm::floor(at), part = at - first;
    for (int i = 0; i < 4; ++i) {
        const ivec2 pixel = ivec2(first) + ivec2(i & 1, i >> 1);
        if (pixel.x < 0 || pixel.y < 0 || pixel.x >= plane.size.x || pixel.y >= plane.size.y) continue;
        const double share = (i & 1 ? part.x : 1 - part.x) * (i >> 1 ? part.y : 1 - part.y);
        plane[pixel] += dvec3(share / solid_angle(p.image, direction_of(p.image, dvec2(pixel) + 0.5), 1));
    }
}

// A lamp on its way over a seam and the borders of two guards, by a fifth of a pixel, is neither lost nor counted
// twice: what it veils far away changes smoothly. 3 % is what the pyramid has of a pixel; a share with a step at the
// edge of a picture is wrong by half of the lamp.
TEST(LightElsewhere, ALampCrossesASeam) {
    const EyeScatter psf = eye::eye_scatter({});
    for (const ivec2 others : {ivec2(150, 94), ivec2(75, 47)}) {
        const std::vector<EyePicture> pictures{screen(others, -24, 24, -15.6, 15.6, 48),
                                               screen({150, 94}, -24, 24, -15.6, 15.6, 0),
                                               screen(others, -24, 24, -15.6, 15.6, -48)};
        std::vector<vision::LightElsewhere> elsewhere;
        for (size_t own = 0; own < 3; ++own) elsewhere.emplace_back(psf, pictures, own);
        const vision::ScatterFit fits[]{vision::fit_scatter(psf, pictures[0].image, kStrip),
                                        vision::fit_scatter(psf, pictures[1].image, kStrip),
                                        vision::fit_scatter(psf, pictures[2].image, kStrip)};
        for (double yaw = 19; yaw < 29; yaw += 0.77) {
            const dvec3 lamp(-std::sin(yaw * kRadiansPerDegree), 0.05, -std::cos(yaw * kRadiansPerDegree));
            std::vector<Plane> scenes;
            std::vector<LightSums> sums;
            for (const EyePicture& p : pictures) {
                scenes.emplace_back(ivec2(p.image.width, p.image.height));
                add_lamp(p, lamp, scenes.back());
                sums.emplace_back(p.image, rgba(scenes.back()));
            }
            for (size_t own = 0; own < 3; ++own) {
                const Plane seen =
                    scatter(scenes[own], fits[own], {}, {}, elsewhere[own].of(taken(elsewhere[own], sums), {}));
                const ivec2 at(own == 0   ? kGuard + 5
                               : own == 1 ? seen.size.x - kGuard - 5
                                          : seen.size.x / 2,
                               seen.size.y / 2);  // away from the seam, within 90 degrees
                const double want = psf(degrees_apart(
                    glm::normalize(lamp), pictures[own].turn * direction_of(pictures[own].image, dvec2(at) + 0.5)));
                EXPECT_NEAR(seen.at(at).x / want, 1, 0.03)
                    << yaw << " degrees, picture " << own << ", others " << others.x;
            }
        }
    }
}

// What is far is taken together: those of 1280 x 800 take 15 and 18 MB of the host, one by one their pixels would take
// 10 GB.
TEST(LightElsewhere, WhatIsFarIsTakenTogether) {
    const EyeScatter psf = eye::eye_scatter({});
    const std::vector<EyePicture> pictures = three({1280, 800});
    EXPECT_LT(vision::LightElsewhere(psf, pictures, 1).bytes(), 20u << 20);
    EXPECT_LT(vision::LightElsewhere(psf, pictures, 0).bytes(), 15u << 20);
}

// Three screens in one plane, seen off their axes.
TEST(LightElsewhere, ScreensMayLieInOnePlane) {
    const double edge = std::tan(16 * kRadiansPerDegree);
    std::vector<EyePicture> pictures;
    for (int i = -1; i <= 1; ++i)
        pictures.push_back(screen({96, 96}, std::atan((2 * i - 1) * edge) / kRadiansPerDegree,
                                  std::atan((2 * i + 1) * edge) / kRadiansPerDegree, -16, 16, 0));
    expect_everywhere(pictures, patch(24, 3, 4));
}

// Pixels of a quarter of the size beside it, a screen turned by 60 degrees that overlaps it, one above that is rolled.
TEST(LightElsewhere, ScreensMayDifferOverlapAndRoll) {
    const std::vector<EyePicture> pictures{
        screen({60, 40}, -24, 24, -15.6, 15.6, 48), screen({240, 160}, -24, 24, -15.6, 15.6, 0),
        screen({110, 90}, -40, 30, -20, 20, -60, 0, 0), screen({90, 120}, -15, 15, -20, 20, 5, 38, 25)};
    expect_everywhere(pictures, patch(36, 2, 6));
    expect_everywhere(pictures, patch(-26, -3, 5));  // seen by two
    expect_everywhere(pictures, patch(4, 33, 6));
}

// The same light, whatever the order of the file.
TEST(LightElsewhere, OrderDoesNotMatter) {
    const std::vector<EyePicture> pictures{screen({110, 90}, -40, 30, -20, 20, -60),
                                           screen({70, 50}, -24, 24, -15.6, 15.6, 0),
                                           screen({60, 40}, -24, 24, -15.6, 15.6, 30)};
    const std::vector<EyePicture> turned{pictures[2], pictures[1], pictures[0]};
    const Lamp light = [](dvec3 d) { return 1 + std::sin(9 * d.x + 5 * d.y); };
    std::vector<Plane> scenes;
    for (const EyePicture& p : pictures) scenes.push_back(picture_of(p, light));
    const EyeScatter psf = eye::eye_scatter({});
    const Plane one = retina(psf, pictures, scenes, 1),
                other = retina(psf, turned, {scenes[2], scenes[1], scenes[0]}, 1);
    for (size_t i = 0; i < one.texels.size(); ++i) ASSERT_NEAR(one.texels[i].x / other.texels[i].x, 1, 1e-6) << i;
}

// Lamps that no picture shows, near and far: as the function has them.
TEST(LightElsewhere, UnseenLampsVeil) {
    const std::vector<EyePicture> pictures = three();
    const EyeScatter psf = eye::eye_scatter({});
    std::vector<Plane> dark;
    for (const EyePicture& p : pictures) dark.emplace_back(ivec2(p.image.width, p.image.height));
    for (const double pitch : {19.0, 25.0, 40.0, 70.0}) {
        const dvec3 lamp(0, std::sin(pitch * kRadiansPerDegree), -std::cos(pitch * kRadiansPerDegree));
        const Plane seen = retina(psf, pictures, dark, 0, {{lamp, dvec3(10, 5, 1)}});
        for (const ivec2 at : {ivec2(kGuard), dark[0].size / 2, dark[0].size - 1 - kGuard}) {
            const double want =
                psf(degrees_apart(lamp, pictures[0].turn * direction_of(pictures[0].image, dvec2(at) + 0.5)));
            EXPECT_NEAR(seen.at(at).x / (10 * want), 1, 0.03) << pitch;
            EXPECT_NEAR(seen.at(at).y / (5 * want), 1, 0.03) << pitch;
        }
    }
}

}  // namespace
}  // namespace vesper::reference
