#include "scene/append.h"

#include <iterator>
#include <utility>

#include "base/budget.h"
#include "base/error.h"

namespace vesper::scene {
namespace {

template <class T>
uint32_t appended(std::vector<T>& to, std::vector<T>& from) {
    const auto first = uint32_t(to.size());
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
    return first;
}

void move_index(uint32_t& index, uint32_t by) {
    if (index != kNone) index += by;
}

bool has_textures(const Scene& scene) {
    for (const Material& m : scene.materials)
        if (m.base_colour_texture.image != kNone) return true;
    return false;
}

}  // namespace

SceneInsert::SceneInsert(Scene& to, Scene model) {
    const bool same = to.transfer.kind == model.transfer.kind &&
                      (to.transfer.kind == Transfer::Kind::Srgb || to.transfer.gamma == model.transfer.gamma);
    if (!same && has_textures(model) && has_textures(to))
        throw Error("codes of its textures mean other reflectances than those of the scene (sRGB, or a power)");
    if (!has_textures(to)) to.transfer = model.transfer;
    if (to.retroreflectors.size() + model.retroreflectors.size() > kMaxRetroreflectors)
        throw Error("with it the scene has more than " + std::to_string(kMaxRetroreflectors) + " retroreflectors");
    const uint32_t image = appended(to.images, model.images),
                   picture = appended(to.luminance_pictures, model.luminance_pictures),
                   table = appended(to.reflection_tables, model.reflection_tables),
                   retroreflector = appended(to.retroreflectors, model.retroreflectors),
                   distribution = appended(to.distributions, model.distributions);
    for (Material& m : model.materials) {
        for (TextureUse* use : textures_of(m)) move_index(use->image, image);
        move_index(m.emission_picture.image, picture);
        move_index(m.reflection_table, table), move_index(m.retroreflector, retroreflector);
    }
    for (Lamp& lamp : model.lamps) move_index(lamp.distribution, distribution);
    const uint32_t material = appended(to.materials, model.materials);
    for (Mesh& mesh : model.meshes)
        for (Primitive& primitive : mesh.primitives) primitive.material += material;
    const uint32_t mesh = appended(to.meshes, model.meshes), lamp = appended(to.lamps, model.lamps);
    nodes_ = std::move(model.nodes);
    for (Node& node : nodes_) {
        move_index(node.mesh, mesh), move_index(node.lamp, lamp);
        node.camera = kNone;
    }
}

uint32_t SceneInsert::add(Scene& to, const std::string& name) const {
    check_time();
    spend((nodes_.size() + 1) * sizeof(Node));
    const auto root = uint32_t(to.nodes.size());
    to.nodes.push_back({.name = name});
    for (Node node : nodes_) {
        node.parent = node.parent == kNone ? root : node.parent + root + 1;
        if (node.fixture) move_index(*node.fixture, root + 1);
        to.nodes.push_back(std::move(node));
    }
    return root;
}

}  // namespace vesper::scene
