// Drawing pictures with lines and words. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::apps {

using CanvasColour = glm::dvec3;  ///< as displayed (sRGB codes), [0, 1]

/// A picture in the making: pixels from the top left, y down. Words are in DejaVu Sans or what there is instead.
class Canvas {
public:
    enum class Align : uint8_t { Left, Centre, Right };

    Canvas(uint32_t width, uint32_t height, CanvasColour background = CanvasColour(1));
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

    void line(std::span<const glm::dvec2> points, CanvasColour, double thickness = 1, bool dashed = false);
    void line(glm::dvec2 from, glm::dvec2 to, CanvasColour, double thickness = 1, bool dashed = false);
    void rectangle(glm::dvec2 corner, glm::dvec2 size, CanvasColour, double thickness = 1);
    void fill(glm::dvec2 corner, glm::dvec2 size, CanvasColour);
    void circle(glm::dvec2 centre, double radius, CanvasColour, double thickness = 1);
    void disc(glm::dvec2 centre, double radius, CanvasColour);
    /// One line of UTF-8, its middle at the height of `at`; `halo` outlines it against what lies below. `turned` runs
    /// up.
    void text(glm::dvec2 at, const std::string&, double size, Align = Align::Left, CanvasColour = CanvasColour(0),
              bool halo = false, bool turned = false);
    double text_width(const std::string&, double size);
    /// A block of RGBA pixels with its upper left corner at (x, y), clipped.
    void pixels(int x, int y, uint32_t width, uint32_t height, std::span<const uint8_t> rgba);

    /// RGBA codes, row by row.
    std::vector<uint8_t> rgba() const;
    /// Writes a PNG; throws Error.
    void save(const std::string& file) const;

private:
    struct Drawing;
    uint32_t width_, height_;
    std::unique_ptr<Drawing> drawing_;
};

/// Round values 1, 2 or 5 times a power of ten, at most `count` + 1, that lie in [low, high].
std::vector<double> linear_ticks(double low, double high, int count);
/// Powers of ten in [low, high], and 2 and 5 times those where there are few decades.
std::vector<double> log_ticks(double low, double high);
/// A value of a tick as short as possible: 0.05, 20000, 1e+06.
std::string tick_label(double value);

}  // namespace vesper::apps
