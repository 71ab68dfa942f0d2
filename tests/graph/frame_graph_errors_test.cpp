// Every mistake in a declaration is refused by name, before anything runs. SPDX-License-Identifier: MIT
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "graph/declared_frame.h"

namespace vesper::test {
namespace {

using graph::Groups, graph::Resource, graph::load, graph::sample, graph::store, graph::update;

/// Expects `mistake` to be refused in one line that has `words` in it.
void expect_error(const std::function<void()>& mistake, const std::string& words) {
    try {
        mistake();
        ADD_FAILURE() << "was accepted; expected: " << words;
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find(words), message.npos) << "got: " << message << "\nnot: " << words;
        EXPECT_EQ(message.find('\n'), message.npos);
    }
}

TEST(FrameGraphErrors, ReadingWhatNothingHasWritten) {
    DeclaredFrame f;
    const Resource glare = f.image("glare"), out = f.image("out"), bytes = f.buffer("bytes"), to = f.buffer("to");
    expect_error(
        [&] {
            f.compute("composite", {sample(glare), store(out)});
        },
        "pass 'composite' reads 'glare' before any pass has written it");
    expect_error([&] { f.compute("a", {load(glare), store(out)}); }, "reads 'glare' before");
    expect_error([&] { f.compute("a", {update(bytes)}); }, "reads 'bytes' before");
    expect_error([&] { f.graph.copy("a", bytes, to); }, "pass 'a' reads 'bytes' before");
    expect_error([&] { f.draw("a", {color(out), vertices(bytes)}); }, "reads 'bytes' before");
    const graph::History eye = f.graph.history("eye", graph::buffer_shape(8));
    expect_error([&] { f.compute("a", {load(eye.current)}); }, "reads 'eye' before");
    EXPECT_NO_THROW(f.compute("a", {load(eye.previous)}));
}

TEST(FrameGraphErrors, WritingWhatIsNotOurs) {
    DeclaredFrame f;
    const graph::History eye = f.graph.history("eye", graph::buffer_shape(8));
    const Resource lamps = f.graph.upload("lamps", std::vector<uint32_t>{1, 2});
    expect_error([&] { f.compute("adapt", {store(eye.previous)}); }, "pass 'adapt' writes 'eye (previous)'");
    expect_error([&] { f.graph.clear("zero", eye.previous); }, "writes 'eye (previous)'");
    expect_error([&] { f.compute("light", {update(lamps)}); }, "pass 'light' writes the upload 'lamps'");
    expect_error([&] { f.graph.clear("zero", lamps); }, "writes the upload 'lamps'");
}

TEST(FrameGraphErrors, LeavingWhatIsAskedForUnwritten) {
    DeclaredFrame f;
    f.graph.history("eye", graph::buffer_shape(8));
    expect_error([&] { f.plan(); }, "history 'eye' is written by no pass");
    DeclaredFrame g;
    g.graph.readback("pixels", 16);
    expect_error([&] { g.plan(); }, "'pixels' is kept but written by no pass");
}

TEST(FrameGraphErrors, PartsOutsideOfABuffer) {
    DeclaredFrame f;
    const Resource from = f.graph.upload("from", std::vector<uint32_t>{1, 2}), to = f.buffer("to", 16);
    expect_error(
        [&] {
            f.graph.copy("part", from, to, {{4, 0, 8}});
        },
        "copies 8 bytes from 4 of 'from' to 0 of 'to', which have 8 and 16");
    expect_error([&] { f.graph.copy("part", from, to, {{0, 12, 8}}); }, "copies 8 bytes from 0");
    expect_error([&] { f.graph.copy("part", from, to, std::vector<graph::Region>{}); }, "copies nothing");
    expect_error([&] { f.graph.copy("part", from, f.image("image"), {{0, 0, 8}}); }, "copies parts of an image");
    expect_error([&] { f.graph.reserved("none", graph::buffer_shape(8), {}); }, "'none' has no uses");
}

TEST(FrameGraphErrors, NamesAndSizes) {
    DeclaredFrame f;
    f.image("scene");
    f.graph.history("eye", graph::buffer_shape(8));
    expect_error([&] { f.buffer("scene"); }, "resource 'scene' is declared twice");
    expect_error([&] { f.graph.history("eye", graph::buffer_shape(8)); }, "'eye' is declared twice");
    expect_error([&] { f.buffer(""); }, "has no name");
    expect_error([&] { f.buffer("none", 0); }, "resource 'none' has no size");
    expect_error([&] { f.graph.upload("none", std::vector<uint32_t>{}); }, "resource 'none' has no size");
    expect_error([&] { f.graph.readback("none", 0); }, "resource 'none' has no size");
    expect_error(
        [&] {
            f.graph.transient("flat", graph::image_shape(VK_FORMAT_R32_SFLOAT, {4, 0}));
        },
        "'flat' has no size");
    expect_error(
        [&] {
            f.graph.transient("thin", graph::image_shape(VK_FORMAT_R32_SFLOAT, {0, 4}));
        },
        "'thin' has no size");
    expect_error(
        [&] {
            f.graph.transient("raw", graph::image_shape(VK_FORMAT_UNDEFINED, {4, 4}));
        },
        "'raw' has no format");
}

TEST(FrameGraphErrors, InvalidHandles) {
    DeclaredFrame f;
    const Resource a = f.buffer("a");
    const gpu::KernelInterface kernel{"k.comp", {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, 0, {1, 1, 1}};
    expect_error([&] { f.graph.dispatch("d", kernel, {store(Resource{})}, Groups{}); },
                 "pass 'd' has no valid resource");
    expect_error([&] { f.graph.dispatch("d", kernel, {store(Resource{7})}, Groups{}); },
                 "pass 'd' has no valid resource");
    expect_error([&] { f.graph.clear("c", Resource{}); }, "pass 'c' has no valid resource");
    expect_error([&] { f.graph.copy("c", Resource{}, a); }, "no valid resource to copy from");
    expect_error([&] { f.graph.copy("c", a, Resource{}); }, "no valid resource to copy to");
    expect_error([&] { f.graph.keep(Resource{}); }, "keep");
}

TEST(FrameGraphErrors, OneResourceTwiceInAPass) {
    DeclaredFrame f;
    const Resource a = f.buffer("a");
    expect_error([&] { f.compute("both", {store(a), store(a)}); }, "pass 'both' uses 'a' twice and writes it");
    f.compute("write", {store(a)});
    expect_error([&] { f.compute("both", {load(a), store(a)}); }, "uses 'a' twice");
    expect_error([&] { f.graph.copy("onto itself", a, a); }, "uses 'a' twice");
    EXPECT_NO_THROW(f.compute("read", {load(a), load(a)}));
}

TEST(FrameGraphErrors, UsesThatDoNotFitTheKernel) {
    DeclaredFrame f;
    const Resource image = f.image("image"), bytes = f.buffer("bytes");
    const Resource texels = f.graph.transient("texels", graph::buffer_shape(64, VK_FORMAT_R32_UINT));
    f.compute("write", {store(image), store(bytes), store(texels)});
    const auto give = [&](VkDescriptorType type, graph::Use use) {
        const gpu::KernelInterface kernel{"k.comp", {type}, 0, {1, 1, 1}};
        f.graph.dispatch("p", kernel, {use}, Groups{});
    };
    const std::string to = "to binding 0 of k.comp: it is ";
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, sample(image)); },
                 "pass 'p' gives 'image' as compute sample of an image " + to + "a storage image");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, load(image)); }, to + "a sampled image");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, sample(texels)); }, to + "a sampled image");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, store(image)); }, to + "a storage buffer");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, update(bytes)); }, to + "a storage image");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, sample(bytes)); }, to + "a storage buffer");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, sample(texels)); }, to + "a storage buffer");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, load(bytes)); }, to + "a uniform buffer");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, sample(bytes)); }, "which needs a texel format");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, load(bytes)); }, "which needs a texel format");
    expect_error([&] { give(VK_DESCRIPTOR_TYPE_SAMPLER, sample(image)); }, "of a kind the engine does not use");
    const auto fits = [&](VkDescriptorType type, graph::Use use) {
        const gpu::KernelInterface kernel{"k.comp", {type}, 0, {1, 1, 1}};
        graph::FrameGraph copy = f.graph;
        EXPECT_NO_THROW(copy.dispatch("p", kernel, {use}, Groups{})) << type;
    };
    fits(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, sample(image));
    fits(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, sample(image));
    fits(VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, sample(texels));
    fits(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, sample(bytes));
    fits(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, update(image));
    fits(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, load(texels));
    fits(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, load(texels));
}

TEST(FrameGraphErrors, ADispatchThatDoesNotFitTheKernel) {
    DeclaredFrame f;
    const Resource a = f.buffer("a"), b = f.buffer("b");
    const gpu::KernelInterface kernel{"k.comp", {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, 4, {1, 1, 1}};
    expect_error(
        [&] {
            f.graph.dispatch("d", kernel, {store(a), store(b)}, 1u, Groups{});
        },
        "pass 'd' has 2 uses, but k.comp has 1 bindings");
    expect_error([&] { f.graph.dispatch("d", kernel, {store(a)}, Groups{}); },
                 "pass 'd' pushes 0 bytes, but k.comp takes 4");
    expect_error([&] { f.graph.dispatch("d", kernel, {store(a)}, uint64_t{1}, Groups{}); }, "pushes 8 bytes");
    expect_error(
        [&] {
            f.graph.dispatch("d", kernel, {store(a)}, 1u, Groups{1, 0, 1});
        },
        "pass 'd' dispatches zero groups");
    EXPECT_NO_THROW(f.graph.dispatch("d", kernel, {store(a)}, 1u, Groups{1, 1, 1}));
}

TEST(FrameGraphErrors, ArgumentsThatAreNone) {
    DeclaredFrame f;
    const Resource a = f.buffer("a"), image = f.image("image"), arguments = f.buffer("arguments", 32);
    const gpu::KernelInterface kernel{"k.comp", {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, 4, {1, 1, 1}};
    const auto dispatch = [&](graph::Arguments from) { f.graph.dispatch("d", kernel, {store(a)}, 1u, from); };
    expect_error([&] { dispatch({arguments, 0}); }, "pass 'd' reads 'arguments' before any pass has written it");
    f.compute("write", {store(arguments)});
    expect_error([&] { dispatch({image, 0}); }, "pass 'd' reads arguments from the image 'image'");
    expect_error([&] { dispatch({arguments, 2}); }, "pass 'd' reads arguments at byte 2 of 'arguments'");
    expect_error(
        [&] {
            dispatch({arguments, 24});
        },
        "pass 'd' reads arguments at byte 24 of 'arguments', which has 32");
    expect_error([&] { dispatch({Resource{99}, 0}); }, "pass 'd' has no valid resource as arguments");
    EXPECT_NO_THROW(dispatch({arguments, 20}));
}

TEST(FrameGraphErrors, UsesThatThePassCannotHave) {
    DeclaredFrame f;
    const Resource image = f.image("image"), z = f.image("z", VK_FORMAT_D32_SFLOAT), bytes = f.buffer("bytes");
    expect_error([&] { f.compute("d", {color(image)}); }, "pass 'd' cannot use 'image' as compute color-target");
    expect_error([&] { f.compute("d", {depth(z)}); }, "cannot use 'z' as compute depth-target");
    expect_error([&] { f.compute("d", {{bytes, graph::Access::HostRead}}); }, "cannot use 'bytes'");
    expect_error([&] { f.draw("r", {color(image), {bytes, graph::Access::CopyTarget}}); }, "cannot use 'bytes'");
    expect_error([&] { f.draw("r", {color(bytes)}); }, "pass 'r' has the buffer 'bytes' as a target");
    expect_error([&] { f.draw("r", {color(image), vertices(z)}); }, "reads vertices from the image 'z'");
}

TEST(FrameGraphErrors, Targets) {
    DeclaredFrame f;
    const Resource a = f.image("a"), z = f.image("z", VK_FORMAT_D32_SFLOAT), y = f.image("y", VK_FORMAT_D32_SFLOAT);
    const Resource small = f.graph.transient("small", graph::image_shape(VK_FORMAT_R8G8B8A8_UNORM, {8, 8}));
    const graph::History past = f.graph.history("past", graph::image_shape(VK_FORMAT_R8G8B8A8_UNORM, kExtent));
    expect_error(
        [&] {
            f.draw("r", {color(a), color(small)});
        },
        "pass 'r' has targets 'a' and 'small' of different extents");
    expect_error([&] { f.draw("r", {color(past.current)}); }, "pass 'r' has the history 'past' as a target");
    expect_error([&] { f.draw("r", {}); }, "pass 'r' has no target");
    expect_error([&] { f.draw("r", {color(z)}); }, "has 'z' as a target its format does not fit");
    expect_error([&] { f.draw("r", {depth(a)}); }, "has 'a' as a target its format does not fit");
    expect_error([&] { f.draw("r", {depth(z), depth(y)}); }, "has a second depth target, 'y'");
    expect_error([&] { f.graph.raster("r", {color(a)}, {}); }, "pass 'r' records nothing");
    expect_error(
        [&] {
            f.graph.raster("r", {color(a)}, [](const graph::Recording&) {}, {64, 64});
        },
        "pass 'r' has a target, 'a', and an extent of its own");
}

TEST(FrameGraphErrors, CopiesAndClears) {
    DeclaredFrame f;
    const Resource image = f.image("image"), other = f.image("other"),
                   small = f.graph.transient("small", graph::image_shape(VK_FORMAT_R8G8B8A8_UNORM, {8, 4})),
                   odd = f.buffer("odd", 10);
    const Resource exact = f.graph.readback("exact", 64 * 32 * 4), short_ = f.graph.readback("short", 100);
    f.compute("write", {store(image), store(odd)});
    expect_error([&] { f.graph.fill("f", image, 1, {{0, 0, 4}}); }, "fills the image 'image'; only buffers can be");
    expect_error([&] { f.graph.fill("f", short_, 1, {{0, 98, 4}}); }, "fills 4 bytes at 98 of 'short', which has 100");
    expect_error([&] { f.graph.copy("c", image, short_); },
                 "pass 'c' copies 8192 bytes of 'image' to 'short', which has 100");
    expect_error([&] { f.graph.copy("c", odd, exact); }, "copies 10 bytes of 'odd' to 'exact', which has 8192");
    expect_error([&] { f.graph.copy("c", image, small); },
                 "copies the image 'image' to the image 'small' of another extent");
    expect_error([&] { f.graph.clear("c", image); }, "pass 'c' clears the image 'image'");
    expect_error([&] { f.graph.clear("c", odd); }, "not a multiple of 4 bytes");
    EXPECT_NO_THROW(f.graph.copy("c", image, exact));
    EXPECT_NO_THROW(f.graph.copy("back", exact, other));
    EXPECT_NO_THROW(f.graph.copy("on", other, image));
}

TEST(FrameGraphErrors, MemoryThatDoesNotExist) {
    DeclaredFrame f;
    const Resource a = f.buffer("a");
    f.graph.keep(a);
    f.compute("write", {store(a)});
    f.measure = [](const graph::Shape&, uint32_t) -> graph::Footprint { return {256, 16, 0}; };
    expect_error([&] { f.plan(); }, "resource 'a' fits no memory of the device");
}

}  // namespace
}  // namespace vesper::test
