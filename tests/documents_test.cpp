// The documents: links lead somewhere, pages are short and found in an index, lines fit. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "places.h"

namespace {

namespace fs = std::filesystem;
const fs::path kRepository = VESPER_SOURCE_DIR;
constexpr size_t kMaxWords = 1500, kMaxColumns = 120;
const std::regex kLink(R"(\]\(([^)\s]+)\))");

std::string document_text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// The documents of the project, relative to the source folder.
std::vector<fs::path> documents() {
    std::vector<fs::path> found{"README.md", "CONTRIBUTING.md", "CHANGELOG.md"};
    for (const auto& entry : fs::recursive_directory_iterator(kRepository / "docs"))
        if (entry.path().extension() == ".md") found.push_back(fs::relative(entry.path(), kRepository));
    std::sort(found.begin(), found.end());
    return found;
}

/// The targets of all links but those to other sites.
std::vector<std::string> links_of(const std::string& text) {
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), kLink), end; it != end; ++it)
        if (!(*it)[1].str().starts_with("http")) found.push_back((*it)[1]);
    return found;
}

/// Anchors of the headings of a document, as GitHub makes them.
std::set<std::string> anchors_of(const std::string& text) {
    std::set<std::string> found;
    for (const std::string& line : lines_of(text)) {
        if (!line.starts_with("#")) continue;
        std::string anchor;
        for (const char c : line.substr(std::min(line.size(), line.find_first_not_of("# ")))) {
            const auto byte = static_cast<unsigned char>(c);
            if (c == ' ')
                anchor += '-';
            else if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 0x80)
                anchor += char(std::tolower(byte));
        }
        found.insert(anchor);
    }
    return found;
}

/// The reason why a link of a document is broken; empty if it is not.
std::string objection_to_link(const fs::path& document, const std::string& link) {
    const size_t hash = link.find('#');
    const std::string path = link.substr(0, hash);
    const fs::path target = path.empty() ? kRepository / document : kRepository / document.parent_path() / path;
    if (!fs::exists(target)) return "no such file";
    if (hash == link.npos) return {};
    return anchors_of(document_text(target)).contains(link.substr(hash + 1)) ? "" : "no such heading";
}

/// Characters of a line, of UTF-8.
size_t columns(const std::string& line) {
    return size_t(
        std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Lines that are too long, counted from 1. Rows of tables cannot be wrapped and are left out.
std::vector<size_t> long_lines(const std::string& text) {
    std::vector<size_t> found;
    const auto lines = lines_of(text);
    for (size_t i = 0; i < lines.size(); ++i)
        if (!lines[i].starts_with("|") && columns(lines[i]) > kMaxColumns) found.push_back(i + 1);
    return found;
}

size_t words_of(const std::string& text) {
    std::istringstream stream(text);
    return size_t(std::distance(std::istream_iterator<std::string>(stream), {}));
}

TEST(Documents, LinksLeadToFilesAndHeadings) {
    size_t links = 0;
    for (const fs::path& document : documents()) {
        for (const std::string& link : links_of(document_text(kRepository / document))) {
            EXPECT_EQ(objection_to_link(document, link), "") << document << " links to " << link;
            ++links;
        }
    }
    EXPECT_GT(links, 100u);
}

TEST(Documents, ABrokenLinkIsSeen) {
    EXPECT_EQ(links_of("See [a](b.md#c) and [d](https://e.org)."), std::vector<std::string>{"b.md#c"});
    EXPECT_EQ(objection_to_link("docs/tone.md", "gamut.md"), "");
    EXPECT_EQ(objection_to_link("docs/tone.md", "gamut.md#glow-that-goes-to-white"), "");
    EXPECT_EQ(objection_to_link("docs/tone.md", "#the-eye"), "");
    EXPECT_NE(objection_to_link("docs/tone.md", "no-such-page.md"), "");
    EXPECT_NE(objection_to_link("docs/tone.md", "gamut.md#no-such-heading"), "");
}

TEST(Documents, PagesAreShort) {
    for (const fs::path& document : documents())
        EXPECT_LE(words_of(document_text(kRepository / document)), kMaxWords) << document;
    EXPECT_EQ(words_of("one two\nthree"), 3u);
}

TEST(Documents, LinesFit) {
    for (const fs::path& document : documents())
        EXPECT_EQ(long_lines(document_text(kRepository / document)), std::vector<size_t>{}) << document;
    EXPECT_EQ(long_lines("short\n" + std::string(121, 'x') + "\n|" + std::string(200, 'x')), std::vector<size_t>{2});
    std::string accents;
    for (size_t i = 0; i < kMaxColumns; ++i) accents += "é";
    EXPECT_TRUE(long_lines(accents).empty());
}

TEST(Documents, EveryPageIsInAnIndex) {
    for (const fs::path& document : documents()) {
        const fs::path folder = document.parent_path();
        if (folder.empty() || document.filename() == "README.md") continue;
        const auto indexed = links_of(document_text(kRepository / folder / "README.md"));
        EXPECT_NE(std::find(indexed.begin(), indexed.end(), document.filename().string()), indexed.end()) << document;
    }
}

}  // namespace
