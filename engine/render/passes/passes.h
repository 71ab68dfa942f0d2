// Every pass of the frame: its inputs, its output, its settings. SPDX-License-Identifier: MIT
// Pixels count from the top left. RGB is linear Rec. 709; luminance is 0.212639 R + 0.715169 G + 0.072192 B.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "graph/frame_graph.h"
#include "render/passes/operators.h"
#include "vision/display.h"
#include "vision/eye.h"
#include "vision/light_elsewhere.h"
#include "gpu_scene/eye_scatter.h"
#include "gpu_scene/formats.h"
#include "gpu_scene/kernels.h"
#include "gpu_scene/lamps.h"
#include "gpu_scene/luminaires.h"
#include "gpu_scene/view.h"
#include "shared/cluster.h"
#include "shared/composite.h"
#include "shared/gamut.h"
#include "shared/lamp.h"
#include "shared/shade.h"
#include "shared/luminaire.h"
#include "shared/tone.h"

namespace vesper {

/// Surfaces seen by each pixel.
struct GBuffer {
    Resource reflectance;  ///< rgba16f: base colour [0, 1]; metallic [0, 1] or another kind of surface, see shared/shade.h
    Resource surface;      ///< rgba32f: view-frame normal, octahedral (2), depth along the view axis (m; 0: nothing), roughness
    Resource emission;     ///< rgba32f: emitted RGB luminance, cd/m^2
    Resource depth;        ///< d32: near / depth, 0 at infinity
};

/// Rasterizes what of the scene the view may see, at the poses of `frame`. Textures are filtered as linear reflectance.
GBuffer add_gbuffer(FrameGraph&, const GpuScene&, const SceneFrame&, const View&);

struct ClusterSettings {
    float threshold = 0.001f;      ///< lx: a lamp counts where it gives at least this, on matt surfaces, or on a plane facing it, elsewhere
    uint32_t slices = 32;
    uint32_t capacity = 512;       ///< lamps a froxel lists before it falls back to all lamps
    float far = 0;                 ///< m, where geometry ends; 0: unknown, lamps alone decide
};

/// The texels of IntensityTables (rgba32f), and which of them is the first cell of the first road table.
struct TableTexels {
    Resource texels;
    uint32_t roads = 0;
    bool has_roads = false;
};

struct Clusters {
    TableTexels tables;
    Resource lamps;   ///< rgba32f texels, kTexelsPerLamp per light
    Resource counts;   ///< r32ui, two per froxel: cones, then cosine powers and maps; kAllLamps if they did not fit
    Resource indices;  ///< r32ui, grid.capacity per froxel: indices of cones, then of the others, each ascending
    Resource report;   ///< shared::ClusterReport
    Resource block_slices;     ///< r32ui, for every block of shared::kBlockSize pixels the slices that something is drawn in, a bit for each
    shared::ClusterPush push;  ///< grid, counts, threshold and far
};

/// Lists for every froxel in which something is drawn (`surface`: GBuffer::surface) all lamps that may give `threshold` lx somewhere in it. Exact
/// or more, never less. Slices are of equal ratio from the nearest metre to the farthest depth any lamp reaches with `threshold`
/// (d = sqrt(I / threshold)), or to `far` if that is nearer.
Clusters add_clusters(FrameGraph&, const Kernels&, Resource surface, const LampList&, const TableTexels&, const View&, const ClusterSettings&);

struct ShadeSettings {
    float lambert = 1 / std::numbers::pi_v<float>;  ///< sr^-1: L = E reflectance / pi; 1: the paper's L = E R
    float emission_limit = std::numeric_limits<float>::infinity();  ///< cd/m^2
    glm::vec3 ambient{0};             ///< illuminance, RGB of luminance lx
    glm::vec3 sky{0};                 ///< cd/m^2 RGB
    bool all_lamps = false;          ///< look at every light in every pixel, for comparison
    float gather_tolerance = 1e-3f;   ///< as in add_blocks
    Resource retro{};                 ///< rgba32f texels of shared/retro.h; without: no surface is retroreflective
};

/// The image in blocks of shared::kBlockSize pixels, by what is in them (shared/gather.h).
struct Blocks {
    uint32_t columns = 0, count = 0;
    uint32_t capacity = 0;           ///< of a block's list
    Resource counts, entries;        ///< lists of the lamps that its pixels look at one by one (shared/shade.h)
    Resource sums;                   ///< of the others
    Resource class_counts, class_blocks;
};

/// Selects the lamps that can light what is drawn in each block. Where that is one matt plane or one plane of road, adds up those whose
/// light is smooth over it: a polynomial of second degree along either side meets it with at most this relative error at four pixels between its
/// nodes, which is 1.2 times that at any other where light is smooth and up to 3.5 times where it has a kink (edges of a beam's ramp, cells of a
/// map; more, in hardly a pixel, under maps with single bright nodes). A negative tolerance adds up nothing. Throws Error for an image of more
/// blocks than the device can shade in one dispatch.
Blocks add_blocks(FrameGraph&, const Kernels&, const GBuffer&, const Clusters&, const View&, float tolerance);

/// Bits of Kernels::ShadeVariant for the lamps and roads there are.
uint32_t frame_variant(const Clusters&);

/// Turns the emission of a G-buffer, in place, into scene luminance, rgba32f, cd/m^2 RGB (alpha 1):
/// L = sum_k E_k (rho lambert + specular) + ambient rho lambert + emission, E_k = I_k(direction) cos / d^2, counted where
/// E_k (on surfaces of roughness 1) or I_k / d^2 (on others) >= threshold. A road with a table reflects after CIE 144 (see
/// shared/shade.h); it is no specular surface of ours. rho = base colour (1 - metallic). Specular: GGX (Walter et al. 2007, a = roughness^2) with
/// height-correlated Smith masking (Heitz 2014) and Schlick's Fresnel; F0 is the base colour of a metal and
/// 0.04 (1 - a^2) of a dielectric, so that roughness 1 is Lambert. Retroreflective surfaces (photometry/retroreflection.h)
/// add R_A I / d^2 / cos(view) times their base colour for every lamp in front of them.
Resource add_shading(FrameGraph&, const Kernels&, const GBuffer&, const Clusters&, const View&, const ShadeSettings&);

/// Adds a sky that is a picture to shaded luminance, in place: the sky itself where nothing is drawn, E(normal) rho lambert
/// and specular reflection elsewhere. `sky` holds rgba32f texels as shared/sky.h says, with a sharp map of `sharp_side`.
Resource add_sky(FrameGraph&, const Kernels&, const GBuffer&, Resource scene, Resource sky, uint32_t sharp_side, const View&,
                 float lambert);

/// Adds light from everywhere, `illuminance` (RGB lx) on any surface in the open, to shaded luminance, in place: E rho lambert. What
/// lies in a tunnel gets what of it comes through the tunnel's ends, without what its walls send on. For days: ShadeSettings::ambient,
/// which is the same light without tunnels, is then none.
Resource add_daylight(FrameGraph&, const Kernels&, const GBuffer&, Resource scene, const std::vector<Tunnel>&, const View&,
                      glm::vec3 illuminance, float lambert);

/// Adds to the scene image, in place, the lamps of `list` seen directly: their luminance times the part of each pixel that
/// their outline covers, exactly, where no `surface` (GBuffer::surface) lies before them. However small a lamp is, the sum
/// over the image of luminance times solid angle is I / d^2. Without anything to see there is no pass.
Resource add_luminaires(FrameGraph&, const Kernels&, Resource scene, Resource surface, const LuminaireList& list, const View&);

/// An external picture as scene luminance: its RGB times `scale`, rgba32f, cd/m^2 (alpha 1).
Resource add_picture(FrameGraph&, const Kernels&, Resource picture, VkExtent2D extent, float scale);

/// Luminance at halving resolutions, see shared::PyramidPush. Level 0 is the scene image itself and is not stored.
struct Pyramid {
    std::vector<Resource> levels;     ///< levels[k - 1] is level k, rgba32f, up to 1x1 (one level for a 1x1 image)
    std::vector<VkExtent2D> extents;
};
/// `log_epsilon`: 0 for mean logarithms of luminance not below shared::kLuminanceFloor; otherwise cd/m^2 added to luminance.
Pyramid add_pyramid(FrameGraph&, const Kernels&, Resource scene, VkExtent2D extent, float log_epsilon = 0);

/// The pyramid level whose texels are nearest to one degree: round(log2(1 / degrees per pixel)), within the pyramid.
uint32_t foveal_level(const View&, const Pyramid&);

/// The scene as an eye adapted to each degree of it resolves it (Ward Larson et al. 1997): luminance blurred over sqrt(2) of the smallest
/// period that is seen, up to 32 px. rgba32f, cd/m^2.
Resource add_acuity(FrameGraph&, const Kernels&, Resource scene, const Pyramid&, uint32_t foveal_level, const View&);

/// Mean colours of squares of shared::kColourTile px, rgba32f: RGB, cd/m^2, and how many pixels are finite.
struct Colours {
    Resource tiles;
    VkExtent2D extent{};
};
Colours add_colours(FrameGraph&, const Kernels&, Resource scene, VkExtent2D extent);

struct HistogramSettings {
    uint32_t bins = 100;         ///< 1 .. 256
    float log10_low = -4;        ///< log10 of the lowest luminance, cd/m^2
    float log10_high = 6;        ///< and of the highest
    bool split = true;           ///< a vote is shared by the two nearest bins, so that none jumps from one to the next
    bool fine = true;            ///< half of all votes are those of level 1, so that small lamps have bins of their own
    bool overlap = true;         ///< beside fine votes: those of the level itself are of texels that overlap, so that it does not matter where their grid lies
    float spread = 0.1f;         ///< split votes: standard deviation of what the curve sees of a vote, log10, however many bins there are

    /// Of the curve: whole ones per bin, up to kMaxBins.
    uint32_t steps_per_bin() const { return split ? shared::kMaxBins / std::clamp(bins, 1u, shared::kMaxBins) : 1; }
    /// Bins between the knots of the B-spline (of variance window^2 / 3) that makes the spread of a vote, together with its share in two bins (1/6).
    float window() const {
        const float spread_in_bins = spread * float(bins) / (log10_high - log10_low);
        return split ? std::sqrt(std::max(3 * (spread_in_bins * spread_in_bins - 1.0f / 6), 1.0f)) : 0;
    }
    float ln_low() const { return log10_low * std::numbers::ln10_v<float>; }
    float bins_per_ln() const { return float(bins) / ((log10_high - log10_low) * std::numbers::ln10_v<float>); }
};

/// Votes of ln luminance over the texels of one pyramid level (1-based), and of level 1 as settings say. A shared::Histogram.
Resource add_histogram(FrameGraph&, const Kernels&, const Pyramid&, uint32_t level, VkExtent2D image, const HistogramSettings&);

struct ToneSettings {
    float key = 0.18f;         ///< Reinhard 2002
    float white = 0;           ///< Reinhard 2002: cd/m^2 shown as white; 0: the frame's maximum
    float linear_low = 0;      ///< cd/m^2 shown as black
    float linear_high = 0;     ///< cd/m^2 shown as white; 0: the frame's maximum
    bool automatic = false;    ///< Reinhard 2003: key and white from the log average and the 1st and 99th percentile
    float log_epsilon = 0;     ///< Reinhard: cd/m^2 added before logarithms (1e-5 as in his program); 0: none, at least 1e-4 cd/m^2 instead
    float rod_constant = 5e5f; ///< Pattanaik: of the half saturation of rods; pfstmo_pattanaik00 has 5e4
    bool colour_loss = false;  ///< dim light loses its colour
    bool acuity_loss = false;  ///< dim light is blurred as far as it cannot be resolved
    bool purkinje = false;     ///< dim light is weighted as rods do
    bool photopic_rods = false; ///< rods take luminance for scotopic luminance, as in pfstools; without: that of the colour, and of white for what the eye adapts to
    uint32_t gamut = shared::kGamutLuminance;  ///< shared::kGamut*: what gives way where the display is not as bright in a colour
    Observer observer;         ///< whose eye it is
    glm::vec2 gaze{0.5f};      ///< where it looks, parts of the image from its top left
    std::optional<uint32_t> adapt_to;  ///< shared::kAdapt*; default: as the operator has it
    std::optional<uint32_t> ceiling;   ///< shared::kCeiling*; default: as the operator has it
    float smoothing_seconds = 0.15f;   ///< of the curve, against flicker; not a model of the eye; 0: none
};

/// Where on the pyramid one degree is.
struct FovealView {
    uint32_t level;     ///< 1-based
    VkExtent2D texels;  ///< of that level
    VkExtent2D image;   ///< px
};

shared::ToneParameters tone_parameters(const OperatorInfo&, const HistogramSettings&, const ToneSettings&, const Display&, const FovealView&,
                                       float seconds);

struct Adaptation {
    Resource curve;  ///< shared::ToneCurve
    History eye;     ///< shared::EyeState
};

/// What add_adaptation keeps from frame to frame; Executor::reset of it forgets what the eye was adapted to.
constexpr const char* kEyeHistory = "eye";

/// Lets the eye adapt to what it looks at (vision/eye.h; exact for any time step, at once in the first frame), and turns that
/// and the histogram into a tone curve, smoothed over time, or into the parameters of the operator's form. `remembered`: what the
/// eye remembers instead of the last frame. `colours`: what it adapts to where the operator is chromatic.
Adaptation add_adaptation(FrameGraph&, const Kernels&, const Pyramid&, Resource histogram, const OperatorInfo&, shared::ToneParameters,
                          uint32_t foveal_level, const shared::EyeState* remembered = nullptr, const Colours& colours = {});

/// The scene as bands of contrast between the levels of the pyramid (log averages), up to the foveal one, each with the visibility
/// level it has in the scene: contrast over what is just seen by cones adapted to a texel of the level above, and on the display by cones
/// adapted to 0.3 of its white (Ferwerda et al. 1996; Grave and Bremond 2008, reconstructed), linear between such texels; never more
/// contrast than in the scene. What is above is mapped by `curve`. rgba32f, cd/m^2 on the display, before its limits. `tone`: kToneCurve
/// and how dim light is perceived.
Resource add_bands(FrameGraph&, const Kernels&, Resource scene, const Pyramid&, uint32_t foveal_level, Resource curve, uint32_t tone,
                   const shared::ToneParameters&, VkExtent2D extent);

/// The scene as it falls on the retina: every pixel keeps a part of its light and scatters the rest, as `fit` has it, and lamps
/// outside of the picture scatter theirs into it, and what other pictures of the eye have, `beyond`. rgba32f, cd/m^2. What a picture loses is
/// what falls beside it. A pixel that is not finite stays and scatters nothing. `fit` is of the same size as the scene.
Resource add_scatter(FrameGraph&, const Kernels&, Resource scene, const GpuScatter& fit, const std::vector<OffscreenLamp>&, const OffscreenLight* beyond = nullptr);

/// Adds needles and halo of the brightest lamps to what add_scatter made of `scene`, in place. A lamp is the light of a square of
/// shared::kCoronaTile px of the picture, wherever it comes from; what is hidden has none. The shared::kCoronaLamps brightest count, each less as the
/// next one is nearer to it. `pattern` are the texels of corona_texels.
Resource add_corona(FrameGraph&, const Kernels&, Resource scene, Resource seen, const std::vector<glm::vec4>& pattern, const View&);

struct BloomSettings {
    float threshold = 0.9f;      ///< light of its brightest channel, relative to white, from which a pixel glares
    float sigma_degrees = 0.35f; ///< of the Gaussian
    float gain = 1;              ///< 0: no glare, no pass
};

/// The paper's glare: the tone-mapped image where it reaches `threshold`, blurred by a normalised Gaussian. Displayed
/// light (relative), rgba16f at a quarter of the resolution. `tone` is one of shared::kTone*.
Resource add_bloom(FrameGraph&, const Kernels&, Resource scene, Resource curve, uint32_t tone, const View&,
                       const Display&, const BloomSettings&);

struct CompositeInputs {
    Resource scene;            ///< cd/m^2
    Resource curve;
    Resource bloom;        ///< optional: what add_bloom gave; added after the curve
    bool blue_first = false;   ///< codes have blue in their lowest bits, and red in the highest
};

/// Maps scene luminance to display codes: tone curve, colour at the mapped luminance (as `tone`'s bits shared::kGamut* have it where the
/// display cannot show that colour as bright; nearer to grey where it lies outside its primaries), glare, and the codes of the display.
/// One word per pixel, r32ui, red in its lowest bits: 8 bits a channel and alpha 255, or 10 bits and alpha 3. A channel's
/// code is the whole number nearest to what the display would need, exactly. Pixels that are not finite show the darkest.
Resource add_composite(FrameGraph&, const Kernels&, const CompositeInputs&, uint32_t tone, const View&, const Display&,
                       float ldr_glare_gain);

/// The same without the limits of the display, rgba32f, cd/m^2 in Rec. 709: what it would emit and reflect if it had
/// every colour and no peak.
Resource add_display_light(FrameGraph&, const Kernels&, const CompositeInputs&, uint32_t tone, const View&,
                           const Display&, float ldr_glare_gain);

}  // namespace vesper
