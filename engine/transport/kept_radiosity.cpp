#include "transport/kept_radiosity.h"

#include <array>
#include <cstring>
#include <string_view>

#include "scene/placement.h"
#include "scene/reflectance.h"
#include "transport/sound_radiosity.h"

namespace vesper::transport {
namespace {

// To be raised whenever the same scene gives other cells.
constexpr uint64_t kRadiosityVersion = 23;

void add_use(Digest& digest, const scene::TextureUse& use) {
    digest.add_value(use.image), digest.add_value(use.wrap_u), digest.add_value(use.wrap_v);
    digest.add_value(use.nearest);
}

void add_materials(Digest& digest, const scene::Scene& scene) {
    digest.add_value(uint64_t{scene.materials.size()});
    for (const scene::Material& m : scene.materials) {
        digest.add_value(m.base_colour), digest.add_value(m.emission), digest.add_value(m.alpha_cutoff);
        digest.add_value(uint8_t(m.alpha)), digest.add_value(m.clear), digest.add_value(m.double_sided);
        add_use(digest, m.base_colour_texture), add_use(digest, m.emission_texture);
        add_use(digest, m.emission_picture);
    }
    digest.add_value(uint64_t{scene.images.size()});
    for (const Image& image : scene.images) {
        digest.add_value(image.width), digest.add_value(image.height);
        digest.add_list(image.rgba);
    }
    digest.add_value(uint64_t{scene.luminance_pictures.size()});
    for (const photometry::LuminancePicture& picture : scene.luminance_pictures) {
        digest.add_value(picture.width), digest.add_value(picture.height);
        digest.add_list(picture.rgb);
    }
    for (const double code : scene::linear_codes(scene.transfer)) digest.add_value(code);
}

void add_lamps(Digest& digest, const scene::Scene& scene) {
    digest.add_value(uint64_t{scene.lamps.size()});
    for (const scene::Lamp& lamp : scene.lamps) {
        digest.add_value(uint8_t(lamp.kind)), digest.add_value(lamp.intensity), digest.add_value(lamp.colour);
        digest.add_value(lamp.inner_cone), digest.add_value(lamp.outer_cone), digest.add_value(lamp.exponent);
        digest.add_value(lamp.distribution);
    }
    digest.add_value(uint64_t{scene.distributions.size()});
    for (const photometry::Distribution& d : scene.distributions) {
        digest.add_value(uint8_t(d.goniometry));
        digest.add_list(d.horizontal), digest.add_list(d.vertical), digest.add_list(d.candela);
    }
}

void add_meshes(Digest& digest, const scene::Scene& scene) {
    static_assert(sizeof(scene::Vertex) == 48, "without padding");
    digest.add_value(uint64_t{scene.meshes.size()});
    for (const scene::Mesh& mesh : scene.meshes) {
        digest.add_value(uint64_t{mesh.primitives.size()});
        for (const scene::Primitive& primitive : mesh.primitives) {
            digest.add_value(primitive.material);
            digest.add_list(primitive.vertices), digest.add_list(primitive.indices);
        }
    }
}

// In the order in which they lie in a file.
template <class Radiosity, class Take>
void each_list(Radiosity& r, Take take) {
    take(r.numbers), take(r.heights), take(r.areas), take(r.normals), take(r.reflectances), take(r.sky);
    take(r.first_source), take(r.sources), take(r.first_met), take(r.met), take(r.parts), take(r.beside), take(r.walls),
        take(r.steps), take(r.cuts);
    take(r.bodies.bodies), take(r.bodies.volumes), take(r.bodies.hidden);
}

struct Header {
    glm::dvec3 origin{0};
    double size = 0;
    glm::uvec3 count{0};
    uint32_t unused = 0;               // instead of padding
    std::array<uint64_t, 18> sizes{};  // of the lists
};
static_assert(sizeof(Header) == 192, "without padding");

Digest::Value key_of_lists(const Digest::Value& key) {
    Digest digest;
    digest.add_value(key);
    digest.add_list(std::string_view("lists"));
    return digest.value();
}

/// Of all lists; empty: more than any file has.
std::optional<uint64_t> bytes_of_lists(const Header& header, const Radiosity& radiosity) {
    constexpr uint64_t kMostBytes = uint64_t{1} << 40u;
    uint64_t bytes = 0;
    bool fits = true;
    size_t i = 0;
    each_list(radiosity, [&](const auto& list) {
        const uint64_t size = header.sizes[i++], each = sizeof list[0];
        fits = fits && size <= (kMostBytes - bytes) / each;
        if (fits) bytes += size * each;
    });
    return fits ? std::optional(bytes) : std::nullopt;
}

}  // namespace

Digest::Value radiosity_key(const scene::Scene& scene, std::span<const glm::dmat4> world,
                            const std::vector<bool>& moving, const RadiositySettings& settings) {
    Digest digest;
    digest.add_value(kRadiosityVersion);
    digest.add_list(std::string_view(VESPER_VERSION));
    digest.add_value(settings.cell_size), digest.add_value(settings.fine_cells), digest.add_value(settings.most_cells);
    digest.add_value(settings.rays), digest.add_value(settings.looks), digest.add_value(settings.lamp_rays);
    add_materials(digest, scene), add_lamps(digest, scene), add_meshes(digest, scene);
    for (const scene::Node& node : scene.nodes) {
        digest.add_value(node.mesh), digest.add_value(node.lamp), digest.add_value(node.parent);
        digest.add_value(node.fixture ? uint64_t{*node.fixture} : ~uint64_t{0});
    }
    for (size_t node = 0; node < world.size(); ++node) {
        const bool moves = !moving.empty() && moving[node];
        digest.add_value(moves);
        const uint32_t parent = scene.nodes[node].parent;
        // What moves counts by its shape only.
        if (!moves)
            digest.add_value(world[node]);
        else if (parent != scene::kNone && moving[parent])
            digest.add_value(scene::local_transform(scene.nodes[node]));
    }
    return digest.value();
}

std::optional<Radiosity> read_radiosity(Cache& cache, const Digest::Value& key) {
    Header header;
    if (!cache.read(key, std::as_writable_bytes(std::span(&header, 1)))) return std::nullopt;
    Radiosity radiosity;
    radiosity.grid = {header.origin, header.size, header.count};
    const std::optional<uint64_t> size = bytes_of_lists(header, radiosity);
    if (!size || cache.bytes(key_of_lists(key)) != *size) return std::nullopt;
    std::vector<std::byte> bytes(*size);
    if (!cache.read(key_of_lists(key), bytes)) return std::nullopt;
    size_t i = 0, at = 0;
    each_list(radiosity, [&](auto& list) {
        list.resize(header.sizes[i++]);
        const std::span to = std::as_writable_bytes(std::span(list));
        if (!to.empty()) std::memcpy(to.data(), &bytes[at], to.size());
        at += to.size();
    });
    if (!is_sound(radiosity)) return std::nullopt;
    return radiosity;
}

std::string write_radiosity(Cache& cache, const Digest::Value& key, const Radiosity& radiosity) {
    const CellGrid& grid = radiosity.grid;
    Header header{.origin = grid.origin, .size = grid.size, .count = grid.count};
    std::vector<std::byte> bytes;
    size_t i = 0;
    each_list(radiosity, [&](const auto& list) {
        header.sizes[i++] = list.size();
        const std::span from = std::as_bytes(std::span(list));
        bytes.insert(bytes.end(), from.begin(), from.end());
    });
    cache.write(key_of_lists(key), bytes);
    cache.write(key, std::as_bytes(std::span(&header, 1)));
    return cache.settle();
}

std::optional<Radiosity> kept_or_gathered(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                          const std::vector<bool>& moving, const RadiositySettings& settings,
                                          Cache* cache, const std::function<bool(double)>& progress,
                                          std::string* problem) {
    if (!cache) return gather_radiosity(scene, world, moving, settings, progress);
    const Digest::Value key = radiosity_key(scene, world, moving, settings);
    auto light = read_radiosity(*cache, key);
    if (light && names_nodes_of(*light, scene)) return light;
    light = gather_radiosity(scene, world, moving, settings, progress);
    if (!light) return light;
    const std::string failed = cache->writes() ? write_radiosity(*cache, key, *light) : cache->settle();
    if (problem) *problem = failed;
    return light;
}

}  // namespace vesper::transport
