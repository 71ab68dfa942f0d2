// Checks and symmetry of tables of intensity. SPDX-License-Identifier: MIT
#include "photometry/table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/decimal.h"

namespace vesper::photometry {
namespace {

constexpr double kSame = 1e-6;    // deg: angles closer than this are one
constexpr double kClosing = 0.1;  // of the largest intensity: what C0 and C360 as measured may differ by

constexpr double kDark = 0.02, kNadir = 0.05;  // of the largest intensity
constexpr double kMoreLight = 1.05;            // than the lamps give: rounding of files is less

bool same(double a, double b) { return std::abs(a - b) < kSame; }

std::string number(double value) { return decimal(value, 6); }

double widest_step(const std::vector<double>& angles) {
    double widest = 0;
    for (size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
    return widest;
}

/// All intensities at one horizontal angle, linear between those of the table.
std::vector<double> plane_at(const Distribution& table, double angle) {
    const auto& list = table.horizontal;
    size_t high = 0;
    while (high + 1 < list.size() && list[high] < angle - kSame) ++high;
    const size_t low = high > 0 && !same(list[high], angle) ? high - 1 : high;
    const double weight = low == high ? 0 : std::clamp((angle - list[low]) / (list[high] - list[low]), 0.0, 1.0);
    std::vector<double> plane(table.vertical.size());
    for (size_t v = 0; v < plane.size(); ++v)
        plane[v] = (1 - weight) * table.at(low, v) + (weight > 0 ? weight * table.at(high, v) : 0);
    return plane;
}

/// Puts planes at `angles` (any order), each taken from the table at the angle `source` names.
void rebuild(Distribution& table, std::vector<double> angles, const std::function<double(double)>& source) {
    std::sort(angles.begin(), angles.end());
    angles.erase(std::unique(angles.begin(), angles.end(), same), angles.end());
    std::vector<double> candela;
    candela.reserve(angles.size() * table.vertical.size());
    for (const double angle : angles) {
        const std::vector<double> plane = plane_at(table, source(angle));
        candela.insert(candela.end(), plane.begin(), plane.end());
    }
    table.horizontal = std::move(angles);
    table.candela = std::move(candela);
}

/// Planes of type C as files hold them, brought to 0..360; false when they are none of the known ranges. `largest`:
/// intensity, cd.
bool close_planes(Distribution& table, double largest, const TableFault& fault) {
    std::vector<double>& list = table.horizontal;
    const double first = list.front(), last = list.back();
    std::vector<double> angles{0, 360};
    const auto add = [&](std::initializer_list<double> more) {
        for (const double angle : more)
            if (angle >= -kSame && angle <= 360 + kSame) angles.push_back(std::clamp(angle, 0.0, 360.0));
    };
    if (list.size() == 1) {
        list = {0};
    } else if (same(first, 0) && same(last, 90)) {
        for (const double a : list) add({a, 180 - a, 180 + a, 360 - a});
        rebuild(table, angles, [](double c) { return 90 - std::abs(90 - std::fmod(c, 180)); });
    } else if (same(first, 0) && same(last, 180)) {
        for (const double a : list) add({a, 360 - a});
        rebuild(table, angles, [](double c) { return 180 - std::abs(180 - c); });
    } else if (same(first, 90) && same(last, 270)) {  // LM-63-1995
        for (const double a : list) add({a, 180 - a, 540 - a});
        rebuild(table, angles, [](double c) { return c < 90 ? 180 - c : c > 270 ? 540 - c : c; });
    } else if (same(first, -90) && same(last, 90)) {  // EULUMDAT, C270 to C90
        for (const double a : list) add({a, a + 360, 180 - a});
        rebuild(table, angles, [](double c) { return c <= 90 ? c : c < 270 ? 180 - c : c - 360; });
    } else if (same(first, 0) && same(last, 360)) {
        list.front() = 0, list.back() = 360;  // both are one plane: the mean keeps the flux
        const size_t count = table.vertical.size(), end = table.candela.size() - count;
        for (size_t v = 0; v < count; ++v) {
            if (std::abs(table.candela[v] - table.candela[end + v]) > kClosing * largest)
                fault(TablePart::Candela, "C0 and C360 are one plane, but at gamma " + number(table.vertical[v]) +
                                              " have " + number(table.candela[v]) + " and " +
                                              number(table.candela[end + v]) + " cd");
            table.candela[v] = table.candela[end + v] = (table.candela[v] + table.candela[end + v]) / 2;
        }
    } else if (same(first, 0) && last > 180 && go_round(list)) {
        if (360 - last > widest_step(list) + kSame)
            table.notes.push_back("C planes end at " + number(last) +
                                  " deg, with a gap wider than their steps: C0 closes the circle");
        list.front() = 0;
        list.push_back(360);
        table.candela.reserve(list.size() * table.vertical.size());
        for (size_t v = 0; v < table.vertical.size(); ++v) table.candela.push_back(table.candela[v]);
    } else {
        return false;
    }
    return true;
}

/// Some files have the last angle twice, with the same intensities.
void drop_repeated_ends(Distribution& table, const TableFault& fault) {
    const size_t count = table.vertical.size();
    const auto differ = [&](TablePart part, const char* what, double angle) {
        fault(part, std::string(what) + " angle " + number(angle) + " is there twice, with other intensities");
    };
    if (table.horizontal.size() > 1 && same(table.horizontal.back(), table.horizontal.end()[-2])) {
        const auto last = table.candela.end() - static_cast<ptrdiff_t>(count);
        if (!std::equal(last, table.candela.end(), last - static_cast<ptrdiff_t>(count)))
            differ(TablePart::Horizontal, table.goniometry == Goniometry::CGamma ? "C" : "horizontal",
                   table.horizontal.back());
        table.horizontal.pop_back();
        table.candela.resize(table.horizontal.size() * count);
    }
    if (count < 2 || !same(table.vertical.back(), table.vertical.end()[-2])) return;
    for (size_t h = 0; h < table.horizontal.size(); ++h)
        if (table.at(h, count - 1) != table.at(h, count - 2))
            differ(TablePart::Vertical, table.goniometry == Goniometry::CGamma ? "gamma" : "vertical",
                   table.vertical.back());
    table.vertical.pop_back();
    for (size_t h = 0; h < table.horizontal.size(); ++h)
        for (size_t v = 0; v + 1 < count; ++v) table.candela[h * (count - 1) + v] = table.candela[h * count + v];
    table.candela.resize(table.horizontal.size() * (count - 1));
}

/// Why a list of angles is not one; empty if it is.
std::string objection_to(const std::vector<double>& angles, const char* what, double low, double high) {
    const std::string range = number(low) + " to " + number(high);
    for (size_t i = 0; i < angles.size(); ++i) {
        if (!(angles[i] >= low - kSame && angles[i] <= high + kSame))
            return std::string(what) + " angle " + number(angles[i]) + " is not in " + range;
        if (i > 0 && !(angles[i] > angles[i - 1]))
            return std::string(what) + " angles do not ascend: " + number(angles[i]) + " follows " +
                   number(angles[i - 1]);
    }
    return {};
}

/// Whether types A and B begin at V = 0 with light there.
bool is_bright_from_zero(const Distribution& table, double largest) {
    if (table.goniometry == Goniometry::CGamma || !same(table.vertical.front(), 0)) return false;
    for (size_t h = 0; h < table.horizontal.size(); ++h)
        if (table.at(h, 0) > kDark * largest) return true;
    return false;
}

/// V from 0 as V of both signs.
void mirror_below(Distribution& table) {
    const size_t count = table.vertical.size(), all = 2 * count - 1;
    std::vector<double> angles(all), candela(all * table.horizontal.size());
    for (size_t v = 0; v < count; ++v)
        angles[count - 1 + v] = table.vertical[v], angles[count - 1 - v] = -table.vertical[v];
    angles[count - 1] = 0;
    for (size_t h = 0; h < table.horizontal.size(); ++h)
        for (size_t v = 0; v < count; ++v)
            candela[h * all + count - 1 + v] = candela[h * all + count - 1 - v] = table.at(h, v);
    table.vertical = std::move(angles), table.candela = std::move(candela);
}

/// Where programs read tables of type C in other ways.
void note_planes(Distribution& table, double largest) {
    if (same(table.vertical.front(), 0)) {
        double least = table.at(0, 0), most = least;
        for (size_t h = 0; h < table.horizontal.size(); ++h)
            least = std::min(least, table.at(h, 0)), most = std::max(most, table.at(h, 0));
        if (most - least > kNadir * largest)
            table.notes.push_back("planes differ at the nadir, from " + number(least) + " to " + number(most) +
                                  " cd: each is taken as it is");
    }
    double edge = 0;
    for (size_t h = 0; h < table.horizontal.size(); ++h) edge = std::max(edge, table.at(h, table.vertical.size() - 1));
    const double last = table.vertical.back();  // 90 and 180 say that light of a hemisphere or both is known
    if (!same(last, 90) && !same(last, 180) && edge > kDark * largest)
        table.notes.push_back("gamma ends at " + number(last) + " deg with " + number(edge) +
                              " cd: beyond there is no light");
}

}  // namespace

std::string objection_to_size(double horizontal, double vertical) {
    for (const auto& [count, what] : {std::pair(horizontal, "horizontal"), std::pair(vertical, "vertical")})
        if (!(count >= 1 && count <= static_cast<double>(kMaxAngles) && count == std::floor(count)))
            return number(count) + " " + what + " angles: a whole number from 1 to " + std::to_string(kMaxAngles) +
                   " is read";
    if (vertical < 2) return "one vertical angle makes no distribution";
    if (horizontal * vertical > static_cast<double>(kMaxCells))
        return "a table of more than " + std::to_string(kMaxCells) + " intensities is not read";
    return {};
}

bool go_round(const std::vector<double>& planes) { return 360 - planes.back() <= 1.5 * widest_step(planes) + kSame; }

void finish_table(Distribution& table, bool halves, const TableFault& fault) {
    const bool c = table.goniometry == Goniometry::CGamma, b = table.goniometry == Goniometry::TypeB;
    drop_repeated_ends(table, fault);
    std::string reason =
        objection_to_size(static_cast<double>(table.horizontal.size()), static_cast<double>(table.vertical.size()));
    if (!reason.empty()) fault(TablePart::Vertical, reason);
    reason = c ? objection_to(table.vertical, "gamma", 0, 180)
               : objection_to(table.vertical, "vertical", b ? -180 : -90, b ? 180 : 90);
    if (!reason.empty()) fault(TablePart::Vertical, reason);
    reason = c ? objection_to(table.horizontal, "C", -90, 360)
               : objection_to(table.horizontal, "horizontal", b ? -90 : -180, b ? 90 : 180);
    if (!reason.empty()) fault(TablePart::Horizontal, reason);

    const double largest = largest_intensity(table);
    for (double& candela : table.candela) {
        if (!std::isfinite(candela) || candela > 1e12)
            fault(TablePart::Candela, "an intensity is not finite, or more than 1e12 cd");
        if (candela < -0.01 * largest || (candela < 0 && !(largest > 0)))
            fault(TablePart::Candela, "a negative intensity of " + number(candela) + " cd");
        if (!(candela > 0)) candela = 0;  // also -0
    }
    const double range = table.horizontal.back() - table.horizontal.front();
    const bool below = halves && is_bright_from_zero(table, largest);
    const size_t copies = !c || table.horizontal.size() == 1 || range > 181 ? 1 : range > 91 ? 2 : 4;
    if (below && 2 * table.vertical.size() > kMaxAngles)
        fault(TablePart::Vertical, "more than " + std::to_string(kMaxAngles) + " vertical angles on both sides of 0");
    if (copies * (below ? 2 : 1) * table.candela.size() > kMaxCells)
        fault(TablePart::Horizontal, "more than " + std::to_string(kMaxCells) + " intensities, symmetry expanded");
    if (c && !close_planes(table, largest, fault))
        fault(TablePart::Horizontal,
              "C planes from " + number(table.horizontal.front()) + " to " + number(table.horizontal.back()) +
                  " are no range that is defined (0 to 90, 180 or 360; 90 to 270), and do not go round");
    if (c) return note_planes(table, largest);
    if (below) {
        mirror_below(table);
        table.notes.push_back("V begins at 0, where it is bright: taken for both sides of V = 0 (readers differ)");
    } else if (halves && same(table.vertical.front(), 0)) {
        table.notes.push_back("V begins at 0, where it is dark: below V = 0 there is no light (readers differ)");
    }
    if (table.horizontal.size() < 2) fault(TablePart::Horizontal, "one horizontal angle makes no distribution");
    if (halves && same(table.horizontal.front(), 0)) {
        std::vector<double> angles = table.horizontal;
        angles.front() = 0;
        for (const double angle : table.horizontal) angles.push_back(-angle);
        rebuild(table, angles, [](double h) { return std::abs(h); });
        table.notes.push_back("H begins at 0: taken for both sides of H = 0");
    }
}

void note_flux(Distribution& table) {
    const double flux = luminous_flux(table);
    const bool more = table.lamp_flux > 0 && flux > kMoreLight * table.lamp_flux;
    if (table.notes.empty() && !more) return;
    table.notes.push_back("its intensities are " + number(flux) + " lm in all; the file states " +
                          (table.lamp_flux > 0 ? number(table.lamp_flux) + " lm of lamps" : "none (absolute)"));
}

Distribution mirrored(const Distribution& original) {
    Distribution made = original;
    if (original.goniometry != Goniometry::CGamma) {
        std::vector<double> angles;
        for (const double angle : original.horizontal) angles.push_back(-angle);
        rebuild(made, angles, [](double h) { return -h; });
    } else if (original.horizontal.size() > 1) {
        const auto reflect = [](double c) { return c <= 180 ? 180 - c : 540 - c; };
        std::vector<double> angles{0, 360};
        for (const double angle : original.horizontal) angles.push_back(reflect(angle));
        rebuild(made, angles, reflect);
    }
    return made;
}

}  // namespace vesper::photometry
