// Shares and probabilities by pixel, as colours over the picture that they are of. SPDX-License-Identifier: MIT
#pragma once

#include "plots/false_colour.h"

namespace vesper::apps {

/// Canvas with the picture in dim greys (by the logarithm of its luminance), its shares from 0 to 1 in colours over it,
/// and a bar of them with `unit` above; `title` stands above all. Large pictures are shown smaller, by means. Both are
/// of one size.
class ShareMap {
public:
    ShareMap(const std::string& title, const ValuePicture& luminance, const ValuePicture& shares,
             const std::string& unit);

    Canvas& canvas() { return canvas_; }
    /// Where a pixel of the picture lies on the canvas.
    glm::dvec2 at(double x, double y) const { return corner_ + zoom_ * (glm::dvec2(x, y) + 0.5); }

private:
    glm::dvec2 corner_, zoom_;
    Canvas canvas_;
};

}  // namespace vesper::apps
