// One picture of high dynamic range out of several exposures. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/exif.h"
#include "io/hdr_image.h"
#include "photometry/response.h"

namespace vesper::photometry {

constexpr size_t kMaxExposures = 32;
/// Range of good codes. Other codes count only if no exposure has a good one.
constexpr int kLowestGoodCode = 8, kHighestGoodCode = 247;

/// time * ISO speed / f-number^2 of each picture, by name. A value that no picture states counts as equal. Throws Error
/// if a picture has no time, or if only some state f-number or ISO speed.
std::vector<double> relative_exposures(std::span<const std::pair<std::string, io::CameraExposure>>);

struct MergedImage {
    io::HdrImage image;         ///< relative, white_luminance 0; camera RGB taken for Rec. 709
    std::vector<uint8_t> held;  ///< per pixel: 1 if each channel has a good code in some picture
    uint64_t too_dark = 0;      ///< pixels of which a channel is below the good codes in every picture that shows it,
    uint64_t too_bright = 0;    ///< above them,
    uint64_t between = 0;       ///< or both: it falls between two exposures
    double darkest = 0, brightest = 0;  ///< luminance of the other pixels, in the picture's unit
};

/// ln E = sum p(Z) (g(Z) - ln t) / sum p(Z) over the good codes, per channel (eq. 6 with the precisions of codes). A
/// pixel without a good code gets the value of the closest picture: of black ones the longest exposure, of white ones
/// the shortest. Throws Error unless there are 1 to kMaxExposures pictures of equal size with exposures > 0.
MergedImage merge_exposures(std::span<const Exposure>, const Response&);

/// Sets the shifts, relative to the picture of middle exposure, from median threshold bitmaps of neighbours in exposure
/// (G. Ward, "Fast, Robust Image Registration for Compositing High Dynamic Range Photographs from Handheld Exposures",
/// Journal of Graphics Tools 8(2), 2003). Whole pixels; at least 2^(levels + 1) each way between neighbours
/// where a picture is that large.
void estimate_shifts(std::span<Exposure>, int levels = 6);

struct Region {
    int64_t x = 0, y = 0, width = 1, height = 1;  ///< px
};

/// Multiplies the picture so that the mean luminance of a region is `cd_m2`; returns the factor. From then on the
/// picture is in cd/m^2. Throws Error if the region is not inside or has a pixel that no exposure holds well.
double scale_to_luminance(MergedImage&, const Region&, double cd_m2);
/// The same with a known factor.
void scale(MergedImage&, double factor);

}  // namespace vesper::photometry
