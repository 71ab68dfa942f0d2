// The page that a study ends in. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vesper::commands {

/// An HTML page of text, tables and pictures that lie beside it.
class StudyPage {
public:
    explicit StudyPage(const std::string& title);

    void heading(const std::string& text);
    void paragraph(const std::string& text);
    void table(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& rows);
    void plot(const std::string& file);
    /// Pictures side by side, each with what is to be said of it.
    struct Figure {
        std::string file, caption;
    };
    void pictures(const std::vector<Figure>& shown);
    std::string html() const { return text_ + "</body></html>\n"; }

private:
    std::string text_;
};

/// A table as CSV: a line of column names, a line per row.
std::string csv_of(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& rows);

/// Writes differences in display codes as false colours, black where there is none, with a bar from 0.5 codes to at
/// least 20. Large pictures are shown smaller, by means. Throws Error.
void save_difference(const std::string& file, uint32_t width, uint32_t height, std::span<const float> codes);

}  // namespace vesper::commands
