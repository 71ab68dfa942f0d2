// SPDX-License-Identifier: MIT
#include "scene/display_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "scene/json_value.h"

namespace vesper::scene {
namespace {

constexpr uint64_t kMaxProfileBytes = 1u << 20;

vision::Eotf read_eotf(const JsonValue& value) {
    for (const auto& [name, eotf] : vision::kEotfNames)
        if (value.text() == name) return eotf;
    value.fail("is none of gamma, srgb, pq and table");
}

glm::dvec2 read_xy(const JsonValue& value) {
    const auto xy = value.elements(2);
    const glm::dvec2 read(xy[0].number(0, 1), xy[1].number(0, 1));
    if (!(read.y > 0)) xy[1].fail("must be more than 0");
    return read;
}

io::Primaries read_primaries(const JsonValue& value) {
    io::Primaries read = io::kRec709;
    if (value.json().is_string()) {
        for (const auto& [name, primaries] : io::kPrimariesNames)
            if (value.text() == name) return primaries;
        value.fail("is none of rec709, p3 and rec2020");
    }
    value.allow_only({"red", "green", "blue", "white"});
    read = {read_xy(value.at("red")), read_xy(value.at("green")), read_xy(value.at("blue")),
            read_xy(value.at("white"))};
    try {
        io::to_rec709(read);
    } catch (const Error& error) {
        value.fail(error.what());
    }
    if (!io::make_white(read)) value.at("white").fail("lies outside the triangle of red, green and blue");
    return read;
}

void read_table(vision::Display& display, const JsonValue& value) {
    const double largest = display.largest_code();
    const auto rows = value.elements();
    if (rows.size() < 2 || rows.size() > 4096) value.fail("must have 2 to 4096 measurements");
    for (size_t i = 0; i < rows.size(); ++i) {
        const auto pair = rows[i].elements(2);
        if (const double code = pair[0].number(0, largest); code != std::floor(code))
            pair[0].fail("must be a whole number, as codes are");
        const vision::DisplaySample sample{pair[0].number(0, largest) / largest, pair[1].number(0, 1e5)};
        if (i == 0 && sample.code != 0) pair[0].fail("must be 0, the first code");
        if (i > 0 && !(sample.code > display.table.back().code)) pair[0].fail("must be more than the code before");
        if (i > 0 && !(sample.luminance > display.table.back().luminance))
            pair[1].fail("must be more than the luminance before");
        display.table.push_back(sample);
    }
    if (display.table.back().code != 1)
        rows.back().fail("must be of the largest code, " + std::to_string(display.largest_code()));
    double& black = display.table.front().luminance;
    if (black < vision::kLeastBlack && display.table[1].luminance > vision::kLeastBlack) black = vision::kLeastBlack;
    display.black = float(black);
    display.peak = float(display.table.back().luminance);
}

}  // namespace

vision::Display read_display(const std::filesystem::path& file) {
    const JsonFile json = parse_json(io::read_file(file, kMaxProfileBytes), file.string());
    const JsonValue root(json);
    root.allow_only({"$schema", "version", "name", "peak_cd_m2", "black_cd_m2", "eotf", "gamma", "table", "bits",
                     "primaries", "ambient_lx", "reflection"});
    const JsonValue version = root.at("version");
    if (version.integer() != 1) version.fail("must be 1: this program knows no other");
    vision::Display display;
    display.bits = uint32_t(root.integer_or("bits", 8, 10));
    if (display.bits != 8 && display.bits != 10) root.at("bits").fail("must be 8 or 10");
    display.eotf = read_eotf(root.at("eotf"));
    const auto refuse = [&](const char* key, const char* reason) {
        if (const auto value = root.find(key)) value->fail(reason);
    };
    if (display.eotf == vision::Eotf::Gamma)
        display.gamma = float(root.at("gamma").number(0.5, 5));
    else
        refuse("gamma", "has a meaning only with the eotf gamma");
    if (display.eotf == vision::Eotf::Table) {
        for (const char* key : {"peak_cd_m2", "black_cd_m2"}) refuse(key, "is told by the table");
        read_table(display, root.at("table"));
    } else {
        refuse("table", "has a meaning only with the eotf table");
        display.peak = float(root.at("peak_cd_m2").number(0.1, 1e5));
        display.black = std::max(float(root.at("black_cd_m2").number(0, 1e3)), float(vision::kLeastBlack));
    }
    display.ambient = float(root.number_or("ambient_lx", 0, 0, 1e5));
    display.reflection = float(root.number_or("reflection", 0.01, 0, 1));
    if (const auto primaries = root.find("primaries")) display.primaries = read_primaries(*primaries);
    try {
        vision::check_display(display);
    } catch (const Error& error) {
        root.fail(error.what());
    }
    return display;
}

vision::Display find_display(const std::string& name_or_file) {
    for (const vision::NamedDisplay& known : vision::known_displays())
        if (name_or_file == known.name) return known.display;
    if (name_or_file.ends_with(".json")) return read_display(name_or_file);
    throw Error("display '" + one_line(name_or_file, 100) + "': is none of " + vision::known_display_names() +
                ", nor a .json file");
}

const vision::Display& DisplayFinder::find(const std::string& name_or_file) {
    std::error_code no_file;  // as with a name; a file that is gone differs from what it was
    const auto time = std::filesystem::last_write_time(name_or_file, no_file);
    const std::uintmax_t bytes = std::filesystem::file_size(name_or_file, no_file);
    if (!display_ || name_or_file != name_ || time != time_ || bytes != bytes_) {
        display_.reset();
        display_ = find_display(name_or_file);
        name_ = name_or_file, time_ = time, bytes_ = bytes;
    }
    return *display_;
}

std::string display_json(const vision::Display& display, const std::string& name) {
    nlohmann::ordered_json made;
    // A float as the shortest decimal that is the same float.
    const auto number = [](float value) {
        char text[32];
        const auto [end, error] = std::to_chars(text, text + sizeof text, value);
        return nlohmann::ordered_json::parse(text, end);
    };
    const auto xy = [](glm::dvec2 c) { return nlohmann::ordered_json{c.x, c.y}; };
    made["version"] = 1;
    if (!name.empty()) made["name"] = name;
    for (const auto& [text, eotf] : vision::kEotfNames)
        if (eotf == display.eotf) made["eotf"] = text;
    if (display.eotf == vision::Eotf::Gamma) made["gamma"] = number(display.gamma);
    if (display.eotf != vision::Eotf::Table) {
        made["peak_cd_m2"] = number(display.peak);
        made["black_cd_m2"] = number(display.black);
    }
    made["bits"] = display.bits;
    const io::Primaries& p = display.primaries;
    made["primaries"] = {{"red", xy(p.red)}, {"green", xy(p.green)}, {"blue", xy(p.blue)}, {"white", xy(p.white)}};
    for (const auto& [text, primaries] : io::kPrimariesNames)
        if (primaries == p) made["primaries"] = text;
    made["ambient_lx"] = number(display.ambient);
    made["reflection"] = number(display.reflection);
    std::string text = made.dump(2);
    if (display.eotf == vision::Eotf::Table) {  // a line for each measurement
        std::string rows;
        for (const vision::DisplaySample& sample : display.table) {
            const double code = sample.code * display.largest_code(), whole = std::round(code);
            nlohmann::json row{code, sample.luminance};
            if (std::abs(code - whole) < 1e-9) row[0] = uint32_t(whole);
            rows += (rows.empty() ? "\n    " : ",\n    ") + row.dump();
        }
        text.insert(text.size() - 2, ",\n  \"table\": [" + rows + "\n  ]");
    }
    return text + "\n";
}

}  // namespace vesper::scene
