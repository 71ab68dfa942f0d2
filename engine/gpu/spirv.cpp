// A reader of just enough SPIR-V to know what a compute shader asks for. SPDX-License-Identifier: MIT
// Collects names, decorations, types, constants and variables in one walk; every word is checked against the module.
#include "gpu/kernel_interface.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace vesper::gpu {
namespace {

// The parts of the SPIR-V specification (unified1) that are read.
constexpr uint32_t kMagic = 0x07230203u, kHeaderWords = 5;
namespace op {
constexpr uint32_t kName = 5, kMemberName = 6, kEntryPoint = 15, kExecutionMode = 16, kTypeInt = 21, kTypeFloat = 22,
                   kTypeVector = 23, kTypeMatrix = 24, kTypeImage = 25, kTypeSampledImage = 27, kTypeArray = 28,
                   kTypeStruct = 30, kTypePointer = 32, kConstant = 43, kConstantComposite = 44, kSpecConstant = 50,
                   kSpecConstantComposite = 51, kVariable = 59, kDecorate = 71, kMemberDecorate = 72,
                   kExecutionModeId = 331;
}  // namespace op
namespace decoration {
constexpr uint32_t kBufferBlock = 3, kRowMajor = 4, kArrayStride = 6, kMatrixStride = 7, kBuiltIn = 11, kBinding = 33,
                   kDescriptorSet = 34, kOffset = 35;
}  // namespace decoration
namespace storage {
constexpr uint32_t kUniformConstant = 0, kUniform = 2, kPushConstant = 9, kStorageBuffer = 12,
                   kPhysicalStorageBuffer = 5349;
}  // namespace storage
constexpr uint32_t kGLCompute = 5, kLocalSize = 17, kLocalSizeId = 38, kWorkgroupSize = 25, kDimBuffer = 5,
                   kDimSubpass = 6;
constexpr uint32_t kMaxNesting = 16;  // of types: a malformed module may contain itself

using Words = std::span<const uint32_t>;

/// One module, taken apart. Messages carry no name; read_interface adds it.
class Module {
public:
    explicit Module(Words words) {
        if (words.size() < kHeaderWords || words[0] != kMagic) throw Error("not a SPIR-V module");
        for (size_t at = kHeaderWords; at < words.size();) {
            const size_t count = words[at] >> 16;
            if (count == 0 || count > words.size() - at)
                throw Error("instruction at word " + std::to_string(at) + " runs past the end of the module");
            read(words[at] & 0xffffu, words.subspan(at + 1, count - 1));
            at += count;
        }
    }

    KernelInterface interface() const;
    std::vector<BlockMember> members() const;

private:
    struct Type {
        uint32_t opcode = 0;
        std::vector<uint32_t> operands;  // after the result id
    };
    struct Entry {
        uint32_t model = 0, id = 0;
    };
    struct Variable {
        uint32_t pointer = 0, storage = 0;
    };
    using Decorations = std::map<uint32_t, uint32_t>;  // decoration to its first operand

    void read(uint32_t opcode, Words operands);
    void read_constant(uint32_t opcode, Words operands);
    const Type& type(uint32_t id) const;
    uint32_t constant(uint32_t id) const;
    std::optional<uint32_t> decorated(uint32_t id, uint32_t what) const;
    std::optional<uint32_t> decorated(uint32_t id, uint32_t member, uint32_t what) const;
    uint64_t extent(uint32_t id, uint32_t depth, std::optional<uint32_t> matrix_stride = {},
                    bool row_major = false) const;
    uint64_t struct_extent(uint32_t id, uint32_t depth) const;
    VkDescriptorType descriptor(const Variable& variable) const;
    std::array<uint32_t, 3> group() const;

    std::map<uint32_t, std::string> names_;
    std::map<std::pair<uint32_t, uint32_t>, std::string> member_names_;
    std::map<uint32_t, Decorations> decorations_;
    std::map<std::pair<uint32_t, uint32_t>, Decorations> member_decorations_;
    std::map<uint32_t, Type> types_;
    std::map<uint32_t, uint32_t> constants_;                // their low words; defaults of specialization constants
    std::map<uint32_t, std::vector<uint32_t>> composites_;  // ids of the parts
    std::map<uint32_t, Variable> variables_;
    std::vector<Entry> entries_;
    std::vector<std::vector<uint32_t>> modes_;  // entry, mode, operands
};

uint32_t word(Words operands, size_t index) {
    if (index >= operands.size()) throw Error("an instruction is too short");
    return operands[index];
}

std::string text(Words operands, size_t first) {
    std::string result;
    for (size_t i = first; i < operands.size(); ++i)
        for (uint32_t shift = 0; shift < 32; shift += 8) {
            const char c = static_cast<char>((operands[i] >> shift) & 0xffu);
            if (c == '\0') return result;
            result += c;
        }
    throw Error("a name does not end");
}

void Module::read(uint32_t opcode, Words o) {
    switch (opcode) {
        case op::kName:
            names_[word(o, 0)] = text(o, 1);
            break;
        case op::kMemberName:
            member_names_[{word(o, 0), word(o, 1)}] = text(o, 2);
            break;
        case op::kEntryPoint:
            entries_.push_back({word(o, 0), word(o, 1)});
            break;
        case op::kExecutionMode:
        case op::kExecutionModeId:
            word(o, 1);
            modes_.emplace_back(o.begin(), o.end());
            break;
        case op::kDecorate:
            decorations_[word(o, 0)][word(o, 1)] = o.size() > 2 ? o[2] : 0;
            break;
        case op::kMemberDecorate:
            member_decorations_[{word(o, 0), word(o, 1)}][word(o, 2)] = o.size() > 3 ? o[3] : 0;
            break;
        case op::kVariable:
            variables_[word(o, 1)] = {word(o, 0), word(o, 2)};
            break;
        case op::kConstant:
        case op::kSpecConstant:
        case op::kConstantComposite:
        case op::kSpecConstantComposite:
            read_constant(opcode, o);
            break;
        default:
            // The types are 19 (void) to 32 (pointer), each with its id first.
            if (opcode >= 19 && opcode <= op::kTypePointer) {
                const uint32_t id = word(o, 0);
                types_[id] = {opcode, {o.begin() + 1, o.end()}};
            }
    }
}

void Module::read_constant(uint32_t opcode, Words o) {
    const uint32_t id = word(o, 1);
    if (opcode == op::kConstant || opcode == op::kSpecConstant)
        constants_[id] = word(o, 2);
    else
        composites_[id].assign(o.begin() + 2, o.end());
}

const Module::Type& Module::type(uint32_t id) const {
    const auto found = types_.find(id);
    if (found == types_.end()) throw Error("id " + std::to_string(id) + " is not a type that can be read");
    return found->second;
}

uint32_t Module::constant(uint32_t id) const {
    const auto found = constants_.find(id);
    if (found == constants_.end()) throw Error("id " + std::to_string(id) + " is not a constant that can be read");
    return found->second;
}

std::optional<uint32_t> Module::decorated(uint32_t id, uint32_t what) const {
    const auto found = decorations_.find(id);
    if (found == decorations_.end() || !found->second.contains(what)) return {};
    return found->second.at(what);
}

std::optional<uint32_t> Module::decorated(uint32_t id, uint32_t member, uint32_t what) const {
    const auto found = member_decorations_.find({id, member});
    if (found == member_decorations_.end() || !found->second.contains(what)) return {};
    return found->second.at(what);
}

/// Bytes of a type as laid out in memory. Matrices are told their stride by the struct they are in.
uint64_t Module::extent(uint32_t id, uint32_t depth, std::optional<uint32_t> matrix_stride, bool row_major) const {
    if (depth > kMaxNesting) throw Error("types are nested too deep");
    const Type& t = type(id);
    const Words o = t.operands;
    switch (t.opcode) {
        case op::kTypeInt:
        case op::kTypeFloat:
            return word(o, 0) / 8;
        case op::kTypeVector:
            return extent(word(o, 0), depth + 1) * word(o, 1);
        case op::kTypeMatrix: {
            const uint64_t lines = row_major ? word(type(word(o, 0)).operands, 1) : word(o, 1);
            if (!matrix_stride) throw Error("a matrix has no stride");
            return lines * *matrix_stride;
        }
        case op::kTypeArray: {
            const std::optional<uint32_t> stride = decorated(id, decoration::kArrayStride);
            if (!stride) throw Error("an array has no stride");
            return static_cast<uint64_t>(*stride) * constant(word(o, 1));
        }
        case op::kTypeStruct:
            return struct_extent(id, depth);
        case op::kTypePointer:
            if (word(o, 0) == storage::kPhysicalStorageBuffer) return 8;
            break;
        default:
            break;
    }
    throw Error("a block has a member without a size");
}

uint64_t Module::struct_extent(uint32_t id, uint32_t depth) const {
    const Type& t = type(id);
    if (t.opcode != op::kTypeStruct) throw Error("a block is not a struct");
    uint64_t end = 0;
    for (uint32_t m = 0; m < t.operands.size(); ++m) {
        const std::optional<uint32_t> offset = decorated(id, m, decoration::kOffset);
        if (!offset) throw Error("a member of a block has no offset");
        const bool row_major = decorated(id, m, decoration::kRowMajor).has_value();
        end = std::max(
            end, *offset + extent(t.operands[m], depth + 1, decorated(id, m, decoration::kMatrixStride), row_major));
    }
    return end;
}

VkDescriptorType Module::descriptor(const Variable& variable) const {
    const Type& pointer = type(variable.pointer);
    if (pointer.opcode != op::kTypePointer) throw Error("a variable is not of pointer type");
    const uint32_t pointee = word(pointer.operands, 1);
    const Type& t = type(pointee);
    if (variable.storage == storage::kStorageBuffer && t.opcode == op::kTypeStruct)
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    if (variable.storage == storage::kUniform && t.opcode == op::kTypeStruct)
        return decorated(pointee, decoration::kBufferBlock) ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                            : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    // Operands of an image: sampled type, dimension, depth, arrayed, multisampled, 1 sampled or 2 storage.
    const bool combined = t.opcode == op::kTypeSampledImage;
    const Type& image = combined ? type(word(t.operands, 0)) : t;
    if (variable.storage == storage::kUniformConstant && image.opcode == op::kTypeImage) {
        const uint32_t dimension = word(image.operands, 1), sampled = word(image.operands, 5);
        const bool texels = dimension == kDimBuffer;
        if (sampled == 1 && texels) return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        if (sampled == 1 && dimension != kDimSubpass)
            return combined ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        if (sampled == 2 && dimension != kDimSubpass && !combined)
            return texels ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    }
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

std::array<uint32_t, 3> Module::group() const {
    std::array<uint32_t, 3> size{1, 1, 1};
    for (const std::vector<uint32_t>& mode : modes_) {
        if (mode[0] != entries_.front().id || (mode[1] != kLocalSize && mode[1] != kLocalSizeId)) continue;
        for (size_t i = 0; i < 3; ++i)
            size[i] = mode[1] == kLocalSize ? word(mode, 2 + i) : constant(word(mode, 2 + i));
    }
    // The older way of specializing the size is a constant decorated as WorkgroupSize; it wins.
    for (const auto& [id, parts] : composites_)
        if (decorated(id, decoration::kBuiltIn) == kWorkgroupSize)
            for (size_t i = 0; i < 3; ++i) size[i] = constant(word(parts, i));
    if (size[0] == 0 || size[1] == 0 || size[2] == 0) throw Error("the workgroup is empty");
    return size;
}

KernelInterface Module::interface() const {
    if (entries_.size() != 1 || entries_.front().model != kGLCompute) throw Error("not one compute entry point");
    KernelInterface result;
    std::map<uint32_t, VkDescriptorType> bindings;
    for (const auto& [id, variable] : variables_) {
        if (variable.storage == storage::kPushConstant) {
            const uint64_t bytes = struct_extent(word(type(variable.pointer).operands, 1), 0);
            if (bytes > 0xffffu) throw Error("the push constants are too large");
            result.push_bytes = std::max(result.push_bytes, static_cast<uint32_t>((bytes + 3) / 4 * 4));
        }
        if (variable.storage != storage::kUniformConstant && variable.storage != storage::kUniform &&
            variable.storage != storage::kStorageBuffer)
            continue;
        const std::optional<uint32_t> binding = decorated(id, decoration::kBinding);
        const std::string label = names_.contains(id) && !names_.at(id).empty() ? "'" + names_.at(id) + "'"
                                                                                : "variable " + std::to_string(id);
        if (!binding) throw Error(label + " has no binding");
        if (decorated(id, decoration::kDescriptorSet).value_or(0) != 0) throw Error(label + " lies outside set 0");
        const VkDescriptorType kind = descriptor(variable);
        if (kind == VK_DESCRIPTOR_TYPE_MAX_ENUM)
            throw Error("binding " + std::to_string(*binding) + " is of a kind the engine does not use");
        if (!bindings.emplace(*binding, kind).second)
            throw Error("binding " + std::to_string(*binding) + " is used twice");
    }
    for (const auto& [binding, kind] : bindings) {
        if (binding != result.bindings.size())
            throw Error("binding " + std::to_string(result.bindings.size()) + " is missing");
        result.bindings.push_back(kind);
    }
    result.group = group();
    return result;
}

std::vector<BlockMember> Module::members() const {
    std::vector<BlockMember> result;
    for (const auto& [key, decorations] : member_decorations_) {
        const auto offset = decorations.find(decoration::kOffset);
        const auto block = names_.find(key.first);
        const auto member = member_names_.find(key);
        if (offset == decorations.end() || block == names_.end() || member == member_names_.end()) continue;
        if (!block->second.empty() && !member->second.empty())
            result.push_back({block->second, member->second, offset->second});
    }
    return result;
}

}  // namespace

KernelInterface read_interface(const std::string& name, std::span<const uint32_t> spirv) {
    try {
        KernelInterface result = Module(spirv).interface();
        result.name = name;
        return result;
    } catch (const Error& error) {
        throw Error("shader '" + name + "': " + error.what());
    }
}

std::vector<BlockMember> block_members(std::span<const uint32_t> spirv) { return Module(spirv).members(); }

}  // namespace vesper::gpu
