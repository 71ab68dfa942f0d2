#include "gpu_scene/kernels.h"

#include "gpu_scene/eye_scatter.h"

#include "shaders/acuity.comp.inc"
#include "shaders/adapt.comp.inc"
#include "shaders/bands.comp.inc"
#include "shaders/bloom_blur.comp.inc"
#include "shaders/bloom_bright.comp.inc"
#include "shaders/cluster.comp.inc"
#include "shaders/colours.comp.inc"
#include "shaders/composite.comp.inc"
#include "shaders/corona.comp.inc"
#include "shaders/corona_pick.comp.inc"
#include "shaders/corona_tiles.comp.inc"
#include "shaders/daylight.comp.inc"
#include "shaders/display_light.comp.inc"
#include "shaders/gather.comp.inc"
#include "shaders/histogram.comp.inc"
#include "shaders/occupancy.comp.inc"
#include "shaders/picture.comp.inc"
#include "shaders/pyramid.comp.inc"
#include "shaders/scatter_down.comp.inc"
#include "shaders/scatter_edge.comp.inc"
#include "shaders/scatter_top.comp.inc"
#include "shaders/scatter_up.comp.inc"
#include "shaders/select.comp.inc"
#include "shaders/shade.comp.inc"
#include "shaders/sky.comp.inc"
#include "shaders/luminaires.comp.inc"

namespace vesper {
namespace {

// The kernel of a variant, made when it is first asked for.
template <class Variant, class Make>
const Kernel& once(std::map<Variant, Kernel>& made, const Variant& variant, const Make& make) {
    const auto found = made.find(variant);
    return found != made.end() ? found->second : made.emplace(variant, make()).first->second;
}

uint32_t has(uint32_t variant, Kernels::ShadeVariant bit) { return variant & bit ? 1 : 0; }

}  // namespace

// A CPU device fetches a light once for eight pixels and works on rows of 32; a GPU on squares, a pixel each.
Kernels::Kernels(const Device& device)
    : occupancy(device, "occupancy.comp", occupancy_comp),
      shade_group(device.is_cpu() ? VkExtent2D{32, 1} : VkExtent2D{32, 8}),
      shade_rows(device.is_cpu() ? 8 : 1),
      picture(device, "picture.comp", picture_comp),
      sky(device, "sky.comp", sky_comp, {shade_group.width, shade_group.height, shade_rows}),
      daylight(device, "daylight.comp", daylight_comp, {shade_group.width, shade_group.height, shade_rows}),
      luminaires(device, "sources.comp", luminaires_comp),
      pyramid_first(device, "pyramid.comp", pyramid_comp, {1}),
      pyramid(device, "pyramid.comp", pyramid_comp, {0}),
      colours(device, "colours.comp", colours_comp),
      acuity(device, "acuity.comp", acuity_comp),
      histogram_rows(device.is_cpu() ? 8 : 1),
      histogram(device, "histogram.comp", histogram_comp, {histogram_rows}),
      blur(device, "blur.comp", bloom_blur_comp),
      scatter_up_strip(device.is_cpu() ? VkExtent2D{4, 32} : VkExtent2D{1, 1}),
      scatter_down_strip{uint32_t(vesper::scatter_down_strip(device).x), uint32_t(vesper::scatter_down_strip(device).y)},
      scatter_up_first(device, "scatter_up.comp", scatter_up_comp, {scatter_up_strip.width, scatter_up_strip.height, 1}),
      scatter_up(device, "scatter_up.comp", scatter_up_comp, {scatter_up_strip.width, scatter_up_strip.height, 0}),
      scatter_top(device, "scatter_top.comp", scatter_top_comp),
      scatter_down(device, "scatter_down.comp", scatter_down_comp, {scatter_down_strip.width, 0, kTapReach}),
      scatter_down_last(device, "scatter_down.comp", scatter_down_comp, {scatter_down_strip.width, 1, kTapReach}),
      scatter_down_wide(device, "scatter_down.comp", scatter_down_comp, {scatter_down_strip.width, 0, kWideTapReach}),
      scatter_down_wide_last(device, "scatter_down.comp", scatter_down_comp, {scatter_down_strip.width, 1, kWideTapReach}),
      scatter_edge(device, "scatter_edge.comp", scatter_edge_comp),
      corona_tiles(device, "corona_tiles.comp", corona_tiles_comp),
      corona_pick(device, "corona_pick.comp", corona_pick_comp),
      corona(device, "corona.comp", corona_comp),
      composite_rows(device.is_cpu() ? 4 : 1),
      device_(device) {}

uint32_t Kernels::most_groups() const { return device_.limits().maxComputeWorkGroupCount[0]; }

const Kernel& Kernels::cluster(uint32_t variant) const {
    return once(cluster_, variant & (kPowers | kMaps), [&] { return Kernel(device_, "cluster.comp", cluster_comp, {has(variant, kPowers), has(variant, kMaps)}); });
}

const Kernel& Kernels::select(uint32_t variant) const {
    return once(select_, variant & (kPowers | kMaps), [&] { return Kernel(device_, "select.comp", select_comp, {has(variant, kPowers), has(variant, kMaps)}); });
}

const Kernel& Kernels::gather(uint32_t variant) const {
    return once(gather_, variant & (kCones | kPowers | kMaps | kRoads),
                [&] { return Kernel(device_, "gather.comp", gather_comp, {has(variant, kCones), has(variant, kPowers), has(variant, kMaps), has(variant, kRoads)}); });
}

const Kernel& Kernels::shade(uint32_t variant) const {
    return once(shade_, variant, [&] {
        return Kernel(device_, "shade.comp", shade_comp,
                      {shade_group.width, shade_group.height, shade_rows, has(variant, kEveryLamp), has(variant, kCones), has(variant, kPowers), has(variant, kMaps), has(variant, kListed),
                       has(variant, kGathered), has(variant, kGlossy), has(variant, kRoads), has(variant, kRetro)});
    });
}

const Kernel& Kernels::adapt(uint32_t model) const {
    return once(adapt_, model, [&] { return Kernel(device_, "adapt.comp", adapt_comp, {model}); });
}

const Kernel& Kernels::bright(uint32_t tone) const {
    return once(bright_, tone, [&] { return Kernel(device_, "bright.comp", bloom_bright_comp, {tone}); });
}

const Kernel& Kernels::bands(const BandsVariant& variant) const {
    return once(bands_, variant, [&] { return Kernel(device_, "bands.comp", bands_comp, {variant.tone, variant.band}); });
}

const Kernel& Kernels::composite(const CompositeVariant& variant) const {
    return once(composite_, variant, [&] {
        const std::initializer_list<uint32_t> constants{variant.tone, variant.bloom, composite_rows, variant.primaries, variant.blue_first};
        return variant.light ? Kernel(device_, "display_light.comp", display_light_comp, constants) : Kernel(device_, "composite.comp", composite_comp, constants);
    });
}

}  // namespace vesper
