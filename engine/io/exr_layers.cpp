// SPDX-License-Identifier: MIT
#include "io/exr_layers.h"

#include <set>
#include <vector>

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfPartType.h>

#include "base/error.h"

namespace vesper::io::hdr {
namespace {

std::vector<ExrLayer> layers_of(const Imf::MultiPartInputFile& file) {
    std::vector<ExrLayer> found;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& exr = file.header(part);
        if (exr.hasType() && Imf::isDeepData(exr.type())) continue;
        const Imf::ChannelList& channels = exr.channels();
        const std::string part_name = file.parts() > 1 && exr.hasName() ? exr.name() : "";
        std::set<std::string> names;
        channels.layers(names);
        names.insert("");
        for (const std::string& name : names) {
            const std::string prefix = name.empty() ? "" : name + ".";
            const auto has = [&](const char* channel) { return channels.findChannel(prefix + channel) != nullptr; };
            using Kind = ExrLayer::Kind;
            const bool colour = has("R") || has("G") || has("B");
            if (!colour && !has("Y")) continue;
            const Kind kind = colour                   ? Kind::Colour
                              : has("X") && has("Z")   ? Kind::Xyz
                              : has("RY") || has("BY") ? Kind::Chroma
                                                       : Kind::Grey;
            const std::string whole = part_name + (part_name.empty() || name.empty() ? "" : ".") + name;
            found.push_back({part, prefix, whole, kind == Kind::Xyz && !whole.empty(), kind});
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
