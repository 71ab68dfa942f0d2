// Clipmaps of a scene's directional lamps, from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "render/shadows/clipmap_layout.h"
#include "render/shadows/directional_visibility.h"
#include "render/shadows/draw_clipmaps.h"

namespace vesper::render {

/// Owns the clipmaps on the device. A level is drawn when the eye has moved on by a step of it, when its lamp turns,
/// and all are when anything in the scene moves: the content of a clipmap depends on the frame alone. Not thread-safe.
class Clipmaps {
public:
    /// Throws Error where there are too many directional lamps.
    Clipmaps(const gpu::Device& device, const gpu_scene::GpuScene& resident,
             const std::vector<gpu_scene::PlacedLamp>& lamps, const ClipmapPlan& plan);

    /// Finds which levels are out of date for a frame; returns how many. Host work only.
    uint32_t plan(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, const gpu_scene::View& view);
    /// Declares the work that plan() found, with its arguments; declared again, nothing is left to draw. Returns the
    /// clipmaps of the directional lamps of the list.
    FrameClipmaps declare(const FrameContext& frame, const gpu_scene::LampList& list,
                          const gpu_scene::SceneFrame& poses, const gpu_scene::View& view);
    /// A frame that was declared has failed: all levels are drawn anew.
    void forget();
    uint64_t bytes() const { return arena_.bytes(); }  ///< of device memory

private:
    /// The place for which a level was drawn.
    struct Level {
        glm::dmat3 rotation{0};
        glm::dvec3 middle{0};
        bool operator==(const Level&) const = default;
    };

    const gpu_scene::GpuScene& resident_;
    const std::vector<gpu_scene::PlacedLamp>& lamps_;
    ClipmapPlan plan_;
    uint32_t first_;  // of the directional ones among lamps_
    gpu::Arena arena_;
    gpu::OwnedBuffer distances_;
    std::vector<Level> levels_;       // lamp by lamp
    std::vector<glm::dmat4> placed_;  // poses of placements
    uint32_t used_ = 1;               // levels
    std::vector<LevelToDraw> to_draw_;
};

}  // namespace vesper::render
