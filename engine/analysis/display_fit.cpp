// SPDX-License-Identifier: MIT
#include "analysis/display_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/srgb.h"
#include "io/read_file.h"
#include "photometry/table.h"

namespace vesper::analysis {
namespace {

using vision::Display, vision::DisplayCurve, vision::Eotf, vision::kLeastBlack;

constexpr uint64_t kMaxBytes = 1u << 20;
constexpr size_t kMaxMeasurements = 100000;

double peak_of(std::span<const DisplayMeasurement> measured) {
    double peak = 0;
    for (const DisplayMeasurement& m : measured) peak = std::max(peak, m.luminance);
    return peak;
}

std::optional<DisplayMeasurement> read_line(const photometry::LineReader& lines, std::string_view line,
                                            uint32_t largest, bool heading_allowed) {
    const size_t end = line.find_first_of(",;\t ");
    if (end == line.npos) lines.fail(photometry::quoted(line) + " is not a code and a luminance");
    std::string_view rest = line.substr(end);
    while (!rest.empty() && std::string_view(",;\t ").find(rest.front()) != rest.npos) rest.remove_prefix(1);
    const auto code = photometry::number_of(line.substr(0, end)), luminance = photometry::number_of(rest);
    if (!code && !luminance && heading_allowed) return std::nullopt;
    if (!code || *code != std::floor(*code) || *code < 0 || *code > largest)
        lines.fail(photometry::quoted(line.substr(0, end)) + " is not a code from 0 to " + std::to_string(largest));
    if (!luminance || *luminance < 0 || *luminance > 1e5)
        lines.fail(photometry::quoted(rest) + " is not a luminance from 0 to 1e5 cd/m^2");
    return DisplayMeasurement{uint32_t(*code), *luminance, 0};
}

/// No display has luminances that fall as codes rise, or two of one code: by more than 10 % and 0.1 % of the peak they
/// are no noise.
void check_rise(const photometry::LineReader& lines, const std::vector<DisplayMeasurement>& sorted, double peak) {
    const auto falls = [peak](double from, double to) { return to < 0.9 * from && to < from - 1e-3 * peak; };
    const DisplayMeasurement* brightest = nullptr;  // of all smaller codes
    for (size_t first = 0, end = 0; first < sorted.size(); first = end) {
        const DisplayMeasurement *low = &sorted[first], *high = low;
        for (; end < sorted.size() && sorted[end].code == sorted[first].code; ++end) {
            if (sorted[end].luminance < low->luminance) low = &sorted[end];
            if (sorted[end].luminance > high->luminance) high = &sorted[end];
        }
        if (falls(high->luminance, low->luminance)) {
            const auto [earlier, later] =
                std::minmax(high, low, [](const auto* a, const auto* b) { return a->line < b->line; });
            lines.fail_at(later->line, "code " + std::to_string(later->code) + " has another luminance than in line " +
                                           std::to_string(earlier->line));
        }
        if (brightest && falls(brightest->luminance, low->luminance))
            lines.fail_at(low->line, "code " + std::to_string(low->code) + " is darker than code " +
                                         std::to_string(brightest->code) + " in line " +
                                         std::to_string(brightest->line));
        if (!brightest || high->luminance > brightest->luminance) brightest = high;
    }
}

void check_measurements(const photometry::LineReader& lines, const std::vector<DisplayMeasurement>& measured,
                        uint32_t largest) {
    std::vector<DisplayMeasurement> sorted = measured;
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.code < b.code; });
    std::map<uint32_t, int> codes;
    for (const DisplayMeasurement& m : sorted) ++codes[m.code];
    const size_t last = measured.empty() ? 1 : measured.back().line;
    if (codes.size() < 3)
        lines.fail_at(last, "after it there are measurements of " + std::to_string(codes.size()) +
                                " codes; at least 3 are needed");
    if (!codes.contains(0)) lines.fail_at(last, "after it there is no measurement of code 0");
    if (!codes.contains(largest))
        lines.fail_at(last, "after it there is no measurement of code " + std::to_string(largest) + ", the largest");
    const double peak = peak_of(measured);
    check_rise(lines, sorted, peak);
    const auto brightest = std::max_element(sorted.begin(), sorted.end(),
                                            [](const auto& a, const auto& b) { return a.luminance < b.luminance; });
    if (!(peak >= 0.1)) lines.fail_at(brightest->line, "the brightest code has less than 0.1 cd/m^2");
    if (sorted.front().luminance > 0.9 * peak)
        lines.fail_at(sorted.front().line, "code 0 is as bright as the brightest");
}

struct Line {
    double black = 0, range = 0, error = 0;
};

/// Least squares of (black + range x - L) / weight, with black not negative.
Line fit_line(std::span<const DisplayMeasurement> measured, double floor, const std::vector<double>& x) {
    double sw = 0, sx = 0, sxx = 0, sy = 0, sxy = 0;
    for (size_t i = 0; i < measured.size(); ++i) {
        const double y = measured[i].luminance, w = 1 / std::pow(std::max(y, floor), 2);
        sw += w, sx += w * x[i], sxx += w * x[i] * x[i], sy += w * y, sxy += w * x[i] * y;
    }
    Line line;
    line.range = (sw * sxy - sx * sy) / (sw * sxx - sx * sx);
    line.black = (sy - line.range * sx) / sw;
    if (line.black < 0) line.black = 0, line.range = sxy / sxx;
    for (size_t i = 0; i < measured.size(); ++i)
        line.error += std::pow(
            (line.black + line.range * x[i] - measured[i].luminance) / std::max(measured[i].luminance, floor), 2);
    return line;
}

void fit_gamma(Display& display, std::span<const DisplayMeasurement> measured, double floor) {
    const auto line_of = [&](double gamma) {
        std::vector<double> x;
        for (const DisplayMeasurement& m : measured)
            x.push_back(std::pow(double(m.code) / display.largest_code(), gamma));
        return fit_line(measured, floor, x);
    };
    double best = 1, least = line_of(best).error;
    for (double gamma = 0.5; gamma <= 5; gamma += 0.05)
        if (const double error = line_of(gamma).error; error < least) best = gamma, least = error;
    double low = std::max(best - 0.05, 0.5), high = std::min(best + 0.05, 5.0);
    for (int i = 0; i < 60; ++i) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        const bool nearer_to_low = line_of(a).error < line_of(b).error;
        (nearer_to_low ? high : low) = nearer_to_low ? b : a;
    }
    const Line line = line_of((low + high) / 2);
    display.gamma = float((low + high) / 2);
    display.black = float(line.black), display.peak = float(line.black + line.range);
}

/// Luminance must rise, so those of a plateau differ by this part from its first code to its last: far less than a
/// meter can tell.
constexpr double kPlateau = 1e-6;

/// Means of each code; those that do not rise are a plateau of their mean from the first code to the last (isotonic
/// regression).
void fit_table(Display& display, std::span<const DisplayMeasurement> measured) {
    struct Block {
        uint32_t first = 0, last = 0;
        double luminance = 0, weight = 0;
        void add(double mean, double more) {
            luminance = (luminance * weight + mean * more) / (weight + more), weight += more;
        }
    };
    std::map<uint32_t, Block> codes;
    for (const DisplayMeasurement& m : measured) {
        Block& b = codes[m.code];
        b.first = b.last = m.code;
        b.add(std::max(m.luminance, kLeastBlack), 1);
    }
    std::vector<Block> blocks;  // pool adjacent violators
    for (const auto& [code, next] : codes) {
        blocks.push_back(next);
        while (blocks.size() > 1 && !(blocks.back().luminance > blocks[blocks.size() - 2].luminance * (1 + kPlateau))) {
            const Block b = blocks.back();
            blocks.pop_back();
            blocks.back().add(b.luminance, b.weight);
            blocks.back().last = b.last;
        }
    }
    if (blocks.size() < 2) throw Error("the luminance of the display does not rise with the code");
    for (const Block& b : blocks) {
        display.table.push_back({double(b.first) / display.largest_code(), b.luminance});
        if (b.last > b.first)
            display.table.push_back({double(b.last) / display.largest_code(), b.luminance * (1 + kPlateau)});
    }
    display.black = float(display.table.front().luminance), display.peak = float(display.table.back().luminance);
}

}  // namespace

std::vector<DisplayMeasurement> read_display_measurements(const std::filesystem::path& file, uint32_t bits) {
    const std::vector<uint8_t> bytes = io::read_file(file, kMaxBytes);
    photometry::LineReader lines(bytes, file.string());
    const uint32_t largest = (1u << bits) - 1;
    std::vector<DisplayMeasurement> measured;
    bool heading_allowed = true;
    while (const auto next = lines.next()) {
        const std::string_view line = photometry::trimmed(next->substr(0, next->find('#')));
        if (line.empty()) continue;
        if (measured.size() == kMaxMeasurements) lines.fail("is one measurement too many: 100000 are read");
        if (auto m = read_line(lines, line, largest, heading_allowed)) {
            m->line = lines.line();
            measured.push_back(*m);
        }
        heading_allowed = false;
    }
    check_measurements(lines, measured, largest);
    return measured;
}

DisplayFit fit_display(std::span<const DisplayMeasurement> measured, uint32_t bits, Eotf eotf) {
    const double floor = 1e-4 * peak_of(measured);
    DisplayFit fit;
    Display& display = fit.display;
    display.eotf = eotf, display.bits = bits, display.ambient = 0;
    if (eotf == Eotf::Gamma) fit_gamma(display, measured, floor);
    if (eotf == Eotf::Table) fit_table(display, measured);
    if (eotf == Eotf::Srgb) {
        std::vector<double> x;
        for (const DisplayMeasurement& m : measured)
            x.push_back(srgb_to_linear(double(m.code) / display.largest_code()));
        const Line line = fit_line(measured, floor, x);
        display.black = float(line.black), display.peak = float(line.black + line.range);
    }
    if (eotf == Eotf::Pq) {
        double black = 1e5;
        for (const DisplayMeasurement& m : measured) black = std::min(black, m.luminance);
        display.black = float(black), display.peak = float(std::min(peak_of(measured), 1e4));
    }
    display.black = std::max(display.black, float(kLeastBlack));
    check_display(display);
    const DisplayCurve curve(display);
    for (const DisplayMeasurement& m : measured) {
        fit.residuals.push_back((curve.emitted(double(m.code) / display.largest_code()) - m.luminance) /
                                std::max(m.luminance, floor));
        fit.rms += std::pow(fit.residuals.back(), 2);
        fit.largest = std::max(fit.largest, std::abs(fit.residuals.back()));
    }
    fit.rms = std::sqrt(fit.rms / double(measured.size()));
    return fit;
}

DisplayFit fit_display(std::span<const DisplayMeasurement> measured, uint32_t bits) {
    for (const Eotf eotf : {Eotf::Gamma, Eotf::Srgb, Eotf::Pq}) {
        try {
            DisplayFit fit = fit_display(measured, bits, eotf);
            if (fit.rms <= 0.01 && fit.largest <= 0.03) return fit;
        } catch (const Error&) {
            // No display of that kind is near: the next.
        }
    }
    return fit_display(measured, bits, Eotf::Table);
}

}  // namespace vesper::analysis
