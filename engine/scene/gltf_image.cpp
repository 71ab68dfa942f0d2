// Pictures of a glTF file, and textures that name several of them. SPDX-License-Identifier: MIT
#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/image_file.h"
#include "scene/gltf_reader.h"
#include "scene/uri.h"

namespace vesper::scene {
namespace {

/// Extensions by which a texture names a picture of another format; its own `source` is then the fallback.
constexpr const char* kPictureExtensions[]{"EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu",
                                           "MSFT_texture_dds"};

constexpr size_t kMostNamed = 16;  // pictures that notes name

std::string name_of_image(const JsonValue& entry, uint32_t index) {
    const auto uri = entry.find("uri");
    const bool named = uri && uri->text().size() < 256 && !is_data_uri(uri->text());
    return entry.text_or("name", named ? uri->text() : "image " + std::to_string(index));
}

/// The pixels of a picture. Throws Error, UnreadFile where the picture is not there, or is damaged or of another
/// format.
Image pixels_of(GltfReader& reader, uint32_t index, const JsonValue& entry) {
    const std::vector<uint8_t> bytes = reader.document.image(index);
    const auto unread = [&](const std::string& reason) { return UnreadFile(entry.place() + ": " + reason, reason); };
    const std::string type = io::media_type(bytes);
    if (!type.empty() && type != "image/png" && type != "image/jpeg" && !(type == "image/webp" && io::reads_webp()))
        throw unread("of type " + type + ", which is not read");
    try {
        Image image = io::decode_image(bytes, reader.limits.image_side, reader.limits.texels - reader.texels);
        if (io::is_16_bit_png(bytes))
            reader.notes.add("a picture of 16 bits is read at 8: below 0.01 its values are coarse");
        return image;
    } catch (const OutOfHostMemory&) {
        throw;
    } catch (const OverLimit& error) {
        entry.fail(error.what());
    } catch (const Error& error) {
        throw unread(error.what());
    }
}

uint32_t read_image(GltfReader& reader, uint32_t index) {
    if (reader.image_of[index] != kUnread) return reader.image_of[index];
    const JsonValue entry = reader.document.list("images")[index];
    try {
        Image image = pixels_of(reader, index, entry);
        reader.texels += static_cast<uint64_t>(image.width) * image.height;
        image.name = name_of_image(entry, index);
        reader.scene.images.push_back(std::move(image));
        return reader.image_of[index] = static_cast<uint32_t>(reader.scene.images.size() - 1);
    } catch (const UnreadFile& error) {
        reader.unread_images[index] = error.reason;
        return reader.image_of[index] = kNone;
    }
}

/// Indices of the pictures that a texture names, the preferred first.
std::vector<uint32_t> pictures_of(GltfReader& reader, const JsonValue& texture) {
    const size_t images = reader.document.list("images").size();
    std::vector<uint32_t> found;
    if (const auto extensions = texture.find("extensions"))
        for (const char* name : kPictureExtensions)
            if (const auto extension = extensions->find(name))
                if (const auto source = extension->find("source")) found.push_back(source->index(images, "images"));
    if (const auto source = texture.find("source")) found.push_back(source->index(images, "images"));
    return found;
}

void note_unread(GltfReader& reader, uint32_t index, const char* instead) {
    if (reader.unread_images.size() > kMostNamed)
        return reader.notes.add(std::string("a further picture cannot be read: ") + instead);
    const JsonValue entry = reader.document.list("images")[index];
    reader.notes.add("picture " + one_line(name_of_image(entry, index), 80) + " cannot be read (" +
                     one_line(reader.unread_images[index], 140) + "): " + instead);
}

}  // namespace

uint32_t read_picture(GltfReader& reader, uint32_t texture) {
    const std::vector<uint32_t> pictures = pictures_of(reader, reader.document.list("textures")[texture]);
    uint32_t shown = kNone;
    size_t tried = 0;
    for (; tried < pictures.size() && shown == kNone; ++tried) shown = read_image(reader, pictures[tried]);
    const char* instead =
        shown == kNone ? "its material shows its factors instead" : "the fallback of its texture is shown";
    for (size_t i = 0; i < tried - (shown != kNone); ++i) note_unread(reader, pictures[i], instead);
    if (pictures.empty()) reader.notes.add("a texture names no picture: its material shows its factors");
    return shown;
}

}  // namespace vesper::scene
