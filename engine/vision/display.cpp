// SPDX-License-Identifier: MIT
#include "vision/display.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/srgb.h"

namespace vesper::vision {
namespace {

constexpr double kRoot = 2.2;

/// Derivatives that keep a cubic Hermite spline monotone: Fritsch and Carlson 1980, with the weighted harmonic mean of
/// Fritsch and Butland 1984 inside and one-sided differences at the ends.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
    const size_t n = x.size();
    std::vector<double> secant(n - 1), slope(n);
    for (size_t i = 0; i + 1 < n; ++i) secant[i] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    slope.front() = secant.front();
    slope.back() = secant.back();
    for (size_t i = 1; i + 1 < n; ++i) {
        if (!(secant[i - 1] * secant[i] > 0)) continue;
        const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
        slope[i] = 3 * (left + right) / ((2 * right + left) / secant[i - 1] + (right + 2 * left) / secant[i]);
    }
    return slope;
}

}  // namespace

void check_display(const Display& d) {
    const auto in = [](double value, double low, double high) { return value >= low && value <= high; };
    if (!in(double(d.peak), 0.1, 1e5)) throw Error("the peak luminance of a display is 0.1 to 1e5 cd/m^2");
    if (!in(double(d.black), 0, 1e3)) throw Error("the black luminance of a display is 0 to 1000 cd/m^2");
    if (!(d.peak > d.black)) throw Error("the peak luminance of a display must be more than its black luminance");
    if (!in(double(d.gamma), 0.5, 5)) throw Error("the gamma of a display is 0.5 to 5");
    if (!in(double(d.ambient), 0, 1e5)) throw Error("the illuminance on a display is 0 to 1e5 lx");
    if (!in(double(d.reflection), 0, 1)) throw Error("the diffuse reflectance of a display is 0 to 1");
    if (!(d.low() >= float(kLeastBlack)))
        throw Error("black and reflected light of a display together must be at least 1e-6 cd/m^2");
    if (d.bits != 8 && d.bits != 10) throw Error("a display has 8 or 10 bits a channel");
    if (d.eotf == Eotf::Pq && d.peak > 10000) throw Error("PQ ends at 10,000 cd/m^2");
    io::to_rec709(d.primaries);
    if (!io::make_white(d.primaries)) throw Error("the white of a display lies inside the triangle of its primaries");
    if (d.eotf != Eotf::Table) return;
    if (d.table.size() < 2 || d.table.size() > 4096) throw Error("the table of a display has 2 to 4096 measurements");
    if (d.table.front().code != 0 || d.table.back().code != 1)
        throw Error("the table of a display must begin with code 0 and end with the largest");
    for (size_t i = 1; i < d.table.size(); ++i)
        if (!(d.table[i].code > d.table[i - 1].code && d.table[i].luminance > d.table[i - 1].luminance))
            throw Error("measurement " + std::to_string(i + 1) +
                        " of a display's table does not rise above the one before");
    if (float(d.table.front().luminance) != d.black || float(d.table.back().luminance) != d.peak)
        throw Error("the table of a display must begin with its black and end with its peak luminance");
}

DisplayCurve::DisplayCurve(const Display& display)
    : eotf_(display.eotf), peak_(double(display.peak)), black_(double(display.black)), gamma_(double(display.gamma)) {
    if (eotf_ != Eotf::Table) return;
    check_display(display);
    for (const DisplaySample& sample : display.table) {
        codes_.push_back(sample.code);
        roots_.push_back(std::pow(std::max(sample.luminance - display.table.front().luminance, 0.0), 1 / kRoot));
    }
    slopes_ = monotone_slopes(codes_, roots_);
}

double DisplayCurve::emitted(double code) const {
    const double v = std::clamp(code, 0.0, 1.0);
    switch (eotf_) {
        case Eotf::Gamma:
            return black_ + (peak_ - black_) * std::pow(v, gamma_);
        case Eotf::Srgb:
            return black_ + (peak_ - black_) * srgb_to_linear(v);
        case Eotf::Pq:
            return std::clamp(pq_luminance(v), black_, peak_);
        case Eotf::Table:
            break;
    }
    const auto above = std::upper_bound(codes_.begin() + 1, codes_.end() - 1, v);
    const auto i = size_t(above - codes_.begin()) - 1;
    const double width = codes_[i + 1] - codes_[i], t = (v - codes_[i]) / width;
    const double root = roots_[i] * (1 + 2 * t) * (1 - t) * (1 - t) + roots_[i + 1] * t * t * (3 - 2 * t) +
                        width * t * (1 - t) * (slopes_[i] * (1 - t) - slopes_[i + 1] * t);
    return black_ + std::pow(std::max(root, 0.0), kRoot);
}

double pq_luminance(double signal) {
    constexpr double m1 = 2610.0 / 16384, m2 = 2523.0 / 32, c1 = 3424.0 / 4096, c2 = 2413.0 / 128, c3 = 2392.0 / 128;
    const double e = std::pow(std::clamp(signal, 0.0, 1.0), 1 / m2);
    return 10000 * std::pow(std::max(e - c1, 0.0) / (c2 - c3 * e), 1 / m1);
}

const std::vector<NamedDisplay>& known_displays() {
    // lcd, office, bright and crt: pfstools 2.2.0 (pfstmo_mantiuk08, --display-function).
    static const std::vector<NamedDisplay> displays{
        {"desk", "an office monitor in a dim room: 100 cd/m^2, black 0.1, gamma 2.2, 5 lx", {}},
        {"lcd", "200 cd/m^2, black 0.8, gamma 2.2, 60 lx", {.peak = 200, .black = 0.8f, .ambient = 60}},
        {"office", "100 cd/m^2, black 0.8, gamma 2.2, 400 lx", {.peak = 100, .black = 0.8f, .ambient = 400}},
        {"bright",
         "500 cd/m^2, black 0.5, gamma 2.6, 10 lx",
         {.peak = 500, .black = 0.5f, .gamma = 2.6f, .ambient = 10}},
        {"crt",
         "80 cd/m^2, black 1, gamma 2.2, 60 lx on a screen that reflects 2 %",
         {.peak = 80, .black = 1, .ambient = 60, .reflection = 0.02f}},
        {"projector",
         "a simulator's projection: 10 cd/m^2, black 0.05, gamma 2.2, dark",
         {.peak = 10, .black = 0.05f, .ambient = 0}},
        {"srgb",
         "80 cd/m^2, black 0.2, 64 lx, IEC 61966-2-1",
         {.peak = 80, .black = 0.2f, .ambient = 64, .eotf = Eotf::Srgb}},
        {"hdr10",
         "1000 cd/m^2, black 0.005, PQ with 10 bits in Rec. 2020, 5 lx",
         {.peak = 1000, .black = 0.005f, .ambient = 5, .eotf = Eotf::Pq, .bits = 10, .primaries = io::kRec2020}},
    };
    return displays;
}

std::string known_display_names() {
    std::string names;
    for (const NamedDisplay& known : known_displays()) names += std::string(names.empty() ? "" : ", ") + known.name;
    return names;
}

}  // namespace vesper::vision
