// Response curves: known ones, and their files. SPDX-License-Identifier: MIT
#include "photometry/response.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/decimal.h"
#include "base/error.h"
#include "base/one_line.h"
#include "base/srgb.h"
#include "io/new_file.h"
#include "io/read_file.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

/// All channels alike, from the relative exposure of a code in (0, 1].
template <typename Exposure>
Response response_of(const Exposure& exposure) {
    Response made;
    const double middle = std::log(exposure(128 / 255.0));
    for (size_t z = 0; z < 256; ++z)
        for (auto& channel : made.ln_exposure)
            channel[z] = std::log(exposure(z == 0 ? 0.5 / 255 : static_cast<double>(z) / 255)) - middle;
    return made;
}

/// The columns of R, G and B, by their headings: "ln_exposure_r", "g(R)" or "red".
std::array<size_t, 3> channels_of(std::string_view header, const LineReader& lines) {
    constexpr std::array<std::array<std::string_view, 2>, 3> kChannels{{{"r", "red"}, {"g", "green"}, {"b", "blue"}}};
    using Words = std::vector<std::string>;
    const auto fields = fields_of(header, ',', 4);
    std::array<size_t, 3> columns{};
    for (size_t i = 1; i < fields.size(); ++i) {
        Words words = words_of(fields[i]);
        if (words.empty()) continue;
        const std::string name = words.back();
        words.pop_back();
        if (!words.empty() && words != Words{"ln", "exposure"} && words != Words{"g"}) continue;
        for (size_t c = 0; c < 3; ++c)
            if (name == kChannels[c][0] || name == kChannels[c][1]) columns[c] = i;
    }
    if (fields.size() != 4 || columns[0] * columns[1] * columns[2] != 6)
        lines.fail("the headings are not code and ln_exposure_r, ln_exposure_g and ln_exposure_b");
    return columns;
}

}  // namespace

Response gamma_response(double gamma) {
    return response_of([gamma](double code) { return std::pow(code, gamma); });
}

Response srgb_response() { return response_of(srgb_to_linear); }

std::array<double, 256> code_precisions(const std::array<double, 256>& g) {
    constexpr int kHalf = 4, kEnd = 32;  // codes: the slope is taken over 2 kHalf
    const auto slope = [&](int z) {
        const int low = std::max(z - kHalf, 1), high = std::min(z + kHalf, 254);
        return (g[size_t(high)] - g[size_t(low)]) / (high - low);
    };
    // Where a curve that was recovered is flatter than in its middle, that is for want of data, not precision.
    std::array<double, 128> middle{};
    for (int i = 0; i < 128; ++i) middle[size_t(i)] = slope(64 + i);
    std::nth_element(middle.begin(), middle.begin() + 64, middle.end());
    const double least = std::max(0.5 * middle[64], 1e-3);
    std::array<double, 256> made{};
    for (int z = 1; z < 255; ++z) {
        const double s = std::max(slope(z), least);
        made[size_t(z)] = std::min(1.0, double(std::min(z, 255 - z)) / kEnd) / (s * s);
    }
    return made;
}

std::array<int, 3> count_falls(const Response& response) {
    std::array<int, 3> falls{};
    for (size_t c = 0; c < 3; ++c)
        for (size_t z = 2; z < 255; ++z) falls[c] += response.ln_exposure[c][z] < response.ln_exposure[c][z - 1];
    return falls;
}

void write_response(const std::filesystem::path& file, const Response& response) {
    std::string text = "code,ln_exposure_r,ln_exposure_g,ln_exposure_b\n";
    for (size_t z = 0; z < 256; ++z) {
        text += std::to_string(z);
        for (const auto& channel : response.ln_exposure) text += "," + decimal(channel[z], 9);
        text += "\n";
    }
    io::replace_file(file, std::vector<uint8_t>(text.begin(), text.end()));
}

Response read_response(const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = io::read_file(file, 1u << 20);
    LineReader lines(bytes, file.string());
    const auto header = lines.next();
    if (!header || !header->starts_with("code,"))
        throw Error(one_line(file.string()) + ": is not a response curve: its first line does not start with 'code,'");
    const std::array<size_t, 3> columns = channels_of(*header, lines);
    Response response;
    for (size_t z = 0; z < 256; ++z) {
        const auto fields = fields_of(lines.next().value_or(""), ',', 4);
        std::optional<double> value[4];
        for (size_t i = 0; i < 4 && fields.size() == 4; ++i)
            value[i] = number_of(fields[i > 0 ? columns[i - 1] : 0], false);
        if (!value[0] || !value[1] || !value[2] || !value[3] || *value[0] != static_cast<double>(z))
            lines.fail("expected " + std::to_string(z) + " and three numbers");
        for (size_t c = 0; c < 3; ++c) {
            if (std::abs(*value[c + 1]) > 50) lines.fail("no exposure is that far from the middle");
            response.ln_exposure[c][z] = *value[c + 1];
        }
    }
    while (const auto more = lines.next())
        if (!trimmed(*more).empty()) lines.fail("nothing is expected after code 255");
    return response;
}

}  // namespace vesper::photometry
