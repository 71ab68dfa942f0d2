// The SPIR-V reader against modules assembled by hand, whole and damaged. SPDX-License-Identifier: MIT
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "gpu/kernel_interface.h"

namespace vesper::test {
namespace {

using Words = std::vector<uint32_t>;

/// A string as SPIR-V packs it: four characters a word, ended by zero.
Words packed(const std::string& text) {
    Words words(text.size() / 4 + 1);
    for (size_t i = 0; i < text.size(); ++i) words[i / 4] |= static_cast<uint32_t>(text[i]) << (i % 4 * 8);
    return words;
}

/// Opcodes and operands as numbered by the specification; ids are chosen by the test.
struct Assembly {
    Words words{0x07230203u, 0x00010600u, 0, 100, 0};

    void op(uint32_t opcode, std::initializer_list<uint32_t> operands, const Words& tail = {}) {
        words.push_back(static_cast<uint32_t>((1 + operands.size() + tail.size()) << 16) | opcode);
        words.insert(words.end(), operands);
        words.insert(words.end(), tail.begin(), tail.end());
    }
    void entry(uint32_t id = 1) { op(15, {5, id}, packed("main")); }
    void local_size(uint32_t x, uint32_t y, uint32_t z) { op(16, {1, 17, x, y, z}); }
    void decorate(uint32_t id, uint32_t what, uint32_t value) { op(71, {id, what, value}); }
    void decorate_member(uint32_t id, uint32_t member, uint32_t what, uint32_t value) {
        op(72, {id, member, what, value});
    }
    void bind(uint32_t id, uint32_t binding, uint32_t set = 0) { decorate(id, 34, set), decorate(id, 33, binding); }
    /// A variable `id` in `storage` of type `type`, through the pointer type `id + 1`.
    void variable(uint32_t id, uint32_t storage, uint32_t type) {
        op(32, {id + 1, storage, type});
        op(59, {id + 1, id, storage});
    }
};

constexpr uint32_t kUint = 10, kFloat = 11, kVec3 = 12, kMat4 = 13, kEight = 14, kVec4 = 15;  // ids of common types
constexpr uint32_t kUniformConstant = 0, kUniform = 2, kPushConstant = 9, kStorageBuffer = 12;

void add_types(Assembly& a) {
    a.op(21, {kUint, 32, 0});
    a.op(22, {kFloat, 32});
    a.op(23, {kVec3, kFloat, 3});
    a.op(23, {kVec4, kFloat, 4});
    a.op(24, {kMat4, kVec4, 4});
    a.op(43, {kUint, kEight, 8});
}

/// A module with one binding of each kind in use, declared out of order, push constants and names.
Words whole_module() {
    Assembly a;
    a.entry();
    a.local_size(8, 4, 2);
    a.op(5, {40}, packed("Push"));
    a.op(6, {40, 0}, packed("world_to_view"));
    a.op(6, {40, 1}, packed("position"));
    a.op(5, {41}, packed("Counts"));
    a.op(6, {41, 0}, packed("count"));
    a.op(5, {42}, packed("Camera"));
    const uint32_t variables[] = {50, 52, 54, 56, 58, 60, 62};
    for (uint32_t i = 0; i < 7; ++i) a.bind(variables[i], 6 - i);
    a.decorate(41, 2, 0), a.decorate(42, 2, 0), a.decorate(40, 2, 0);
    a.decorate_member(40, 0, 35, 0), a.decorate_member(40, 0, 7, 16);
    a.decorate_member(40, 1, 35, 64);
    a.decorate_member(40, 2, 35, 76);
    a.decorate_member(41, 0, 35, 0);
    a.decorate_member(42, 0, 35, 4);
    a.decorate(39, 6, 4);
    add_types(a);
    a.op(28, {39, kUint, kEight});
    a.op(30, {40, kMat4, kVec3, 39});
    a.op(30, {41, kUint});
    a.op(30, {42, kFloat});
    a.op(25, {30, kFloat, 1, 0, 0, 0, 1, 0});  // 2D, sampled
    a.op(25, {31, kFloat, 1, 0, 0, 0, 2, 2});  // 2D, storage
    a.op(25, {32, kFloat, 5, 0, 0, 0, 1, 0});  // buffer, sampled
    a.op(25, {33, kFloat, 5, 0, 0, 0, 2, 3});  // buffer, storage
    a.op(27, {34, 30});
    a.variable(50, kStorageBuffer, 41);
    a.variable(52, kUniform, 42);
    a.variable(54, kUniformConstant, 33);
    a.variable(56, kUniformConstant, 32);
    a.variable(58, kUniformConstant, 31);
    a.variable(60, kUniformConstant, 30);
    a.variable(62, kUniformConstant, 34);
    a.variable(64, kPushConstant, 40);
    return a.words;
}

std::string error_of(const Words& words) {
    try {
        gpu::read_interface("k.comp", words);
        return "accepted";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(Spirv, ReadsBindingsPushConstantsAndWorkgroup) {
    const gpu::KernelInterface kernel = gpu::read_interface("k.comp", whole_module());
    EXPECT_EQ(kernel.name, "k.comp");
    EXPECT_EQ(kernel.bindings, (std::vector<VkDescriptorType>{
                                   VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                   VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                                   VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                   VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}));
    EXPECT_EQ(kernel.push_bytes, 76u + 8u * 4u);
    EXPECT_EQ(kernel.group, (std::array<uint32_t, 3>{8, 4, 2}));
}

TEST(Spirv, ListsMembersOfBlocks) {
    const std::vector<gpu::BlockMember> members = gpu::block_members(whole_module());
    ASSERT_EQ(members.size(), 3u) << "those with a name only";
    EXPECT_EQ(members[0].block + "." + members[0].member, "Push.world_to_view");
    EXPECT_EQ(members[1].block + "." + members[1].member, "Push.position");
    EXPECT_EQ(members[1].offset, 64u);
    EXPECT_EQ(members[2].block + "." + members[2].member, "Counts.count");
}

TEST(Spirv, ReadsAnOldStorageBuffer) {
    Assembly a;
    a.entry();
    a.bind(50, 0);
    a.decorate(41, 3, 0);
    add_types(a);
    a.op(30, {41, kUint});
    a.variable(50, kUniform, 41);
    EXPECT_EQ(gpu::read_interface("k.comp", a.words).bindings, std::vector{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
}

TEST(Spirv, ReadsWorkgroupsGivenByConstants) {
    Assembly a;
    a.entry();
    a.op(331, {1, 38, kEight, 20, kEight});
    add_types(a);
    a.op(50, {kUint, 20, 16});  // a specialization constant and its default
    EXPECT_EQ(gpu::read_interface("k.comp", a.words).group, (std::array<uint32_t, 3>{8, 16, 8}));

    a.op(51, {kVec3, 21, 20, 20, kEight});
    a.decorate(21, 11, 25);  // the built-in WorkgroupSize wins
    EXPECT_EQ(gpu::read_interface("k.comp", a.words).group, (std::array<uint32_t, 3>{16, 16, 8}));
}

TEST(Spirv, RowMajorMatricesCountRows) {
    Assembly a;
    a.entry();
    add_types(a);
    a.op(24, {20, kVec3, 2});  // 2 columns of 3
    a.op(30, {40, 20});
    a.decorate_member(40, 0, 35, 0), a.decorate_member(40, 0, 7, 8), a.decorate_member(40, 0, 4, 0);
    a.variable(64, kPushConstant, 40);
    EXPECT_EQ(gpu::read_interface("k.comp", a.words).push_bytes, 3u * 8u);
}

TEST(Spirv, RefusesBindingsTheEngineDoesNotUse) {
    const auto with_buffers = [](std::initializer_list<std::pair<uint32_t, uint32_t>> bindings_and_sets) {
        Assembly a;
        a.entry();
        add_types(a);
        a.op(30, {41, kUint});
        uint32_t id = 50;
        for (const auto& [binding, set] : bindings_and_sets) {
            a.bind(id, binding, set);
            a.variable(id, kStorageBuffer, 41);
            id += 2;
        }
        return a.words;
    };
    EXPECT_EQ(error_of(with_buffers({{0, 0}, {1, 0}})), "accepted");
    EXPECT_EQ(error_of(with_buffers({{0, 0}, {2, 0}})), "shader 'k.comp': binding 1 is missing");
    EXPECT_EQ(error_of(with_buffers({{0, 0}, {0, 0}})), "shader 'k.comp': binding 0 is used twice");
    EXPECT_EQ(error_of(with_buffers({{0, 1}})), "shader 'k.comp': variable 50 lies outside set 0");

    Assembly sampler;
    sampler.entry();
    sampler.bind(50, 0);
    sampler.op(26, {20});
    sampler.variable(50, kUniformConstant, 20);
    EXPECT_EQ(error_of(sampler.words), "shader 'k.comp': binding 0 is of a kind the engine does not use");

    Assembly unbound;
    unbound.entry();
    unbound.op(5, {50}, packed("lamps"));
    add_types(unbound);
    unbound.op(30, {41, kUint});
    unbound.variable(50, kStorageBuffer, 41);
    EXPECT_EQ(error_of(unbound.words), "shader 'k.comp': 'lamps' has no binding");
}

TEST(Spirv, RefusesWhatIsNotOneComputeShader) {
    EXPECT_EQ(error_of({}), "shader 'k.comp': not a SPIR-V module");
    EXPECT_EQ(error_of(Words(8, 0)), "shader 'k.comp': not a SPIR-V module");
    Assembly a;
    EXPECT_EQ(error_of(a.words), "shader 'k.comp': not one compute entry point");
    a.op(15, {4, 1}, packed("main"));  // a fragment shader
    EXPECT_EQ(error_of(a.words), "shader 'k.comp': not one compute entry point");
}

TEST(Spirv, RefusesInstructionsThatDoNotEnd) {
    Assembly zero;
    zero.words.push_back(0);
    EXPECT_EQ(error_of(zero.words), "shader 'k.comp': instruction at word 5 runs past the end of the module");
    Assembly past;
    past.words.push_back(4u << 16 | 71u);
    EXPECT_EQ(error_of(past.words), "shader 'k.comp': instruction at word 5 runs past the end of the module");
    Assembly brief;
    brief.op(59, {1});
    EXPECT_EQ(error_of(brief.words), "shader 'k.comp': an instruction is too short");
    Assembly endless;
    endless.op(5, {1, 0x41414141u});
    EXPECT_EQ(error_of(endless.words), "shader 'k.comp': a name does not end");
}

TEST(Spirv, RefusesATypeThatContainsItself) {
    Assembly a;
    a.entry();
    a.op(30, {40, 40});
    a.decorate_member(40, 0, 35, 0);
    a.variable(64, kPushConstant, 40);
    EXPECT_EQ(error_of(a.words), "shader 'k.comp': types are nested too deep");
}

// Whatever the damage, the reader answers or refuses; sanitizers see to the rest.
TEST(Spirv, SurvivesDamage) {
    const Words whole = whole_module();
    const auto try_to_read = [](const Words& words) {
        try {
            gpu::read_interface("k.comp", words);
            gpu::block_members(words);
        } catch (const Error&) {
        }
    };
    for (size_t size = 0; size < whole.size(); ++size)
        try_to_read({whole.begin(), whole.begin() + static_cast<long>(size)});
    std::mt19937 random(1);
    for (size_t at = 0; at < whole.size(); ++at)
        for (const uint32_t value : {0u, 1u, ~0u, static_cast<uint32_t>(random()), whole[random() % whole.size()]}) {
            Words damaged = whole;
            damaged[at] = value;
            try_to_read(damaged);
        }
}

}  // namespace
}  // namespace vesper::test
