// Rules of glTF 2.0 that a file may break without harm to its scene: noted, each with its place. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/lower.h"
#include "io/atomic_file.h"
#include "io/image_file.h"
#include "scene/gltf_reader.h"
#include "scene/gltf_rules.h"
#include "scene/uri.h"

namespace vesper {
namespace {

using nlohmann::json;

constexpr size_t kMostNotes = 100;
constexpr size_t kMostAlike = 10;  // places that are named for one kind of break; the others are counted

const std::string kMore = "breaks a rule of glTF 2.0 in more places: ";

/// What a key outside of extensions names one of, or several.
const std::map<std::string, const char*, std::less<>> kReferences{
    {"bufferView", "bufferViews"}, {"buffer", "buffers"}, {"source", "images"},   {"index", "textures"}, {"scene", "scenes"},     {"camera", "cameras"},
    {"mesh", "meshes"},            {"skin", "skins"},     {"joints", "nodes"},    {"nodes", "nodes"},    {"children", "nodes"},   {"skeleton", "nodes"},
    {"node", "nodes"},             {"material", "materials"}, {"input", "accessors"}, {"output", "accessors"}, {"inverseBindMatrices", "accessors"}};

/// A property that elements of a list must have where they have another.
struct Needed {
    const char *list, *key, *with;
};
constexpr Needed kNeeded[]{{"accessors", "bufferView", "byteOffset"}, {"images", "mimeType", "bufferView"}, {"nodes", "mesh", "skin"}, {"nodes", "mesh", "weights"}};

class Rules {
public:
    explicit Rules(GltfReader& reader) : reader_(reader), lists_(reader.document.root().json()) {}

    void check() {
        for (const std::string& broken : reader_.document.broken_rules()) note("", broken);
        walk(lists_.root(), "");
        objects();
        check_schema(lists_, take_note_);
        needed();
        check_required_extensions(lists_, take_note_);
        lists_.each("buffers", [&](const json& b, const std::string& at, uint32_t) { uri(b, at, {"application/octet-stream", "application/gltf-buffer"}); });
        const std::vector<AccessorUse> uses = check_uses(lists_, take_note_);
        check_accessors(reader_, lists_, uses, take_note_);
        check_primitives(lists_, take_note_);
        lists_.each("images", [&](const json& p, const std::string& at, uint32_t i) { image(p, at, i); });
        lists_.each("nodes", [&](const json& n, const std::string& at, uint32_t) { node(n, at); });
        roots();
        check_cameras(lists_, take_note_);
        check_animations(lists_, take_note_);
        check_skins(lists_, take_note_);
    }

private:
    // The first places of each kind; then their number.
    void note(const std::string& at, const std::string& what) {
        const auto found = alike_.find(what);
        if (found == alike_.end() && lines_ >= kMostNotes) return;
        const size_t alike = ++(found == alike_.end() ? alike_[what] : found->second);
        if (alike > kMostAlike + 1) return reader_.notes.add(kMore + what);
        if (++lines_ <= kMostNotes) reader_.notes.add(alike > kMostAlike ? kMore + what : "breaks a rule of glTF 2.0: " + (at.empty() ? "" : at + ": ") + what);
    }
    /// Whether an extension brings other kinds of pictures.
    bool extended_pictures() const { return lists_.uses("KHR_texture_basisu") || lists_.uses("MSFT_texture_dds") || lists_.uses("EXT_texture_", true); }

    // Extensions, empty lists, and references to what is not there, wherever they are.
    void walk(const json& value, const std::string& at, bool inside_extension = false) {
        if (value.is_array() && value.empty() && !inside_extension) return note(at, "is empty");
        for (const auto& [key, member] : value.items()) {
            if (key == "extras") continue;
            const std::string here = at + "/" + key;
            if (key == "extensions" && value.is_object()) {
                if (member.is_object()) check_extensions(lists_, member, at, take_note_);
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
        if (to.is_number() && whole_number(to).value_or(UINT64_MAX) >= lists_.count(list)) note(at, "names none of the " + std::to_string(lists_.count(list)) + " " + list);
        if (to.is_array() && list == std::string_view("nodes"))
            for (size_t i = 0; i < to.size(); ++i) refer(to[i], at + "/" + std::to_string(i), list);
    }
    void objects() {
        for (const char* list : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
            const json& elements = array_member(lists_.root(), list);
            for (size_t i = 0; i < elements.size(); ++i)
                if (!elements[i].is_object()) note("/" + std::string(list) + "/" + std::to_string(i), "is no object");
        }
    }
    void needed() {
        for (const Needed& rule : kNeeded)
            lists_.each(rule.list, [&](const json& element, const std::string& at, uint32_t) {
                if (element.contains(rule.with) && !element.contains(rule.key)) note(at, "has no " + std::string(rule.key) + " to its " + rule.with);
            });
    }

    // A data URI has one of these types and is whole; other URIs name files.
    void uri(const json& holder, const std::string& at, std::initializer_list<std::string_view> types) {
        const auto found = holder.find("uri");
        if (found == holder.end() || !found->is_string()) return;
        const std::string& text = found->get_ref<const std::string&>();
        if (is_data_uri(text)) {
            const size_t comma = text.find(',');
            if (comma == text.npos) return;  // refused, or noted where it is read
            const std::string head = lower(std::string_view(text).substr(0, comma)), type = head.substr(5, head.find(';') - 5);
            for (size_t i = head.find(';'); i != head.npos;) {  // parameters have values, but for the last
                const size_t next = head.find(';', i + 1);
                const std::string_view parameter = std::string_view(head).substr(i + 1, next - i - 1);
                if (parameter.find('=') == parameter.npos && !(parameter == "base64" && next == head.npos)) note(at + "/uri", "has a type with a parameter that has no value");
                i = next;
            }
            if (std::find(types.begin(), types.end(), type) == types.end() && !(type.starts_with("image/") && extended_pictures())) note(at + "/uri", "has data of the type '" + one_line(type, 60) + "'");
            if (text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=", comma + 1) != text.npos)
                note(at + "/uri", "has data that are not base64");
        } else if (text.find(':') < text.find('/') || text.find_first_of(" \\<>\"^`{|}") != text.npos || text.starts_with('/')) {
            note(at + "/uri", "is no relative URI");
        }
    }

    void image(const json& i, const std::string& at, uint32_t index) {
        if (i.contains("uri") == i.contains("bufferView")) note(at, "has not either a uri or a buffer view");
        uri(i, at, {"image/png", "image/jpeg"});
        if (const json* view = lists_.named(i, "bufferView", "bufferViews"); view && view->contains("byteStride")) note(at, "lies in a buffer view with a stride");
        std::string type;
        if (index < reader_.image_of.size() && reader_.image_of[index] != kUnread) {
            type = reader_.image_types[index];
        } else {
            try {
                const std::vector<uint8_t> bytes = reader_.document.image(index);
                type = media_type(bytes);
                if (type == "image/png" || type == "image/jpeg" || !extended_pictures()) check_image(bytes, reader_.limits.image_side, reader_.limits.texels);
            } catch (const Error& error) {
                return note(at, error.what());
            }
        }
        const std::string_view stated = text_member(i, "mimeType"), text = text_member(i, "uri");
        if (type.empty()) return;
        if (!stated.empty() && stated != type) note(at + "/mimeType", "is not that of the picture, which is " + type);
        if (const std::string head = lower(text.substr(0, 5 + type.size())); head.starts_with("data:image/") && !head.ends_with(type)) note(at + "/uri", "has not the type of the picture, which is " + type);
    }

    void node(const json& n, const std::string& at) {
        if (n.contains("matrix") && (n.contains("translation") || n.contains("rotation") || n.contains("scale"))) note(at, "has a matrix and its parts");
        if (const json& m = array_member(n, "matrix"); m.size() == 16 && !decomposes(m)) note(at + "/matrix", "is no translation, rotation and scale");
        if (const auto q = n.find("rotation"); q != n.end() && q->is_array() && q->size() == 4) {
            double sum = 0;
            for (const json& part : *q) sum += part.is_number() ? part.get<double>() * part.get<double>() : 0;
            if (std::abs(std::sqrt(sum) - 1) > 0.01) note(at + "/rotation", "is no unit quaternion");
        }
        const json* mesh = lists_.named(n, "mesh", "meshes");
        if (!mesh || !mesh->contains("primitives") || !(*mesh)["primitives"].is_array()) return;
        for (const json& primitive : (*mesh)["primitives"]) {
            if (!primitive.is_object()) continue;
            if (n.contains("skin") && !(primitive.contains("attributes") && primitive["attributes"].is_object() && primitive["attributes"].contains("JOINTS_0"))) return note(at + "/skin", "is that of a mesh without joints");
            const size_t targets = primitive.contains("targets") && primitive["targets"].is_array() ? primitive["targets"].size() : 0;
            if (n.contains("weights") && n["weights"].is_array() && n["weights"].size() != targets) return note(at + "/weights", "are not one for each of the " + std::to_string(targets) + " targets of its mesh");
        }
    }

    // Whether the columns of a matrix stand square on one another, and none is zero.
    static bool decomposes(const json& m) {
        double v[16];
        for (size_t i = 0; i < 16; ++i) {
            if (!m[i].is_number()) return true;  // noted as such
            v[i] = m[i].get<double>();
        }
        const auto dot = [&](int a, int b) { return v[4 * a] * v[4 * b] + v[4 * a + 1] * v[4 * b + 1] + v[4 * a + 2] * v[4 * b + 2]; };
        for (int a = 0; a < 3; ++a)
            if (!(dot(a, a) > 0) || std::abs(dot(a, (a + 1) % 3)) > 1e-4 * std::sqrt(dot(a, a) * dot((a + 1) % 3, (a + 1) % 3))) return false;
        return v[3] == 0 && v[7] == 0 && v[11] == 0 && v[15] == 1;
    }

    // Scenes list nodes that hang on no other.
    void roots() {
        std::vector<bool> child(lists_.count("nodes"));
        const auto mark = [&](const json& n, const std::string&, uint32_t) {
            if (n.contains("children") && n["children"].is_array())
                for (const json& c : n["children"])
                    if (const auto which = whole_number(c); which && *which < child.size()) child[*which] = true;
        };
        lists_.each("nodes", mark);
        lists_.each("scenes", [&](const json& s, const std::string& at, uint32_t) {
            if (s.contains("nodes") && s["nodes"].is_array())
                for (const json& n : s["nodes"])
                    if (const auto which = whole_number(n); which && *which < child.size() && child[*which]) note(at, "lists a node that hangs on another");
        });
    }

    GltfReader& reader_;
    const GltfLists lists_;
    const RuleNote take_note_ = [this](const std::string& at, const std::string& what) { note(at, what); };
    std::map<std::string, size_t> alike_;  // by what is wrong
    size_t lines_ = 0;
};

}  // namespace

void note_broken_rules(GltfReader& reader) { Rules(reader).check(); }

}  // namespace vesper
