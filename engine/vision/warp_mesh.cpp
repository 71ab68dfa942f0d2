// SPDX-License-Identifier: MIT
#include "vision/warp_mesh.h"

#include <array>
#include <cmath>

#include "base/budget.h"
#include "base/decimal.h"
#include "io/read_file.h"
#include "photometry/table.h"

namespace vesper::vision {
namespace {

using photometry::LineReader;

constexpr double kRectangular = 2;  // of the format's types

/// The numbers of the next line that is not empty; `what` they are is said where they are not there.
template <size_t count>
std::array<double, count> numbers_of(LineReader& lines, const std::string& what) {
    std::optional<std::string_view> next;
    do next = lines.next();
    while (next && photometry::trimmed(*next).empty());
    if (!next) lines.fail("the file ends where " + what + " stands");
    std::string_view rest = photometry::trimmed(*next);
    std::array<double, count> values{};
    for (size_t i = 0; i < count; ++i) {
        const std::string_view field = rest.substr(0, rest.find_first_of(" \t"));
        const auto value = photometry::number_of(field, false);
        if (!value)
            lines.fail(field.empty() ? what + " has " + std::to_string(count) + " numbers, not " + std::to_string(i)
                                     : photometry::quoted(field) + " is no number; " + what + " is expected");
        values[i] = *value;
        rest = photometry::trimmed(rest.substr(field.size()));
    }
    if (!rest.empty()) lines.fail(what + " has no more than " + std::to_string(count) + " numbers");
    return values;
}

uint32_t count_of(double value, const LineReader& lines, const char* what) {
    if (!(value >= kLeastWarpNodes && value <= kMostWarpNodes && value == std::floor(value)))
        lines.fail(std::string("a mesh has ") + std::to_string(kLeastWarpNodes) + " to " +
                   std::to_string(kMostWarpNodes) + " " + what + ", not " + decimal(value, 7));
    return uint32_t(value);
}

WarpNode node_of(const std::array<double, 5>& numbers, const LineReader& lines) {
    const auto& [x, y, u, v, intensity] = numbers;
    const auto check = [&](const char* what, double value, double low, double high) {
        if (!(value >= low && value <= high))
            lines.fail(std::string(what) + " is " + decimal(value, 7) + ", not " + decimal(low) + " to " +
                       decimal(high));
    };
    const bool drawn = intensity >= 0;
    check("x", x, -kFarthestWarpNode, kFarthestWarpNode);
    check("y", y, -kFarthestWarpNode, kFarthestWarpNode);
    check("u", u, drawn ? 0 : -kFarthestWarpNode, drawn ? 1 : kFarthestWarpNode);
    check("v", v, drawn ? 0 : -kFarthestWarpNode, drawn ? 1 : kFarthestWarpNode);
    if (drawn) check("the intensity", intensity, 0, 1);
    return {x, y, u, v, intensity};
}

}  // namespace

WarpMesh parse_warp_mesh(std::span<const uint8_t> text, const std::string& name) {
    LineReader lines(text, name);
    const double type = numbers_of<1>(lines, "the type of the mesh")[0];
    if (type != kRectangular) lines.fail("meshes of type " + decimal(type, 7) + " are not read: only 2, rectangular");
    const auto [columns, rows] = numbers_of<2>(lines, "the size of the mesh");
    WarpMesh mesh{name, count_of(columns, lines, "columns"), count_of(rows, lines, "rows"), {}};
    const size_t count = size_t{mesh.columns} * mesh.rows;
    const std::string of_all = " of " + std::to_string(count);
    while (mesh.nodes.size() < count) {
        check_time();
        const std::string what = "node " + std::to_string(mesh.nodes.size() + 1) + of_all;
        mesh.nodes.push_back(node_of(numbers_of<5>(lines, what), lines));
    }
    while (const auto next = lines.next())
        if (!photometry::trimmed(*next).empty()) lines.fail("the mesh ends before this line");
    return mesh;
}

WarpMesh read_warp_mesh(const std::filesystem::path& file) {
    return parse_warp_mesh(io::read_file(file, kMaxWarpMeshBytes), file.string());
}

}  // namespace vesper::vision
