// Canvas by way of Cairo. SPDX-License-Identifier: MIT
#include "plots/canvas.h"

#include <cmath>
#include <cstring>
#include <numbers>

#include <cairo.h>

#include "base/error.h"
#include "io/image_file.h"
#include "print.h"

namespace vesper::apps {

struct Canvas::Drawing {
    cairo_surface_t* surface;
    cairo_t* cairo;

    void colour(CanvasColour c) { cairo_set_source_rgb(cairo, c.r, c.g, c.b); }
    void stroke(CanvasColour c, double thickness) {
        colour(c);
        cairo_set_line_width(cairo, thickness);
        cairo_stroke(cairo);
    }
};

Canvas::Canvas(uint32_t width, uint32_t height, CanvasColour background) : width_(width), height_(height) {
    cairo_surface_t* surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height));
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
        cairo_surface_destroy(surface);
        throw Error(format("a picture of %u x %u px cannot be drawn", width, height));
    }
    drawing_ = std::make_unique<Drawing>(Drawing{surface, cairo_create(surface)});
    cairo_select_font_face(drawing_->cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_line_join(drawing_->cairo, CAIRO_LINE_JOIN_ROUND);
    drawing_->colour(background);
    cairo_paint(drawing_->cairo);
}

Canvas::~Canvas() {
    cairo_destroy(drawing_->cairo);
    cairo_surface_destroy(drawing_->surface);
}

void Canvas::line(std::span<const glm::dvec2> points, CanvasColour c, double thickness, bool dashed) {
    if (points.size() < 2) return;
    cairo_new_path(drawing_->cairo);
    for (const glm::dvec2 p : points) cairo_line_to(drawing_->cairo, p.x, p.y);
    const double dashes[] = {4, 3};
    if (dashed) cairo_set_dash(drawing_->cairo, dashes, 2, 0);
    drawing_->stroke(c, thickness);
    cairo_set_dash(drawing_->cairo, nullptr, 0, 0);
}

void Canvas::line(glm::dvec2 from, glm::dvec2 to, CanvasColour c, double thickness, bool dashed) {
    const glm::dvec2 points[] = {from, to};
    line(points, c, thickness, dashed);
}

void Canvas::rectangle(glm::dvec2 corner, glm::dvec2 size, CanvasColour c, double thickness) {
    cairo_rectangle(drawing_->cairo, corner.x, corner.y, size.x, size.y);
    drawing_->stroke(c, thickness);
}

void Canvas::fill(glm::dvec2 corner, glm::dvec2 size, CanvasColour c) {
    drawing_->colour(c);
    cairo_rectangle(drawing_->cairo, corner.x, corner.y, size.x, size.y);
    cairo_fill(drawing_->cairo);
}

void Canvas::circle(glm::dvec2 centre, double radius, CanvasColour c, double thickness) {
    cairo_new_path(drawing_->cairo);
    cairo_arc(drawing_->cairo, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
    drawing_->stroke(c, thickness);
}

void Canvas::disc(glm::dvec2 centre, double radius, CanvasColour c) {
    drawing_->colour(c);
    cairo_new_path(drawing_->cairo);
    cairo_arc(drawing_->cairo, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
    cairo_fill(drawing_->cairo);
}

void Canvas::text(glm::dvec2 at, const std::string& words, double size, Align align, CanvasColour c, bool halo,
                  bool turned) {
    cairo_t* cairo = drawing_->cairo;
    const double width = text_width(words, size);
    cairo_save(cairo);
    cairo_translate(cairo, at.x, at.y);
    if (turned) cairo_rotate(cairo, -std::numbers::pi / 2);
    const double left = align == Align::Left ? 0 : align == Align::Centre ? -width / 2 : -width;
    cairo_move_to(cairo, left, 0.36 * size);  // half the height of capitals
    if (halo) {
        cairo_text_path(cairo, words.c_str());
        drawing_->stroke(CanvasColour(c.r + c.g + c.b > 1.5 ? 0 : 1), 3);
        cairo_move_to(cairo, left, 0.36 * size);
    }
    drawing_->colour(c);
    cairo_show_text(cairo, words.c_str());
    cairo_restore(cairo);
}

double Canvas::text_width(const std::string& words, double size) {
    cairo_text_extents_t extents{};
    cairo_set_font_size(drawing_->cairo, size);
    cairo_text_extents(drawing_->cairo, words.c_str(), &extents);
    return extents.x_advance;
}

void Canvas::pixels(int x, int y, uint32_t width, uint32_t height, std::span<const uint8_t> rgba) {
    cairo_surface_flush(drawing_->surface);
    uint8_t* data = cairo_image_surface_get_data(drawing_->surface);
    const auto stride = static_cast<size_t>(cairo_image_surface_get_stride(drawing_->surface));
    for (uint32_t row = 0; row < height; ++row)
        for (uint32_t i = 0; i < width; ++i) {
            const int64_t to_x = int64_t{x} + i, to_y = int64_t{y} + row;
            if (to_x < 0 || to_y < 0 || to_x >= width_ || to_y >= height_) continue;
            const uint8_t* from = &rgba[4 * (size_t{row} * width + i)];
            const uint32_t packed = uint32_t{from[0]} << 16 | uint32_t{from[1]} << 8 | from[2];
            std::memcpy(data + static_cast<size_t>(to_y) * stride + static_cast<size_t>(to_x) * 4, &packed, 4);
        }
    cairo_surface_mark_dirty(drawing_->surface);
}

std::vector<uint8_t> Canvas::rgba() const {
    cairo_surface_flush(drawing_->surface);
    const uint8_t* data = cairo_image_surface_get_data(drawing_->surface);
    const auto stride = static_cast<size_t>(cairo_image_surface_get_stride(drawing_->surface));
    std::vector<uint8_t> made;
    made.reserve(size_t{width_} * height_ * 4);
    for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x) {
            uint32_t packed;
            std::memcpy(&packed, data + y * stride + size_t{x} * 4, 4);
            for (const int shift : {16, 8, 0}) made.push_back(static_cast<uint8_t>(packed >> shift));
            made.push_back(255);
        }
    return made;
}

void Canvas::save(const std::string& file) const { io::write_png(file, width_, height_, rgba()); }

std::vector<double> linear_ticks(double low, double high, int count) {
    std::vector<double> ticks;
    if (!(high > low) || count < 1) return ticks;
    const double rough = (high - low) / count, power = std::pow(10, std::floor(std::log10(rough)));
    double step = 10 * power;
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= rough * (1 - 1e-9)) {
            step = factor * power;
            break;
        }
    for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push_back(i * step);
    return ticks;
}

std::vector<double> log_ticks(double low, double high) {
    std::vector<double> ticks;
    if (!(low > 0) || !(high > low)) return ticks;
    const double decades = std::log10(high / low);
    for (int power = static_cast<int>(std::floor(std::log10(low))); power <= std::ceil(std::log10(high)); ++power)
        for (const double factor : {1.0, 2.0, 5.0}) {
            if (factor > 1 && decades > 4) continue;
            const double value = factor * std::pow(10, power);
            if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) ticks.push_back(value);
        }
    return ticks;
}

std::string tick_label(double value) {
    const double size = std::abs(value);
    if (size < 1e-12) return "0";
    return size >= 100 && size < 1e6 ? format("%.0f", value) : format("%.3g", value);
}

}  // namespace vesper::apps
