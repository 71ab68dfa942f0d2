// What the studies measure with. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "print.h"
#include "ranks/ranks.h"
#include "study.h"

namespace vesper::commands {
namespace {

/// Three codes a pixel.
std::vector<uint32_t> codes_of(const render::ToneMapped& shown, const vision::Display& display) {
    std::vector<uint32_t> codes;
    codes.reserve(shown.display.size() / 4 * 3);
    for (size_t i = 0; i < shown.display.size(); i += 4) {
        uint32_t word;
        std::memcpy(&word, &shown.display[i], 4);
        for (uint32_t c = 0; c < 3; ++c) codes.push_back(word >> (c * display.bits) & display.largest_code());
    }
    return codes;
}

/// The code, fractions included, of a luminance in the dark.
double code_of(const vision::DisplayCurve& curve, double luminance, uint32_t largest) {
    double low = 0, high = 1;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (curve.emitted(middle) < luminance ? low : high) = middle;
    }
    return (low + high) / 2 * largest;
}

void write_texts(apps::PacketWriter& packet, const std::vector<std::string>& texts) {
    packet.value(texts.size());
    for (const std::string& text : texts) packet.list(text);
}

std::vector<std::string> read_texts(apps::PacketReader& packet) {
    std::vector<std::string> texts;
    for (auto left = packet.value<size_t>(); left > 0; --left) texts.push_back(packet.text());
    return texts;
}

apps::Bytes bytes_of(const StudyPart& part) {
    apps::PacketWriter packet;
    packet.value(part.rows.size());
    for (const std::vector<std::string>& row : part.rows) write_texts(packet, row);
    packet.value(part.lines.size());
    for (const apps::PlotLine& line : part.lines)
        packet.list(line.name), packet.list(line.points), packet.value(line.dashed), packet.value(line.marks),
            packet.value(line.colour ? int(*line.colour) : -1);
    packet.value(part.shown.size());
    for (const StudyPage::Figure& figure : part.shown) packet.list(figure.file), packet.list(figure.caption);
    packet.list(part.numbers);
    return packet.take();
}

StudyPart part_of(const apps::Bytes& bytes) {
    apps::PacketReader packet(bytes);
    StudyPart part;
    for (auto left = packet.value<size_t>(); left > 0; --left) part.rows.push_back(read_texts(packet));
    for (auto left = packet.value<size_t>(); left > 0; --left) {
        apps::PlotLine& line = part.lines.emplace_back();
        line.name = packet.text(), line.points = packet.list<glm::dvec2>();
        packet.value(line.dashed), packet.value(line.marks);
        if (const int colour = packet.value<int>(); colour >= 0) line.colour = size_t(colour);
    }
    for (auto left = packet.value<size_t>(); left > 0; --left) {
        StudyPage::Figure& figure = part.shown.emplace_back();
        figure.file = packet.text(), figure.caption = packet.text();
    }
    part.numbers = packet.list<double>();
    return part;
}

}  // namespace

std::vector<StudyPart> Study::parts(const std::string& what, size_t conditions,
                                    const std::function<StudyPart(size_t)>& make) const {
    apps::Ranks& ranks = apps::Ranks::all();
    apps::Progress progress(what, unsigned(conditions));
    std::vector<StudyPart> all;
    const auto rank_of = [&](size_t condition) { return int(condition % size_t(ranks.size())); };
    const auto take_until = [&](size_t condition) {
        for (; all.size() < condition; progress.step())
            all.push_back(part_of(ranks.receive(rank_of(all.size()), apps::Ranks::Stream::Records)));
    };
    for (size_t i = 0; i < conditions; ++i) {
        if (rank_of(i) != ranks.rank()) continue;
        StudyPart part = make(i);
        if (!ranks.is_first()) {
            ranks.send(0, apps::Ranks::Stream::Records, bytes_of(part));
            continue;
        }
        take_until(i);
        all.push_back(std::move(part)), progress.step();
    }
    if (ranks.is_first()) take_until(conditions);
    return all;
}

render::ToneMapped Study::map(const StudyPicture& picture, const render::ToneChainSettings& with) const {
    mapper.reset_adaptation();
    return mapper.map(with, picture.host(), 0);
}

std::vector<render::Operator> histogram_operators() {
    std::vector<render::Operator> found;
    for (const render::OperatorInfo& op : render::operators())
        if (op.histogram) found.push_back(op.tone_operator);
    return found;
}

std::vector<render::Operator> studied_operators(const StudyArguments& arguments,
                                                const std::vector<render::Operator>& candidates,
                                                const std::string& why) {
    if (arguments.tone.command.count("--operator") == 0) return candidates;
    const render::Operator given = apps::tone_settings(arguments.tone).tone_operator;
    if (std::find(candidates.begin(), candidates.end(), given) == candidates.end())
        throw Error("--operator " + apps::name_of(given) + ": " + why);
    return {given};
}

std::vector<double> luminances_of(const StudyPicture& picture) {
    constexpr int kSteps = 1000;
    std::vector<double> luminances;
    for (int i = 0; i <= kSteps; ++i)
        luminances.push_back(picture.darkest * std::pow(picture.brightest / picture.darkest, double(i) / kSteps));
    return luminances;
}

std::vector<double> curve_codes(const render::ToneMapped& shown, render::Operator op, const vision::Display& display,
                                const std::vector<double>& luminances) {
    const vision::DisplayCurve curve(display);
    const double reflected = double(display.low() - display.black);
    std::vector<double> codes;
    for (const double l : luminances)
        codes.push_back(
            code_of(curve, render::shown_luminance(op, shown.curve, l, display) - reflected, display.largest_code()));
    return codes;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

Difference difference(const render::ToneMapped& from, const render::ToneMapped& to, const vision::Display& display) {
    const std::vector<uint32_t> a = codes_of(from, display), b = codes_of(to, display);
    Difference made;
    made.map.reserve(a.size() / 3);
    double sum = 0;
    for (size_t i = 0; i < a.size(); i += 3) {
        uint32_t most = 0;
        for (size_t c = i; c < i + 3; ++c) most = std::max(most, a[c] > b[c] ? a[c] - b[c] : b[c] - a[c]);
        made.map.push_back(float(most));
        sum += most;
        made.largest = std::max(made.largest, double(most));
    }
    made.mean = sum / double(made.map.size());
    std::vector<float> sorted = made.map;
    const auto at = sorted.begin() + ptrdiff_t(0.99 * double(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    made.percentile = double(*at);
    return made;
}

std::string describe(const Difference& d) {
    return apps::format("curve %.2f, largest %.0f, 99 %% within %.0f, mean %.3f codes", d.curve, d.largest,
                        d.percentile, d.mean);
}

}  // namespace vesper::commands
