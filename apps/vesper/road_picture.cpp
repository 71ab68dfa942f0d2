// Pictures of a rendered road. SPDX-License-Identifier: MIT
#include <algorithm>

#include "arguments/arguments.h"
#include "io/image_file.h"
#include "plots/false_colour.h"
#include "print.h"
#include "road_render.h"
#include "road_view.h"
#include "scene/colour.h"

namespace vesper::commands {
namespace {

using apps::format;

constexpr uint32_t kPanelWidth = 1000, kPanelHeight = 240;
constexpr double kLeft = 70, kGap = 52;

apps::ValuePicture luminances_of(VkExtent2D extent, const std::vector<float>& rgba) {
    apps::ValuePicture picture{extent.width, extent.height, {}};
    for (size_t i = 0; i < rgba.size(); i += 4)
        picture.values.push_back(static_cast<float>(luminance({rgba[i], rgba[i + 1], rgba[i + 2]})));
    return picture;
}

/// What is left of a view's picture when it fills a panel: from px of the picture to px of the canvas.
struct Panel {
    const gpu_scene::View& view;
    glm::dvec2 corner, size;
    glm::dvec2 at(glm::dvec3 point) const {
        return corner + size * project(view, point) / glm::dvec2(view.extent.width, view.extent.height);
    }
};

void outline_field(apps::Canvas& canvas, const Panel& panel, const roads::RoadLayout& layout) {
    const glm::dvec2 corners[] = {panel.at({0, 0, 0}), panel.at({layout.spacing, 0, 0}),
                                  panel.at({layout.spacing, layout.width, 0}), panel.at({0, layout.width, 0}),
                                  panel.at({0, 0, 0})};
    canvas.line(corners, apps::CanvasColour(1), 1.2, true);
}

void draw_observer(apps::Canvas& canvas, glm::dvec2 corner, const roads::LoadedLayout& layout,
                   const roads::RoadLighting& result, size_t index, const RenderedObserver& seen,
                   const apps::ColourScale& scale) {
    const roads::LaneObserver& observer = result.observers[index];
    const apps::ValuePicture picture =
        apps::resized(luminances_of(seen.view.extent, seen.rgba), kPanelWidth, kPanelHeight);
    canvas.pixels(static_cast<int>(corner.x), static_cast<int>(corner.y), kPanelWidth, kPanelHeight,
                  apps::false_colours(picture, scale));
    std::vector<double> levels;
    for (const roads::LightingClass& c : roads::lighting_classes()) levels.push_back(c.average_luminance);
    apps::draw_contours(canvas, picture, levels, corner);
    const Panel panel{seen.view, corner, {kPanelWidth, kPanelHeight}};
    outline_field(canvas, panel, layout);
    for (const roads::FieldPoint& point : result.points) {
        canvas.disc(panel.at({point.x, point.y, 0}), 2.5, apps::CanvasColour(1));
        canvas.disc(panel.at({point.x, point.y, 0}), 1.5, apps::CanvasColour(0));
    }
    double free = corner.y + kPanelHeight + 20;
    for (const double x : result.field.x) {
        const double y = panel.at({x, observer.eye.y, 0}).y;
        if (free - y < 13) continue;
        canvas.text({corner.x - 8, y}, format("%.1f m", x), 11, apps::Canvas::Align::Right);
        free = y;
    }
    const double tall = static_cast<double>(kPanelHeight) / (seen.view.tangent_high.y - seen.view.tangent_low.y) /
                        (kPanelWidth / static_cast<double>(seen.view.tangent_high.x - seen.view.tangent_low.x));
    canvas.text(corner + glm::dvec2(0, -14),
                format("Observer of lane %d: Lav %.3f cd/m\u00b2 calculated, %.3f rendered, points within %.2f %%; "
                       "here by every luminaire: %.3f",
                       observer.lane, observer.average_luminance, seen.counted.average_luminance,
                       std::abs(seen.counted.largest_difference), seen.every.average_luminance),
                13);
    canvas.text(corner + glm::dvec2(kPanelWidth, -14), format("heights \u00d7 %.1f", tall), 13,
                apps::Canvas::Align::Right);
}

void write_false_colours(const std::string& file, const roads::LoadedLayout& layout, const roads::RoadLighting& result,
                         const RenderedRoad& rendered) {
    std::vector<float> all;
    for (const RenderedObserver& seen : rendered.observers)
        for (const double value : seen.every.luminance) all.push_back(static_cast<float>(value));
    const apps::ColourScale scale = apps::scale_of(all);
    const apps::ValuePicture overview = luminances_of(rendered.overview.extent, rendered.overview_rgba);
    const double top = 96,
                 tall = overview.height + kGap + static_cast<double>(rendered.observers.size()) * (kPanelHeight + kGap);
    apps::Canvas canvas(static_cast<uint32_t>(kLeft + kPanelWidth + 24 + apps::kBarWidth),
                        static_cast<uint32_t>(top + tall));
    canvas.text({kLeft, 24}, apps::column(layout.name, 100), 17);
    canvas.text({kLeft, 48},
                "Luminance of the road from the standard observers, 60 m before the field and 1.5 m up; lines: limits "
                "of the classes M6 to M1",
                13);
    canvas.text({kLeft, top - 14},
                format("As seen from lane %d; dashed: the field", result.observers[rendered.darkest].lane), 13);
    canvas.pixels(static_cast<int>(kLeft), static_cast<int>(top), overview.width, overview.height,
                  apps::false_colours(overview, scale));
    outline_field(canvas, {rendered.overview, {kLeft, top}, {overview.width, overview.height}}, layout);
    double y = top + overview.height + kGap;
    for (size_t i = 0; i < rendered.observers.size(); ++i, y += kPanelHeight + kGap)
        draw_observer(canvas, {kLeft, y}, layout, result, i, rendered.observers[i], scale);
    apps::draw_colour_bar(canvas, {kLeft + kPanelWidth + 24, top}, std::min(tall - kGap, 700.0), scale, "cd/m\u00b2");
    canvas.save(file);
}

}  // namespace

void write_picture(const std::string& file, const roads::LoadedLayout& layout, const roads::RoadLighting& result,
                   const RenderedRoad& rendered) {
    if (file.ends_with(".png")) return write_false_colours(file, layout, result, rendered);
    for (size_t i = 0; i < rendered.observers.size(); ++i) {
        const gpu_scene::View& view = rendered.observers[i].view;
        const int lane = result.observers[i].lane;
        const std::string name =
            rendered.observers.size() == 1 ? file : file.substr(0, file.size() - 4) + format(".lane%d.exr", lane);
        const roads::LayoutPoint& eye = result.observers[i].eye;
        io::write_exr(name, view.extent.width, view.extent.height, rendered.observers[i].rgba,
                      {{"vesper:version", VESPER_VERSION},
                       {"vesper:road", layout.name},
                       {"vesper:unit", "cd/m^2, linear Rec. 709 RGB"},
                       {"vesper:device", rendered.device},
                       {"vesper:eye", format("%.9g %.9g %.9g", eye.x, eye.y, eye.z)},
                       {"vesper:tangents",
                        format("%.9g %.9g %.9g %.9g", static_cast<double>(view.tangent_low.x),
                               static_cast<double>(view.tangent_low.y), static_cast<double>(view.tangent_high.x),
                               static_cast<double>(view.tangent_high.y))}});
    }
}

}  // namespace vesper::commands
