#include "study_page.h"

#include <algorithm>

#include "plots/false_colour.h"

namespace vesper::commands {
namespace {

std::string escaped(const std::string& text) {
    std::string made;
    for (const char c : text)
        made += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
    return made;
}

/// A file name as a relative address.
std::string address(const std::string& name) {
    std::string made = "./";
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (byte >= '0' && byte <= '9') || (byte >= 'a' && byte <= 'z') ||
                           (byte >= 'A' && byte <= 'Z') || c == '-' || c == '_' || c == '.';
        constexpr char kHex[] = "0123456789ABCDEF";
        made += plain ? std::string(1, c) : std::string{'%', kHex[byte >> 4], kHex[byte & 15]};
    }
    return made;
}

}  // namespace

StudyPage::StudyPage(const std::string& title)
    : text_("<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + escaped(title) +
            "</title><style>body{font:15px sans-serif;max-width:1200px;margin:24px auto;padding:0 "
            "12px}table{border-collapse:collapse}"
            "td,th{border:1px solid #ccc;padding:3px "
            "9px;text-align:right}figure{display:inline-block;width:370px;margin:6px}"
            "figure img{width:100%}figcaption{font-size:13px}.plot{max-width:100%}</style></head><body>\n<h1>" +
            escaped(title) + "</h1>\n") {}

void StudyPage::heading(const std::string& text) { text_ += "<h2>" + escaped(text) + "</h2>\n"; }
void StudyPage::paragraph(const std::string& text) { text_ += "<p>" + escaped(text) + "</p>\n"; }
void StudyPage::plot(const std::string& file) {
    text_ += "<p><img class=\"plot\" alt=\"plot\" src=\"" + address(file) + "\"></p>\n";
}

void StudyPage::table(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& rows) {
    const auto row = [&](const std::vector<std::string>& cells, const std::string& tag) {
        text_ += "<tr>";
        for (const std::string& cell : cells) text_ += "<" + tag + ">" + escaped(cell) + "</" + tag + ">";
        text_ += "</tr>\n";
    };
    text_ += "<table>\n";
    row(columns, "th");
    for (const auto& cells : rows) row(cells, "td");
    text_ += "</table>\n";
}

void StudyPage::pictures(const std::vector<Figure>& shown) {
    for (const Figure& picture : shown)
        text_ += "<figure><a href=\"" + address(picture.file) + "\"><img alt=\"" + escaped(picture.caption) +
                 "\" src=\"" + address(picture.file) + "\"></a><figcaption>" + escaped(picture.caption) +
                 "</figcaption></figure>\n";
}

std::string csv_of(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& rows) {
    std::string text;
    const auto line = [&](const std::vector<std::string>& cells) {
        for (size_t i = 0; i < cells.size(); ++i) {
            std::string cell = cells[i];
            if (cell.find_first_of(",\"") != std::string::npos) {
                for (size_t at = 0; (at = cell.find('"', at)) != std::string::npos; at += 2) cell.insert(at, 1, '"');
                cell = '"' + cell + '"';
            }
            text += (i ? "," : "") + cell;
        }
        text += "\n";
    };
    line(columns);
    for (const auto& cells : rows) line(cells);
    return text;
}

void save_difference(const std::string& file, uint32_t full_width, uint32_t full_height, std::span<const float> codes) {
    constexpr uint32_t kWidest = 840, kHighest = 1000;
    const double factor = std::min({1.0, double(kWidest) / full_width, double(kHighest) / full_height});
    const uint32_t width = std::max(1u, uint32_t(full_width * factor)),
                   height = std::max(1u, uint32_t(full_height * factor));
    const double largest = double(*std::max_element(codes.begin(), codes.end()));
    const apps::ColourScale scale{0.5, std::max(20.0, largest)};
    const apps::ValuePicture seen =
        apps::resized({full_width, full_height, {codes.begin(), codes.end()}}, width, height);
    apps::Canvas canvas(width + uint32_t(apps::kBarWidth) + 20, std::max(height, 150u));
    canvas.pixels(0, 0, width, height, apps::false_colours(seen, scale));
    apps::draw_colour_bar(canvas, {double(width) + 12, 26}, double(canvas.height()) - 36, scale, "codes");
    canvas.save(file);
}

}  // namespace vesper::commands
