// Diagrams of lines. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::apps {

struct PlotLine {
    std::string name;
    std::vector<glm::dvec2> points;
    bool dashed = false, marks = false;
    std::optional<size_t> colour = {};  ///< number in the palette; default: that among the lines
};

struct LinePlot {
    std::string title, x_name, y_name;
    std::vector<PlotLine> lines;
    bool log_x = false, log_y = false;  ///< values that are not positive are left out of logarithmic axes
    double rule = 0;                    ///< a horizontal line of note; 0: none
};

/// Draws axes that hold every line, a legend on the right, and the lines; writes a PNG of 1100 x 560 px. Throws Error.
void save_plot(const std::string& file, const LinePlot& plot);

}  // namespace vesper::apps
