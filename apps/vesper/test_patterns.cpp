#include "test_patterns.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "arguments/arguments.h"
#include "io/image_file.h"
#include "plots/canvas.h"
#include "print.h"

namespace vesper::commands {
namespace {

using Codes = glm::uvec3;

/// A picture of codes, whatever their bits.
class Pattern {
public:
    Pattern(const PatternSettings& settings, Codes background)
        : settings_(settings), pixels_(size_t{settings.width} * settings.height, background) {}

    uint32_t width() const { return settings_.width; }
    uint32_t height() const { return settings_.height; }

    void fill(glm::uvec2 from, glm::uvec2 to, const std::function<Codes(uint32_t x)>& codes) {
        for (uint32_t y = from.y; y < std::min(to.y, height()); ++y)
            for (uint32_t x = from.x; x < std::min(to.x, width()); ++x) pixels_[size_t{y} * width() + x] = codes(x);
    }
    struct Label {
        glm::dvec2 at;
        std::string text;
    };
    /// Words in one code, smoothed by mixing codes.
    void write(const std::vector<Label>& labels, double size, uint32_t code) {
        apps::Canvas canvas(width(), height(), apps::CanvasColour(0));
        for (const Label& label : labels)
            canvas.text(label.at, label.text, size, apps::Canvas::Align::Centre, apps::CanvasColour(1));
        const std::vector<uint8_t> coverage = canvas.rgba();
        for (size_t i = 0; i < pixels_.size(); ++i) {
            const double part = coverage[4 * i] / 255.0;
            pixels_[i] = glm::uvec3(glm::round(glm::mix(glm::dvec3(pixels_[i]), glm::dvec3(code), part)));
        }
    }
    void save(const std::string& file) const {
        if (settings_.bits == 10) {
            std::vector<uint32_t> words;
            for (const Codes& c : pixels_) words.push_back(c.r | c.g << 10 | c.b << 20 | 3u << 30);
            return io::write_png_10bit(file, width(), height(), words, io::PngColour());
        }
        std::vector<uint8_t> rgba;
        for (const Codes& c : pixels_)
            for (const uint32_t value : {c.r, c.g, c.b, 255u}) rgba.push_back(uint8_t(value));
        io::write_png(file, width(), height(), rgba, io::PngColour());
    }

private:
    const PatternSettings& settings_;
    std::vector<Codes> pixels_;
};

/// Ramps of grey, red, green and blue over all codes, and a wedge of labelled steps.
Pattern ramp(const PatternSettings& s, uint32_t largest) {
    Pattern made(s, Codes(0));
    const auto code_at = [&](uint32_t x) { return uint32_t(uint64_t{x} * (largest + 1) / s.width); };
    const uint32_t band = s.height / 6;
    const Codes colours[]{{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (uint32_t i = 0; i < 4; ++i)
        made.fill({0, i * band}, {s.width, (i + 1) * band}, [&](uint32_t x) { return code_at(x) * colours[i]; });
    constexpr uint32_t kSteps = 17;
    const auto step_at = [&](uint32_t step) { return uint32_t(std::lround(double(step) * largest / (kSteps - 1))); };
    made.fill({0, 4 * band}, {s.width, 5 * band + band / 2},
              [&](uint32_t x) { return Codes(step_at(uint32_t(uint64_t{x} * kSteps / s.width))); });
    std::vector<Pattern::Label> labels;
    for (uint32_t i = 0; i < kSteps; ++i)
        labels.push_back({{(i + 0.5) * s.width / kSteps, s.height - band / 4.0}, std::to_string(step_at(i))});
    made.write(labels, std::max(8.0, s.width / 90.0), largest / 2);
    return made;
}

/// 8 x 4 patches of neighbouring codes on the first of them, or the last.
Pattern steps(const PatternSettings& s, uint32_t largest, bool white) {
    const uint32_t background = white ? largest : 0;
    Pattern made(s, Codes(background));
    std::vector<Pattern::Label> labels;
    for (uint32_t i = 0; i < 32; ++i) {
        const uint32_t code = white ? largest - i : i;
        const glm::uvec2 cell(s.width / 8, s.height / 4), at = cell * glm::uvec2(i % 8, i / 8);
        made.fill(at + cell / 6u, at + cell * 5u / 6u, [&](uint32_t) { return Codes(code); });
        labels.push_back({{at.x + cell.x / 2.0, at.y + cell.y * 0.93}, std::to_string(code)});
    }
    made.write(labels, std::max(8.0, s.width / 100.0), white ? largest * 3 / 4 : largest / 4);
    return made;
}

Pattern patch(const PatternSettings& s, uint32_t code) {
    Pattern made(s, Codes(0));
    const glm::uvec2 size(s.width, s.height), side(glm::max(glm::dvec2(1), glm::round(s.window * glm::dvec2(size)))),
        from = (size - side) / 2u;
    made.fill(from, from + side, [&](uint32_t) { return Codes(code); });
    return made;
}

/// Codes to measure: 0, 1, 2, 4, ... near black, then evenly up to the largest; about as many as asked for.
std::vector<uint32_t> measured_codes(const PatternSettings& s) {
    const uint32_t largest = (1u << s.bits) - 1;
    std::vector<uint32_t> codes;
    for (uint32_t i = 0; i < s.patches; ++i)
        codes.push_back(uint32_t(std::lround(double(i) * largest / (s.patches - 1))));
    for (uint32_t near_black = 1; near_black < codes[1]; near_black *= 2) codes.push_back(near_black);
    std::sort(codes.begin(), codes.end());
    codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
    return codes;
}

}  // namespace

std::vector<std::string> write_test_patterns(const std::string& folder, const PatternSettings& settings) {
    const uint32_t largest = (1u << settings.bits) - 1;
    std::vector<std::string> names;
    const auto save = [&](const std::string& name, const Pattern& pattern) {
        names.push_back((std::filesystem::path(folder) / name).string());
        pattern.save(names.back());
    };
    save("ramp.png", ramp(settings, largest));
    save("black.png", Pattern(settings, Codes(0)));
    save("near-black.png", steps(settings, largest, false));
    save("near-white.png", steps(settings, largest, true));
    std::string table = "code,cd_m2\n";
    for (const uint32_t code : measured_codes(settings)) {
        save(apps::format("patch-%04u.png", code), patch(settings, code));
        table += std::to_string(code) + ",\n";
    }
    // What somebody has filled in is kept.
    names.push_back((std::filesystem::path(folder) / "measurements.csv").string());
    if (!std::filesystem::exists(names.back())) apps::write_text(names.back(), table);
    return names;
}

}  // namespace vesper::commands
