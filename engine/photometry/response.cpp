// Response curves: known ones, and their files. SPDX-License-Identifier: MIT
#include "photometry/response.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/atomic_file.h"

namespace vesper {
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

/// Takes one number, and what follows it up to and including `end`, from the text.
bool take(std::string_view& text, double& value, char end) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    const auto [rest, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || !std::isfinite(value)) return false;
    text.remove_prefix(static_cast<size_t>(rest - text.data()));
    while (!text.empty() && (text.front() == ' ' || text.front() == '\r')) text.remove_prefix(1);
    if (text.empty()) return end == '\n';
    if (text.front() != end) return false;
    text.remove_prefix(1);
    return true;
}

}  // namespace

Response gamma_response(double gamma) {
    return response_of([gamma](double code) { return std::pow(code, gamma); });
}

Response srgb_response() {
    return response_of([](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); });
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
        char line[120];
        std::snprintf(line, sizeof line, "%zu,%.9g,%.9g,%.9g\n", z, response.ln_exposure[0][z],
                      response.ln_exposure[1][z], response.ln_exposure[2][z]);
        text += line;
    }
    replace_file(file, std::vector<uint8_t>(text.begin(), text.end()));
}

Response read_response(const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = read_file(file, 1u << 20);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto fail = [&](const std::string& why) { throw Error(one_line(file.string()) + ": " + why); };
    if (!text.starts_with("code,")) fail("is not a response curve: its first line does not start with 'code,'");
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    Response response;
    for (size_t z = 0; z < 256; ++z) {
        double code = 0, g[3] = {};
        if (!take(text, code, ',') || !take(text, g[0], ',') || !take(text, g[1], ',') || !take(text, g[2], '\n') ||
            code != static_cast<double>(z))
            fail("line " + std::to_string(z + 2) + ": expected " + std::to_string(z) + " and three numbers");
        for (size_t c = 0; c < 3; ++c) {
            if (std::abs(g[c]) > 50)
                fail("line " + std::to_string(z + 2) + ": no exposure is that far from the middle");
            response.ln_exposure[c][z] = g[c];
        }
    }
    return response;
}

}  // namespace vesper
