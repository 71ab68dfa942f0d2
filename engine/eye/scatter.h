// Light scattered in the eye, fitted to a picture and kept on the device. SPDX-License-Identifier: MIT
#pragma once

#include <list>
#include <vector>

#include "gpu/memory.h"
#include "vision/eye_aperture.h"
#include "vision/scatter_fit.h"

namespace vesper::eye {

/// Which published function scatters, and in whose eye.
struct ScatterSettings {
    enum class Model : uint8_t { Cie, Spencer, Ward, Temporal };
    Model model = Model::Cie;
    vision::ScatteringEye eye;                                    ///< CIE; Temporal, whose mean it is
    vision::SpencerState state = vision::SpencerState::Photopic;  ///< Spencer
    vision::ApertureSettings aperture;                            ///< Temporal; Spencer's needles have its seed

    /// Whether bright lamps have needles and a halo (vision/glare_pattern.h).
    bool has_corona() const { return model == Model::Spencer || model == Model::Temporal; }
    bool operator==(const ScatterSettings&) const = default;
};

/// The smooth part of the function, without needles and halo.
vision::EyeScatter eye_scatter(const ScatterSettings&);
/// Columns, and largest number of rows, of texels per invocation of scatter_down.comp.
glm::ivec2 scatter_down_strip(const gpu::Device&);

/// Light of a lamp outside of the picture, which is not in its pixels. It scatters nothing from behind the plane of the
/// eye.
struct OffscreenLamp {
    glm::dvec3 direction{0, 0, -1};  ///< from the eye, view frame
    glm::dvec3 illuminance{0};       ///< RGB lx, on a plane at the eye that faces the lamp
};

/// The fit of one function to one picture, on the device.
class GpuScatter {
public:
    GpuScatter(const gpu::Device&, const ScatterSettings&, const vision::ImageAngles&);

    /// A buffer of texels.
    struct Texels {
        const gpu::OwnedBuffer& buffer;
        uint64_t bytes;
    };
    const ScatterSettings& settings() const { return settings_; }
    const vision::ImageAngles& image() const { return image_; }
    int levels() const { return levels_; }
    int reach() const { return reach_; }
    glm::ivec2 nodes() const { return nodes_; }
    const vision::EdgeLight::Axis& edge_x() const { return edge_x_; }
    const vision::EdgeLight::Axis& edge_y() const { return edge_y_; }
    Texels taps() const {
        return {taps_, taps_bytes_};
    }  ///< rgba32f, node by node, level by level (shared/eye_scatter.h)
    Texels edge() const { return {edge_, edge_bytes_}; }  ///< r32f, EdgeLight::kept
    Texels top() const { return {top_, top_bytes_}; }  ///< rgba32f, for each texel that gives those that take, by four

    /// Lamps whose light begins at a level, two texels each (shared/eye_scatter.h).
    std::vector<glm::vec4> lamps_of(int level, const std::vector<OffscreenLamp>&) const;
    /// Veiling luminance of the lamps that are too far outside for that, cd/m^2 RGB, for each texel of the top that
    /// takes.
    std::vector<glm::vec4> far_veil(const std::vector<OffscreenLamp>&) const;

private:
    ScatterSettings settings_;
    vision::ImageAngles image_;
    vision::EyeScatter psf_;
    int levels_ = 1, reach_ = vision::kTapReach;
    vision::EdgeLight::Axis edge_x_, edge_y_;
    glm::ivec2 nodes_{2};
    gpu::Arena arena_;
    gpu::OwnedBuffer taps_, top_, edge_;
    uint64_t taps_bytes_ = 0, top_bytes_ = 0, edge_bytes_ = 0;
};

/// Keeps the fits of the last pictures, since most frames cover the same.
class ScatterCache {
public:
    /// Of `most` pictures.
    explicit ScatterCache(const gpu::Device& device, size_t most = 1) : device_(&device), most_(most) {}
    const GpuScatter& at(const ScatterSettings&, const vision::ImageAngles&);
    /// True if at() would return a fit that is kept.
    bool has(const ScatterSettings&, const vision::ImageAngles&) const;

private:
    const gpu::Device* device_;
    size_t most_;
    std::list<GpuScatter> fits_;  // the last one first
};

}  // namespace vesper::eye
