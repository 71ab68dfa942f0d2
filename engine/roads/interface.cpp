// The public interface, vesper/roads.hpp: functions of this library, with its exceptions. SPDX-License-Identifier: MIT
#include <exception>
#include <new>

#include <vesper/roads.hpp>

#include "base/error.h"
#include "roads/convert_roads.h"
#include "roads/layout_file.h"
#include "roads/lit_roads.h"
#include "roads/road_lighting.h"
#include "roads/small_targets.h"

namespace vesper::roads {
namespace {

/// Calls, and throws Failure for whatever the call throws: of `kind` if memory is not the reason.
template <class Call>
auto guarded(VesperResult kind, const Call& call) {
    try {
        return call();
    } catch (const OutOfHostMemory& error) {
        throw cpp::Failure(VESPER_OUT_OF_MEMORY, error.what());
    } catch (const std::bad_alloc&) {
        throw cpp::Failure(VESPER_OUT_OF_MEMORY, "out of memory");
    } catch (const std::exception& error) {
        throw cpp::Failure(kind, error.what());
    }
}

}  // namespace

RoadConversion convert_opendrive(const std::filesystem::path& opendrive, const std::filesystem::path& scene,
                                 const ConvertOptions& options) {
    guarded(VESPER_BAD_ARGUMENT, [&] { check_street_lamps(options.lamps), check_signal_time(options.signal_time); });
    return guarded(VESPER_FAILED, [&] { return convert_roads(opendrive, scene, options); });
}

RoadLayout read_road_layout(const std::filesystem::path& file) {
    return guarded(VESPER_FAILED, [&]() -> RoadLayout { return read_layout(file); });
}

RoadLighting calculate_road_lighting(const RoadLayout& layout) {
    guarded(VESPER_BAD_ARGUMENT, [&] { check_layout(layout); });
    return guarded(VESPER_FAILED, [&] { return calculate_lighting(load_layout(layout)); });
}

SmallTargetVisibility calculate_small_targets(const RoadLayout& layout, double reflectance) {
    guarded(VESPER_BAD_ARGUMENT, [&] { check_layout(layout), check_target_reflectance(reflectance); });
    return guarded(VESPER_FAILED, [&] { return small_target_visibility(load_layout(layout), reflectance); });
}

}  // namespace vesper::roads
