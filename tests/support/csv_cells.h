// Lines of CSV files without quotes. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace vesper::test {

/// The cells between the commas of a line; one where there is none.
inline std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line)
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    return cells;
}

}  // namespace vesper::test
