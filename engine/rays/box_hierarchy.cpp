#include "rays/box_hierarchy.h"

#include <algorithm>

#include "base/budget.h"
#include "base/error.h"
#include "scene/bounds.h"

namespace vesper::rays {
namespace {

constexpr float kOfPlace = 0x1p-22f, kOfSize = 0x1p-20f;
/// Triangles farther away, m, are as a rule errors of a file; they make boxes of others no larger.
constexpr float kMostFarthest = 0x1p15f;

float largest(glm::vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Triangles, and the margin of the boxes around them.
struct Boxes {
    std::span<const Triangle> triangles;
    float farthest = 0;

    explicit Boxes(std::span<const Triangle> of) : triangles(of) {
        for (const Triangle& triangle : of)
            for (const glm::vec3& corner : triangle.corners) farthest = std::max(farthest, largest(corner));
        farthest = std::min(farthest, kMostFarthest);
    }
    static void bound(const RTCBoundsFunctionArguments* arguments) {
        const auto& boxes = *static_cast<const Boxes*>(arguments->geometryUserPtr);
        scene::Bounds box;
        for (const glm::vec3& corner : boxes.triangles[arguments->primID].corners) box.add(corner);
        const glm::vec3 size = box.high - box.low;
        const float place = std::max(largest(box.low), largest(box.high));
        const glm::vec3 margin(kOfPlace * (place + boxes.farthest) + kOfSize * (size.x + size.y + size.z));
        const glm::vec3 low = box.low - margin, high = box.high + margin;
        RTCBounds& to = *arguments->bounds_o;
        to.lower_x = low.x, to.lower_y = low.y, to.lower_z = low.z;
        to.upper_x = high.x, to.upper_y = high.y, to.upper_z = high.z;
    }
};

// Whether there is any left of a Budget.
bool has_time(void*, double) {
    try {
        check_time();
        return true;
    } catch (const Error&) {
        return false;
    }
}

std::string reason(RTCError error) {
    if (error == RTC_ERROR_OUT_OF_MEMORY) return "not enough memory";
    if (error == RTC_ERROR_CANCELLED) return "not enough processor time";
    return "Embree reports error " + std::to_string(int(error));
}

void check(RTCDevice device, const std::string& task) {
    const RTCError error = rtcGetDeviceError(device);
    if (!device || error != RTC_ERROR_NONE) throw Error(task + ": " + reason(error));
}

}  // namespace

// One thread builds, so that none of Embree's stays behind, and a Budget counts its time.
BoxHierarchy::BoxHierarchy(std::span<const Triangle> triangles, const TriangleLooks& looks, const std::string& task)
    : device_(rtcNewDevice("threads=1")) {
    check(device_.get(), task);
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* bytes, ssize_t more, bool) {
            *static_cast<std::atomic<int64_t>*>(bytes) += more;
            return true;
        },
        &bytes_);
    Boxes boxes(triangles);
    const embree::Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    scene_.reset(rtcNewScene(device_.get()));
    check(device_.get(), task);
    rtcSetGeometryUserPrimitiveCount(geometry.get(), unsigned(triangles.size()));
    rtcSetGeometryUserData(geometry.get(), &boxes);
    rtcSetGeometryBoundsFunction(geometry.get(), Boxes::bound, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), looks.nearest);
    rtcSetGeometryOccludedFunction(geometry.get(), looks.any);
    rtcCommitGeometry(geometry.get());
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene_.get(), geometry.get());
    rtcSetSceneProgressMonitorFunction(scene_.get(), has_time, nullptr);
    rtcCommitScene(scene_.get());
    check(device_.get(), task);
    rtcSetGeometryUserData(geometry.get(), nullptr);
}

uint64_t BoxHierarchy::bytes() const { return uint64_t(std::max<int64_t>(bytes_, 0)); }

}  // namespace vesper::rays
