// SPDX-License-Identifier: MIT
#include "io/exr_layers.h"

#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfPartType.h>

#include "base/error.h"
#include "base/lower.h"

namespace vesper::io::hdr {
namespace {

/// The channels of a layer by the words for them.
class ChannelNames {
public:
    /// `local`: a name without that of the layer. In the order of a file: of R and r, R counts.
    void add(const std::string& local) {
        exact_.insert(local);
        by_word_.try_emplace(lower(local), local);
    }
    bool has(const char* standard) const { return exact_.contains(standard); }
    bool has_word(const char* word) const { return by_word_.contains(word); }
    /// The name of the first word that there is, or the standard one, which no channel may have.
    std::string of(std::initializer_list<const char*> words, const char* standard) const {
        if (has(standard)) return standard;
        for (const char* word : words)
            if (const auto found = by_word_.find(word); found != by_word_.end()) return found->second;
        return standard;
    }

private:
    std::set<std::string, std::less<>> exact_;
    std::map<std::string, std::string, std::less<>> by_word_;  // in small letters
};

/// The picture of a layer: kind and local names of channels; nothing where there is none.
std::optional<ExrLayer> picture_of(const ChannelNames& names) {
    using Kind = ExrLayer::Kind;
    const auto one_of = [&](const char* letter, const char* word) {
        return names.has_word(letter) || names.has_word(word);
    };
    ExrLayer layer;
    if (names.has("R") || names.has("G") || names.has("B") ||
        (one_of("r", "red") && one_of("g", "green") && one_of("b", "blue"))) {
        layer.channels = {names.of({"r", "red"}, "R"), names.of({"g", "green"}, "G"), names.of({"b", "blue"}, "B")};
        return layer;
    }
    const bool vector = names.has_word("x") || names.has_word("z");
    if (!names.has("Y") && !names.has_word("luminance") && !(names.has_word("y") && !vector)) return std::nullopt;
    if (names.has("X") && names.has("Y") && names.has("Z")) {
        layer.kind = Kind::Xyz, layer.channels = {"X", "Y", "Z"};
        return layer;
    }
    layer.kind = names.has_word("ry") || names.has_word("by") ? Kind::Chroma : Kind::Grey;
    layer.channels = {vector ? names.of({"luminance"}, "Y") : names.of({"luminance", "y"}, "Y"), names.of({"ry"}, "RY"),
                      names.of({"by"}, "BY")};
    return layer;
}

std::vector<ExrLayer> layers_of(const Imf::MultiPartInputFile& file) {
    std::vector<ExrLayer> found;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& exr = file.header(part);
        if (exr.hasType() && Imf::isDeepData(exr.type())) continue;
        const std::string part_name = file.parts() > 1 && exr.hasName() ? exr.name() : "";
        std::map<std::string, ChannelNames> layers;
        for (auto it = exr.channels().begin(); it != exr.channels().end(); ++it) {
            const std::string whole = it.name();
            const size_t dot = whole.rfind('.');
            const bool in_layer = dot != whole.npos && dot > 0;
            layers[in_layer ? whole.substr(0, dot) : ""].add(in_layer ? whole.substr(dot + 1) : whole);
        }
        for (const auto& [name, names] : layers) {
            std::optional<ExrLayer> layer = picture_of(names);
            if (!layer) continue;
            layer->part = part;
            layer->prefix = name.empty() ? "" : name + ".";
            layer->name = part_name + (part_name.empty() || name.empty() ? "" : ".") + name;
            layer->vector = layer->kind == ExrLayer::Kind::Xyz && !layer->name.empty();
            for (std::string& channel : layer->channels) channel = layer->prefix + channel;
            found.push_back(std::move(*layer));
        }
    }
    return found;
}

/// "a, b, c": no more than a message takes.
class List {
public:
    void add(const std::string& name) {
        if (text_.size() < 200) text_ += (text_.empty() ? "" : ", ") + name;
    }
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

[[noreturn]] void fail_without_pictures(const Imf::MultiPartInputFile& file) {
    List names;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& exr = file.header(part);
        if (exr.hasType() && Imf::isDeepData(exr.type())) throw Error("OpenEXR: deep pictures are not read");
        for (auto it = exr.channels().begin(); it != exr.channels().end(); ++it) names.add(it.name());
    }
    throw Error("OpenEXR: no channels R, G, B or Y of a picture; it has " + names.text());
}

}  // namespace

ExrLayer choose_layer(const Imf::MultiPartInputFile& file, const std::string& wanted) {
    std::vector<ExrLayer> layers = layers_of(file);
    if (wanted.empty()) std::erase_if(layers, [](const ExrLayer& layer) { return layer.vector; });
    if (layers.empty()) fail_without_pictures(file);
    List names;
    for (const ExrLayer& layer : layers) {
        const bool whole_first = layer.part == 0 && layer.prefix.empty();
        if (wanted.empty() ? whole_first || layers.size() == 1 : layer.name == wanted || layer.prefix == wanted + ".")
            return layer;
        if (!layer.name.empty()) names.add(layer.name);
    }
    if (wanted.empty()) throw Error("OpenEXR: several layers: choose one of " + names.text());
    throw Error("OpenEXR: no layer " + wanted + (names.text().empty() ? "; it has none" : "; it has " + names.text()));
}

}  // namespace vesper::io::hdr
