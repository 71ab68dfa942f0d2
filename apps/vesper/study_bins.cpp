// Study: how many bins a histogram needs. SPDX-License-Identifier: MIT

#include "arguments/arguments.h"
#include "print.h"
#include "study.h"

namespace vesper::commands {
namespace {

using apps::format;

constexpr uint32_t kBins[]{16, 20, 24, 32, 40, 50, 64, 80, 100, 128, 160, 200, 256};
constexpr double kLimit = 1;  // codes

/// The fewest bins from which on every number of them stays within the limit; 0: not even the finest does.
struct Fewest {
    uint32_t bins = 0;
    void add(uint32_t number, bool within) { bins = !within ? 0 : bins ? bins : number; }
    std::string text() const { return bins ? std::to_string(bins) : "none"; }
};

const std::vector<std::string> kBinsColumns{"picture",       "operator",           "votes",     "bins", "curve_codes",
                                            "largest_codes", "percentile99_codes", "mean_codes"};

bool is_shown(uint32_t bins) { return bins == 16 || bins == 32 || bins == 64 || bins == 100; }

// Rows: of all numbers of bins, and last the answer. Numbers: largest difference of the curve for each, codes, with
// whole votes and with shared ones; last that of the default.
StudyPart study_one(const Study& study, const StudyPicture& picture, render::Operator op) {
    StudyPart part;
    part.numbers.resize(2 * std::size(kBins) + 1);
    render::ToneChainSettings settings = study.settings;
    settings.tone_operator = op;
    const std::vector<double> luminances = luminances_of(picture);
    const auto map = [&](uint32_t bins, bool split) {
        settings.histogram.bins = bins, settings.histogram.split = split;
        return study.map(picture, settings);
    };
    const std::string stem = picture.name + "-" + apps::name_of(op);
    const render::ToneMapped finest = map(256, true);
    const std::vector<double> finest_codes = curve_codes(finest, op, settings.display, luminances);
    apps::write_codes(study.file(stem + "-256-shared.png"), finest, settings.display);
    apps::LinePlot plot{.title = picture.name + ", " + apps::name_of(op) + ": curves",
                        .x_name = "luminance of the scene, cd/m\u00b2",
                        .y_name = "display code",
                        .lines = {},
                        .log_x = true};
    const auto add_curve = [&](const std::string& name, const std::vector<double>& codes) {
        plot.lines.push_back({.name = name, .points = {}, .dashed = !plot.lines.empty()});
        for (size_t i = 0; i < codes.size(); ++i) plot.lines.back().points.push_back({luminances[i], codes[i]});
    };
    add_curve("256, shared votes", finest_codes);
    part.shown.push_back({stem + "-256-shared.png", "256 bins, shared votes: the finest"});
    Fewest curve[2], most[2], pixels[2];
    for (const bool split : {true, false}) {
        const std::string votes = split ? "shared" : "whole";
        for (size_t i = 0; i < std::size(kBins); ++i) {
            const uint32_t bins = kBins[i];
            const render::ToneMapped got = map(bins, split);
            const std::vector<double> codes = curve_codes(got, op, settings.display, luminances);
            Difference d = difference(got, finest, settings.display);
            d.curve = largest_difference(codes, finest_codes);
            curve[split].add(bins, d.curve <= kLimit);
            most[split].add(bins, d.percentile <= kLimit);
            pixels[split].add(bins, d.largest <= kLimit);
            part.numbers[(split ? std::size(kBins) : 0) + i] = d.curve;
            if (split && bins == render::HistogramSettings{}.bins) part.numbers.back() = d.curve;
            part.rows.push_back({picture.name, apps::name_of(op), votes, std::to_string(bins), format("%.4f", d.curve),
                                 format("%.0f", d.largest), format("%.0f", d.percentile), format("%.5f", d.mean)});
            if (is_shown(bins)) {
                const std::string name = stem + "-" + std::to_string(bins) + "-" + votes;
                apps::write_codes(study.file(name + ".png"), got, settings.display);
                save_difference(study.file(name + "-difference.png"), got.extent.width, got.extent.height, d.map);
                part.shown.push_back({name + ".png", std::to_string(bins) + " bins, " + votes + " votes"});
                part.shown.push_back({name + "-difference.png", "difference to the finest: " + describe(d)});
                if (bins == 16 || bins == 100) add_curve(std::to_string(bins) + ", " + votes + " votes", codes);
            }
        }
    }
    part.rows.push_back({picture.name, apps::name_of(op), curve[1].text(), curve[0].text(), most[1].text(),
                         most[0].text(), pixels[1].text(), pixels[0].text()});
    apps::save_plot(study.file(stem + "-curves.png"), plot);
    return part;
}

}  // namespace

void study_bins(Study& study) {
    const std::vector<render::Operator> ops =
        studied_operators(study.arguments, histogram_operators(), "it does not adjust a histogram");
    const std::vector<StudyPart> parts = study.parts("bins", study.pictures.size() * ops.size(), [&](size_t condition) {
        return study_one(study, study.pictures[condition / ops.size()], ops[condition % ops.size()]);
    });
    if (parts.empty()) return;
    std::vector<std::vector<std::string>> rows, answers;
    Fewest shared_curve, whole_curve;  // over all pictures and operators
    std::vector<double> worst(2 * std::size(kBins) + 1);
    for (const StudyPart& part : parts) {
        const std::string &picture = part.rows.back()[0], &op = part.rows.back()[1];
        rows.insert(rows.end(), part.rows.begin(), part.rows.end() - 1), answers.push_back(part.rows.back());
        for (size_t i = 0; i < worst.size(); ++i) worst[i] = std::max(worst[i], part.numbers[i]);
        study.page.heading(picture + ", " + op);
        study.page.plot(picture + "-" + op + "-curves.png");
        study.page.pictures(part.shown);
    }
    const double of_default = worst.back();  // codes
    apps::LinePlot plot{
        .title = "Largest difference of the curve to 256 bins with shared votes, all pictures and operators",
        .x_name = "bins",
        .y_name = "codes",
        .lines = {},
        .log_x = true,
        .log_y = true,
        .rule = kLimit};
    for (const bool split : {true, false}) {
        plot.lines.push_back({.name = split ? "shared votes" : "whole votes", .points = {}, .marks = true});
        for (size_t i = 0; i < std::size(kBins); ++i) {
            const double codes = worst[(split ? std::size(kBins) : 0) + i];
            plot.lines.back().points.push_back({double(kBins[i]), codes});
            (split ? shared_curve : whole_curve).add(kBins[i], codes <= kLimit);
        }
    }
    apps::save_plot(study.file("bins.png"), plot);
    apps::write_text(study.file("bins.csv"), csv_of(kBinsColumns, rows));
    const std::vector<std::string> columns{"picture",
                                           "operator",
                                           "curve, shared votes",
                                           "curve, whole votes",
                                           "99 % of pixels, shared votes",
                                           "99 % of pixels, whole votes",
                                           "every pixel, shared votes",
                                           "every pixel, whole votes"};
    const std::string answer = format(
        "Fewest bins from which on every curve is within %g code of that of 256 bins with shared votes: %s with shared "
        "votes, %s with whole votes.",
        kLimit, shared_curve.text().c_str(), whole_curve.text().c_str());
    const uint32_t standard = render::HistogramSettings{}.bins;
    const bool follows = of_default <= kLimit;
    const std::string verdict =
        format("The default of %u bins with shared votes is %.2f codes away at most: it %s.", standard, of_default,
               follows ? "follows" : "does not follow from this criterion");
    study.page.heading("Answer");
    study.page.paragraph(answer + " " + verdict + " Differences are of display codes.");
    study.page.table(columns, answers);
    study.page.plot("bins.png");
    study.page.heading("All figures");
    study.page.table(kBinsColumns, rows);
    for (const auto& row : answers)
        apps::print(
            "%s, %s: within %g code from so many bins on with shared (whole) votes: curve %s (%s), 99 %% of pixels %s "
            "(%s), every pixel %s (%s)\n",
            row[0].c_str(), row[1].c_str(), kLimit, row[2].c_str(), row[3].c_str(), row[4].c_str(), row[5].c_str(),
            row[6].c_str(), row[7].c_str());
    apps::print("%s\n%s\n", answer.c_str(), verdict.c_str());
}

}  // namespace vesper::commands
