#include "beam_plot.h"

#include <cmath>

#include "plots/canvas.h"
#include "plots/false_colour.h"
#include "print.h"

namespace vesper::commands {
namespace {

using apps::Canvas, apps::CanvasColour, apps::format;

constexpr double kHalfWidth = 12;  // m
constexpr uint32_t kRoadWidth = 900, kRoadHeight = 240;
constexpr apps::ColourScale kLux{0.05, 50};

}  // namespace

void save_beam_plot(const std::string& file, const std::string& title, const Approach& approach, size_t beam,
                    double reach) {
    const glm::dvec2 corner(80, 60), size(kRoadWidth, kRoadHeight);
    apps::ValuePicture picture{kRoadWidth, kRoadHeight, {}};
    for (uint32_t row = 0; row < kRoadHeight; ++row)
        for (uint32_t column = 0; column < kRoadWidth; ++column)
            picture.values.push_back(float(approach.road_illuminance(
                beam, (column + 0.5) / kRoadWidth * reach, ((row + 0.5) / kRoadHeight * 2 - 1) * kHalfWidth)));
    Canvas canvas(uint32_t(corner.x) + kRoadWidth + 24 + uint32_t(apps::kBarWidth), 370);
    canvas.text({corner.x, 24}, title, 15);
    canvas.pixels(int(corner.x), int(corner.y), kRoadWidth, kRoadHeight, apps::false_colours(picture, kLux));
    const double levels[] = {0.1, 0.3, 1, 3, 10};
    apps::draw_contours(canvas, picture, levels, corner);
    canvas.rectangle(corner, size, CanvasColour(0.15));
    for (const double x : apps::linear_ticks(0, reach, 10))
        canvas.text({corner.x + x / reach * size.x, corner.y + size.y + 14}, apps::tick_label(x), 12,
                    Canvas::Align::Centre);
    for (const double y : {-10.0, -5.0, 0.0, 5.0, 10.0})
        canvas.text({corner.x - 9, corner.y + size.y * (y / kHalfWidth + 1) / 2}, format("%g", y), 12,
                    Canvas::Align::Right);
    canvas.text({corner.x + size.x / 2, corner.y + size.y + 38}, "before the eye, m; lines: 0.1, 0.3, 1, 3 and 10 lx",
                13, Canvas::Align::Centre);
    canvas.text({24, corner.y + size.y / 2}, "to the right, m", 13, Canvas::Align::Centre, CanvasColour(0), false,
                true);
    apps::draw_colour_bar(canvas, {corner.x + size.x + 24, corner.y}, size.y, kLux, "lx");
    canvas.save(file);
}

}  // namespace vesper::commands
