// Which reader a file is for. SPDX-License-Identifier: MIT
#include "base/lower.h"
#include "io/read_file.h"
#include "photometry/distribution.h"
#include "photometry/eulumdat.h"
#include "photometry/grid.h"
#include "photometry/ies.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

/// A format by what a file begins with, as its usual extension.
std::string format_of(std::span<const uint8_t> bytes) {
    LineReader lines(bytes, "");
    const std::string_view start = lines.rest().substr(0, 1u << 16);
    if (start.starts_with("\x76\x2f\x31\x01")) return ".exr";
    if (start.starts_with("IES") || start.find("\nTILT=") != start.npos || start.find("\rTILT=") != start.npos)
        return ".ies";
    lines.next();
    for (int i = 0; i < 5; ++i) {  // EULUMDAT: type, symmetry, planes, spacing, angles
        const auto line = lines.next();
        if (!line || !number_of(*line)) return ".csv";
    }
    return ".ldt";
}

}  // namespace

Distribution read_distribution(const std::filesystem::path& file) {
    std::string format = lower(file.extension().string());
    if (format != ".ies" && format != ".ldt" && format != ".csv" && format != ".exr")
        format = format_of(io::read_file(file, kMaxTableBytes));
    if (format == ".ies") return read_ies(file);
    if (format == ".csv") return read_grid_csv(file);
    if (format == ".exr") return read_grid_exr(file);
    return read_eulumdat(file);
}

}  // namespace vesper::photometry
