// Measured lamps and r-tables. SPDX-License-Identifier: MIT
#include <cmath>

#include "arguments/arguments.h"
#include "base/one_line.h"
#include "inspect.h"
#include "photometry/reflection_table.h"
#include "plot.h"
#include "print.h"

namespace vesper::commands {
namespace {

using apps::format;

const char* name_of(photometry::Goniometry goniometry) {
    return goniometry == photometry::Goniometry::CGamma  ? "type C (C, gamma)"
           : goniometry == photometry::Goniometry::TypeB ? "type B (H, V)"
                                                         : "type A (H, V)";
}

std::vector<std::pair<std::string, photometry::Cut>> cuts_of(const photometry::Distribution& d,
                                                             const photometry::BeamFigures& f) {
    if (d.goniometry != photometry::Goniometry::CGamma)
        return {{format("along H at V %g", f.largest_v), photometry::horizontal_cut(d, f.largest_v)},
                {format("along V at H %g", f.largest_h), photometry::vertical_cut(d, f.largest_h)}};
    std::vector<std::pair<std::string, photometry::Cut>> cuts{{"C0-C180", photometry::plane_cut(d, 0)},
                                                              {"C90-C270", photometry::plane_cut(d, 90)}};
    if (std::fmod(f.largest_h, 90) != 0)
        cuts.emplace_back(format("C%g-C%g", f.largest_h, std::fmod(f.largest_h + 180, 360)),
                          photometry::plane_cut(d, f.largest_h));
    return cuts;
}

std::string ranges_text(const photometry::Distribution& d) {
    const bool c = d.goniometry == photometry::Goniometry::CGamma;
    return format("  angles       %zu x %zu, %s %g to %g, %s %g to %g deg\n", d.horizontal.size(), d.vertical.size(),
                  c ? "C" : "H", d.horizontal.front(), d.horizontal.back(), c ? "gamma" : "V", d.vertical.front(),
                  d.vertical.back());
}

void add_widths(Inspection& made, const photometry::Distribution& d, const photometry::BeamFigures& f) {
    made.text += "\n  width, deg          50 % of the cut's greatest     10 %\n";
    for (const auto& [name, cut] : cuts_of(d, f)) {
        const auto half = photometry::width_of(cut, 0.5), tenth = photometry::width_of(cut, 0.1);
        if (!half || !tenth) continue;
        made.text += format("  %-18s %6.1f (%.1f to %.1f)", name.c_str(), half->angle(), half->from, half->to);
        made.text += format("   %6.1f (%.1f to %.1f)\n", tenth->angle(), tenth->from, tenth->to);
        made.json["widths_deg"].push_back({{"cut", name},
                                           {"half", half->angle()},
                                           {"half_range", {half->from, half->to}},
                                           {"tenth", tenth->angle()},
                                           {"tenth_range", {tenth->from, tenth->to}}});
    }
}

void add_cut_off(Inspection& made, const photometry::BeamFigures& f) {
    const auto& g = f.at_70_80_90_95;
    made.text += format("\n  cd per klm of the luminaire at gamma 70: %.4g, 80: %.4g, 90: %.4g, from 95 up: %.4g\n",
                        g[0], g[1], g[2], g[3]);
    made.text +=
        "  luminous intensity class (EN 13201-2, annex A): " + (f.glare_class.empty() ? "none" : f.glare_class) + "\n";
    made.text += format("  light above the horizontal: %.2f %% of the flux\n", 100 * f.upward_share);
    if (f.upward_share > 0.5) {
        const char* doubt = "implausible for a road: more light goes up than down; is the file upside down?";
        made.text += std::string("  ") + doubt + "\n";
        made.json["doubt"] = doubt;
    }
    made.json["cd_per_klm"] = {{"70", g[0]}, {"80", g[1]}, {"90", g[2]}, {"95_and_up", g[3]}};
    made.json["intensity_class"] = f.glare_class;
    made.json["upward_share"] = f.upward_share;
}

void add_beam_points(Inspection& made, const photometry::Distribution& d) {
    std::string rows;
    for (const photometry::BeamPoint& p : photometry::passing_beam_points()) {
        const double candela = photometry::intensity_at(d, p.h, p.v);
        const bool holds = candela >= p.least && (p.most == 0 || candela <= p.most);
        rows += format("  %-5s %6.2f %6.2f %10.1f   %s %g %s\n", p.name, p.h, p.v, candela,
                       p.least > 0 ? ">=" : "<=", p.least > 0 ? p.least : p.most, holds ? "ok" : "missed");
        made.json["r112_class_b"].push_back(
            {{"point", p.name}, {"h_deg", p.h}, {"v_deg", p.v}, {"cd", candela}, {"holds", holds}});
    }
    made.text +=
        "\n  as a passing beam of UN R112, class B, right-hand traffic\n  point   H, deg  V, deg    cd   limit\n" +
        rows;
}

}  // namespace

Inspection inspect_distribution(const InspectArguments& arguments) {
    const photometry::Distribution d = photometry::read_distribution(arguments.file);
    const photometry::BeamFigures f = photometry::beam_figures(d);
    Inspection made;
    made.text = one_line(arguments.file) + "\n  " + apps::column(d.name, 100) + "\n";
    while (made.text.ends_with(" \n")) made.text.erase(made.text.size() - 2, 1);
    made.text += format("  goniometry   %s\n", name_of(d.goniometry)) + ranges_text(d);
    made.text += format("  symmetry     %s\n  flux         %.1f lm", photometry::name_of(f.symmetry), f.flux);
    made.text += d.lamp_flux > 0 ? format(", %.1f %% of the lamps' %.0f lm\n", 100 * f.output_ratio, d.lamp_flux)
                                 : " (absolute photometry)\n";
    const bool c = d.goniometry == photometry::Goniometry::CGamma;
    made.text += format("  greatest     %.4g cd at %s %g, %s %g deg\n", f.largest, c ? "C" : "H", f.largest_h,
                        c ? "gamma" : "V", f.largest_v);
    const photometry::LuminousOpening& o = d.opening;
    if (o.length > 0 || o.width > 0 || o.height > 0)
        made.text += format("  opening      %g x %g x %g m%s\n", o.length, o.width, o.height, o.round ? ", round" : "");
    if (o.area() > 0)
        made.text += format("  mean luminance of the opening along the axis %.4g cd/m2\n",
                            photometry::intensity_at(d, 0, 0) / o.area());
    made.json = {{"kind", "distribution"},
                 {"name", d.name},
                 {"goniometry", name_of(d.goniometry)},
                 {"symmetry", photometry::name_of(f.symmetry)},
                 {"horizontal_deg", {d.horizontal.front(), d.horizontal.back()}},
                 {"vertical_deg", {d.vertical.front(), d.vertical.back()}},
                 {"flux_lm", f.flux},
                 {"lamp_flux_lm", d.lamp_flux},
                 {"greatest_cd", f.largest},
                 {"greatest_at_deg", {f.largest_h, f.largest_v}},
                 {"opening_m", {o.length, o.width, o.height}}};
    if (d.lamp_flux > 0) made.json["output_ratio"] = f.output_ratio;
    add_widths(made, d, f);
    if (c && f.flux > 0) add_cut_off(made, f);
    if (!c && f.largest > 2000) add_beam_points(made, d);
    for (const std::string& note : d.notes) {
        made.text += "  note         " + note + "\n";
        made.json["notes"].push_back(note);
    }
    if (!d.metadata.empty()) made.text += "\n";
    for (const auto& [key, value] : d.metadata) {
        made.text += "  " + key + ": " + value + "\n";
        made.json["metadata"].push_back({key, value});
    }
    if (!arguments.picture.empty()) {
        apps::Canvas canvas(kPlotWidth, kPlotHeight);
        draw_distribution(canvas, d, f);
        canvas.save(arguments.picture);
    }
    return made;
}

Inspection inspect_table(const InspectArguments& arguments) {
    const photometry::ReflectionTable t = photometry::read_reflection_table(arguments.file);
    const double q0 = photometry::average_luminance_coefficient(t), s1 = photometry::specular_factor(t);
    Inspection made;
    made.text = one_line(arguments.file) + "\n  " + t.name +
                format(": r-table of %zu tan gamma to %g and %zu beta\n", t.tan_gamma.size(), t.tan_gamma.back(),
                       t.beta.size());
    made.text +=
        format("  Q0 %.4f 1/sr by integration", q0) + (t.stated_q0 > 0 ? format(", %.4g stated\n", t.stated_q0) : "\n");
    made.text += format("  S1 %.3f, r(0, 0) %.4f 1/sr\n", s1, t.at(0, 0));
    made.json = {{"kind", "reflection table"}, {"name", t.name}, {"q0", q0},
                 {"stated_q0", t.stated_q0},   {"s1", s1},       {"r00", t.at(0, 0)}};
    return made;
}

}  // namespace vesper::commands
