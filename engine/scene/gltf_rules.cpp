// Rules of glTF 2.0 that a file may break without harm to its scene: noted, each with its place. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "io/image_file.h"
#include "scene/gltf_reader.h"
#include "scene/gltf_rules.h"

namespace vesper {
namespace {

// A number that is whole, also where it is written as 1.0.
std::optional<uint64_t> whole_number(const nlohmann::json& value) {
    if (value.is_number_unsigned()) return value.get<uint64_t>();
    if (!value.is_number_float()) return {};
    const double number = value.get<double>();
    return number >= 0 && number < 9e15 && number == std::floor(number) ? std::optional(uint64_t(number)) : std::nullopt;
}

using nlohmann::json;

constexpr size_t kMostNotes = 100;
constexpr uint64_t kMostNumbers = 1'000'000;  // of all accessors, that are compared with what is stated of them: large files are read once only

/// What a key outside of extensions names one of, or several.
const std::map<std::string, const char*, std::less<>> kReferences{
    {"bufferView", "bufferViews"}, {"buffer", "buffers"}, {"source", "images"},   {"index", "textures"}, {"scene", "scenes"},     {"camera", "cameras"},
    {"mesh", "meshes"},            {"skin", "skins"},     {"joints", "nodes"},    {"nodes", "nodes"},    {"children", "nodes"},   {"skeleton", "nodes"},
    {"node", "nodes"},             {"material", "materials"}, {"input", "accessors"}, {"output", "accessors"}, {"inverseBindMatrices", "accessors"}};

/// A property that elements of a list must have, in general or where they have another.
struct Needed {
    const char *list, *key, *with;
};
constexpr Needed kNeeded[]{{"accessors", "componentType", nullptr}, {"accessors", "count", nullptr}, {"accessors", "type", nullptr},
                           {"accessors", "bufferView", "byteOffset"}, {"bufferViews", "buffer", nullptr}, {"bufferViews", "byteLength", nullptr},
                           {"buffers", "byteLength", nullptr},      {"images", "mimeType", "bufferView"}, {"nodes", "mesh", "skin"},
                           {"nodes", "mesh", "weights"}};

class Rules {
public:
    explicit Rules(GltfReader& reader) : reader_(reader), root_(reader.document.root().json()) {}

    void check() {
        for (const std::string& broken : reader_.document.broken_rules()) note("", broken);
        walk(root_, "");
        objects();
        needed();
        check_required_extensions(root_, take_note_);
        each("buffers", [&](const json& b, const std::string& at, uint32_t) {
            if (b.contains("byteLength") && b["byteLength"] == 0) note(at, "is empty");
            uri(b, at, {"application/octet-stream", "application/gltf-buffer"});
        });
        each("accessors", [&](const json& a, const std::string& at, uint32_t i) { accessor(a, at, i); });
        each("images", [&](const json& p, const std::string& at, uint32_t i) { image(p, at, i); });
        each("nodes", [&](const json& n, const std::string& at, uint32_t) { node(n, at); });
        roots();
    }

private:
    void note(const std::string& at, const std::string& what) {
        if (++notes_ <= kMostNotes) reader_.notes.add("breaks a rule of glTF 2.0: " + (at.empty() ? "" : at + ": ") + what);
    }
    size_t count(const char* list) const { return root_.contains(list) && root_[list].is_array() ? root_[list].size() : 0; }

    template <class See>
    void each(const char* list, const See& see) {
        for (size_t i = 0; i < count(list); ++i)
            if (const json& element = root_[list][i]; element.is_object()) see(element, "/" + std::string(list) + "/" + std::to_string(i), static_cast<uint32_t>(i));
    }
    static uint64_t whole(const json& holder, const char* key, uint64_t otherwise = 0) {
        const auto found = holder.find(key);
        return found != holder.end() ? whole_number(*found).value_or(otherwise) : otherwise;
    }
    /// Whether an extension brings other kinds of pictures.
    bool extended_pictures() const {
        const json used = root_.value("extensionsUsed", json::array());
        return used.is_array() && std::any_of(used.begin(), used.end(), [](const json& e) {
            return e == "KHR_texture_basisu" || e == "MSFT_texture_dds" || (e.is_string() && e.get_ref<const std::string&>().starts_with("EXT_texture_"));
        });
    }
    /// The element of a list that a key names, if there is one.
    const json* named(const json& holder, const char* key, const char* list) const {
        const uint64_t i = whole(holder, key, UINT64_MAX);
        return i < count(list) && root_[list][i].is_object() ? &root_[list][i] : nullptr;
    }

    // Extensions, empty lists, and references to what is not there, wherever they are.
    void walk(const json& value, const std::string& at, bool inside_extension = false) {
        if (value.is_array() && value.empty() && !inside_extension) return note(at, "is empty");
        for (const auto& [key, member] : value.items()) {
            if (key == "extras") continue;
            const std::string here = at + "/" + key;
            if (key == "extensions" && value.is_object()) {
                if (member.is_object()) check_extensions(root_, member, at, take_note_);
                walk(member, here, true);
                continue;
            }
            if (inside_extension) {  // whose members have meanings of their own
                if (member.is_structured()) walk(member, here, true);
                continue;
            }
            if (const auto reference = kReferences.find(key); value.is_object() && reference != kReferences.end()) refer(member, here, reference->second);
            if (member.is_structured()) walk(member, here);
        }
    }
    void refer(const json& to, const std::string& at, const char* list) {
        if (to.is_number() && whole_number(to).value_or(UINT64_MAX) >= count(list)) note(at, "names none of the " + std::to_string(count(list)) + " " + list);
        if (to.is_array() && list == std::string_view("nodes"))
            for (size_t i = 0; i < to.size(); ++i) refer(to[i], at + "/" + std::to_string(i), list);
    }
    void objects() {
        for (const char* list : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"})
            for (size_t i = 0; i < count(list); ++i)
                if (!root_[list][i].is_object()) note("/" + std::string(list) + "/" + std::to_string(i), "is no object");
    }
    void needed() {
        for (const Needed& rule : kNeeded)
            each(rule.list, [&](const json& element, const std::string& at, uint32_t) {
                if (!element.contains(rule.key) && (!rule.with || element.contains(rule.with))) note(at, "has no " + std::string(rule.key) + (rule.with ? std::string(" to its ") + rule.with : ""));
            });
    }

    // A data URI has one of these types and is whole; other URIs name files.
    void uri(const json& holder, const std::string& at, std::initializer_list<std::string_view> types) {
        const auto found = holder.find("uri");
        if (found == holder.end() || !found->is_string()) return;
        const std::string& text = found->get_ref<const std::string&>();
        if (text.starts_with("data:")) {
            const std::string_view head = std::string_view(text).substr(0, text.find(','));
            const std::string_view type = head.substr(5, head.find(';') - 5);
            for (size_t i = head.find(';'); i != head.npos;) {  // parameters have values, but for the last
                const size_t next = head.find(';', i + 1);
                const std::string_view parameter = head.substr(i + 1, next - i - 1);
                if (parameter.find('=') == parameter.npos && !(parameter == "base64" && next == head.npos)) note(at + "/uri", "has a type with a parameter that has no value");
                i = next;
            }
            if (std::find(types.begin(), types.end(), type) == types.end() && !(type.starts_with("image/") && extended_pictures())) note(at + "/uri", "has data of the type '" + std::string(type) + "'");
            if (const size_t comma = text.find(','); comma != text.npos && text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=", comma + 1) != text.npos)
                note(at + "/uri", "has data that are not base64");
        } else if (text.find(':') < text.find('/') || text.find_first_of(" \\<>\"^`{|}") != text.npos || text.starts_with('/')) {
            note(at + "/uri", "is no relative URI");
        }
    }

    void accessor(const json& a, const std::string& at, uint32_t index) {
        static const std::map<uint64_t, uint64_t> kSizes{{5120, 1}, {5121, 1}, {5122, 2}, {5123, 2}, {5125, 4}, {5126, 4}};
        static const std::map<std::string, uint64_t> kColumns{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 2}, {"MAT3", 3}, {"MAT4", 4}};
        const uint64_t component = whole(a, "componentType"), elements = whole(a, "count");
        const auto size = kSizes.find(component);
        const auto type = kColumns.find(a.contains("type") && a["type"].is_string() ? a["type"].get<std::string>() : "");
        if (size == kSizes.end() || type == kColumns.end()) return;  // noted as missing, or refused where it is read
        if (a.value("normalized", json()) == true && (component == 5125 || component == 5126)) note(at, "is normalized, which numbers of its type cannot be");
        if (a.contains("sparse") && a["sparse"].is_object() && whole(a["sparse"], "count") > elements) note(at + "/sparse/count", "is more than the " + std::to_string(elements) + " elements there are");
        if (a.contains("sparse") && a["sparse"].is_object())
            for (const char* part : {"indices", "values"})
                if (a["sparse"].contains(part) && a["sparse"][part].is_object())
                    if (const json* view = named(a["sparse"][part], "bufferView", "bufferViews"); view && view->contains("byteStride")) note(at + "/sparse/" + part, "lies in a buffer view with a stride");
        const json* view = named(a, "bufferView", "bufferViews");
        if (!view) return;
        // Columns of matrices begin at multiples of four.
        const bool matrix = type->first.starts_with("MAT");
        const uint64_t column = type->second * size->second, padded = matrix ? (column + 3) / 4 * 4 * type->second : column;
        const uint64_t offset = whole(a, "byteOffset"), stride = whole(*view, "byteStride", padded), bytes = whole(*view, "byteLength");
        if (offset % (matrix ? 4 : size->second) != 0 || (offset + whole(*view, "byteOffset")) % size->second != 0) note(at, "does not begin at a multiple of the size of its numbers");
        if (stride < padded || (view->contains("byteStride") && (stride % 4 != 0 || stride > 252))) note(at, "lies in a buffer view with a stride of " + std::to_string(stride) + " bytes");
        if (elements > 0 && elements < UINT32_MAX && stride <= UINT32_MAX && offset <= bytes && (elements - 1) * stride + padded - (matrix ? (4 - column % 4) % 4 : 0) > bytes - offset) note(at, "reaches beyond its buffer view");
        const uint64_t buffer = whole(*view, "buffer", UINT64_MAX);
        if (!matrix && buffer < count("buffers") && reader_.document.has_bytes(uint32_t(buffer))) limits(a, at, index, type->first, elements * type->second);
    }

    // What is stated of the numbers of an accessor, and that they are numbers.
    void limits(const json& a, const std::string& at, uint32_t index, const std::string& type, uint64_t numbers) {
        if (a.value("normalized", json()) == true || numbers > kMostNumbers || (numbers_ += numbers) > kMostNumbers) return;
        Floats floats;
        try {
            const JsonFile reference{"", json(index)};
            floats = read_floats(reader_.document, JsonValue(reference), {type}, kMostNumbers);
        } catch (const Error& error) {
            return note(at, error.what());
        }
        for (size_t c = 0; c < floats.components; ++c) {
            float least = INFINITY, most = -INFINITY;
            for (size_t i = c; i < floats.values.size(); i += floats.components) {
                if (!std::isfinite(floats.values[i])) return note(at, "holds numbers that are not finite");
                least = std::min(least, floats.values[i]), most = std::max(most, floats.values[i]);
            }
            for (const auto& [key, found] : {std::pair{"min", least}, std::pair{"max", most}})
                if (a.contains(key) && a[key].is_array() && c < a[key].size() && a[key][c].is_number() && a[key][c].get<float>() != found)
                    return note(at + "/" + key, "is not that of its numbers");
        }
    }

    void image(const json& i, const std::string& at, uint32_t index) {
        if (i.contains("uri") == i.contains("bufferView")) note(at, "has not either a uri or a buffer view");
        uri(i, at, {"image/png", "image/jpeg"});
        if (const json* view = named(i, "bufferView", "bufferViews"); view && view->contains("byteStride")) note(at, "lies in a buffer view with a stride");
        if (index < reader_.image_of.size() && reader_.image_of[index] != kUnread) return;
        try {
            const std::vector<uint8_t> bytes = reader_.document.image(index);
            const std::string type = media_type(bytes);
            if (type == "image/png" || type == "image/jpeg" || !extended_pictures()) check_image(bytes, reader_.limits.image_side, reader_.limits.texels);
        } catch (const Error& error) {
            note(at, error.what());
        }
    }

    void node(const json& n, const std::string& at) {
        if (n.contains("matrix") && (n.contains("translation") || n.contains("rotation") || n.contains("scale"))) note(at, "has a matrix and its parts");
        if (const auto q = n.find("rotation"); q != n.end() && q->is_array() && q->size() == 4) {
            double sum = 0;
            for (const json& part : *q) sum += part.is_number() ? part.get<double>() * part.get<double>() : 0;
            if (std::abs(std::sqrt(sum) - 1) > 0.01) note(at + "/rotation", "is no unit quaternion");
        }
        const json* mesh = named(n, "mesh", "meshes");
        if (!mesh || !mesh->contains("primitives") || !(*mesh)["primitives"].is_array()) return;
        for (const json& primitive : (*mesh)["primitives"]) {
            if (!primitive.is_object()) continue;
            if (n.contains("skin") && !(primitive.contains("attributes") && primitive["attributes"].is_object() && primitive["attributes"].contains("JOINTS_0"))) return note(at + "/skin", "is that of a mesh without joints");
            const size_t targets = primitive.contains("targets") && primitive["targets"].is_array() ? primitive["targets"].size() : 0;
            if (n.contains("weights") && n["weights"].is_array() && n["weights"].size() != targets) return note(at + "/weights", "are not one for each of the " + std::to_string(targets) + " targets of its mesh");
        }
    }

    // Scenes list nodes that hang on no other.
    void roots() {
        std::vector<bool> child(count("nodes"));
        const auto mark = [&](const json& n, const std::string&, uint32_t) {
            if (n.contains("children") && n["children"].is_array())
                for (const json& c : n["children"])
                    if (const auto which = whole_number(c); which && *which < child.size()) child[*which] = true;
        };
        each("nodes", mark);
        each("scenes", [&](const json& s, const std::string& at, uint32_t) {
            if (s.contains("nodes") && s["nodes"].is_array())
                for (const json& n : s["nodes"])
                    if (const auto which = whole_number(n); which && *which < child.size() && child[*which]) note(at, "lists a node that hangs on another");
        });
    }

    GltfReader& reader_;
    const json& root_;
    const RuleNote take_note_ = [this](const std::string& at, const std::string& what) { note(at, what); };
    size_t notes_ = 0;
    uint64_t numbers_ = 0;
};

}  // namespace

void note_broken_rules(GltfReader& reader) { Rules(reader).check(); }

}  // namespace vesper
