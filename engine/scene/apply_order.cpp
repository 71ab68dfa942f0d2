// The order of a scene after rules: that in which a file of it would be read. SPDX-License-Identifier: MIT
#include <map>
#include <tuple>

#include "scene/apply_rules.h"

namespace vesper::scene {
namespace {

/// Old indices of the nodes in their new order: a node that rules made follows all that lies below its parent.
std::vector<uint32_t> new_order(const Application& application) {
    const std::vector<Node>& nodes = application.scene.nodes;
    std::vector<std::vector<uint32_t>> made(application.nodes);  // below each node
    std::vector<uint32_t> order, open;                           // open: a node and those above it
    for (auto i = application.nodes; i < nodes.size(); ++i)
        if (nodes[i].parent != kNone) made[nodes[i].parent].push_back(i);
    std::vector<bool> is_open(application.nodes);
    const auto close = [&](uint32_t down_to) {
        while (!open.empty() && open.back() != down_to) {
            order.insert(order.end(), made[open.back()].begin(), made[open.back()].end());
            is_open[open.back()] = false;
            open.pop_back();
        }
    };
    for (uint32_t i = 0; i < application.nodes; ++i) {
        // A mesh that joints put in place comes last, far from its parent.
        const uint32_t parent = nodes[i].parent;
        close(parent != kNone && is_open[parent] ? parent : kNone);
        order.push_back(i), open.push_back(i), is_open[i] = true;
    }
    close(kNone);
    for (auto i = application.nodes; i < nodes.size(); ++i)
        if (nodes[i].parent == kNone) order.push_back(i);
    return order;
}

/// Whether a node was there for the sake of a light alone that is gone.
bool is_left_over(const Application& application, uint32_t i) {
    const Node& node = application.scene.nodes[i];
    return application.is_added(i) && node.mesh == kNone && node.lamp == kNone;
}

void order_nodes(Application& application) {
    Scene& scene = application.scene;
    std::vector<uint32_t> place(scene.nodes.size(), kNone);
    std::vector<Node> ordered;
    ordered.reserve(scene.nodes.size());
    for (const uint32_t i : new_order(application)) {
        if (is_left_over(application, i)) continue;
        place[i] = static_cast<uint32_t>(ordered.size());
        ordered.push_back(std::move(scene.nodes[i]));
    }
    for (Node& node : ordered) {
        if (node.parent != kNone) node.parent = place[node.parent];
        if (node.fixture && *node.fixture != kNone) node.fixture = place[*node.fixture];
    }
    for (Channel& channel : scene.channels) channel.node = place[channel.node];
    scene.nodes = std::move(ordered);
    place.resize(application.nodes);
    application.report.node_of = std::move(place);
}

/// Measured lamps come last, by the first node that has them; equal ones are one.
void order_lamps(Scene& scene) {
    std::vector<Lamp> ordered;
    std::vector<uint32_t> place(scene.lamps.size(), kNone);
    for (size_t i = 0; i < scene.lamps.size(); ++i)
        if (scene.lamps[i].kind != Lamp::Kind::Measured) {
            place[i] = static_cast<uint32_t>(ordered.size());
            ordered.push_back(scene.lamps[i]);
        }
    std::map<std::tuple<uint32_t, float, float, float, float>, uint32_t> measured;
    for (Node& node : scene.nodes) {
        if (node.lamp == kNone) continue;
        if (place[node.lamp] == kNone) {
            const Lamp& lamp = scene.lamps[node.lamp];
            const auto [known, is_new] =
                measured.try_emplace({lamp.distribution, lamp.intensity, lamp.colour.r, lamp.colour.g, lamp.colour.b},
                                     static_cast<uint32_t>(ordered.size()));
            if (is_new) ordered.push_back(lamp);
            place[node.lamp] = known->second;
        }
        node.lamp = place[node.lamp];
    }
    scene.lamps = std::move(ordered);
}

/// Images that only textures showed which rules have taken away.
void drop_images(Application& application) {
    Scene& scene = application.scene;
    const std::vector<bool> shown = shown_images(scene);
    std::vector<uint32_t> place(scene.images.size());
    std::vector<Image> kept;
    for (size_t i = 0; i < place.size(); ++i) {
        place[i] = static_cast<uint32_t>(kept.size());
        if (shown[i] || !application.images_before[i]) kept.push_back(std::move(scene.images[i]));
    }
    for (Material& m : scene.materials)
        for (TextureUse* use : textures_of(m))
            if (use->image != kNone) use->image = place[use->image];
    scene.images = std::move(kept);
}

}  // namespace

std::vector<bool> shown_images(const Scene& scene) {
    std::vector<bool> shown(scene.images.size());
    for (const Material& m : scene.materials)
        for (const TextureUse* use : textures_of(m))
            if (use->image != kNone) shown[use->image] = true;
    return shown;
}

void put_in_order(Application& application) {
    order_nodes(application);
    order_lamps(application.scene);
    drop_images(application);
}

}  // namespace vesper::scene
