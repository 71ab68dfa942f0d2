// What another program moves in a scene, as a Session steps through it. SPDX-License-Identifier: MIT
#pragma once

#include "session/scenery.h"

namespace vesper::test {

struct DrivenAlong {
    drive::Scenery scenery;
    osi::Timeline timeline;
    drive::ExternalPlaces places;
    traffic::World world;

    DrivenAlong(const std::filesystem::path& scene, const drive::MessageSource& source)
        : scenery(scene, source), places(scenery.external_places()), world(scenery.world(), 1) {
        for (osi::Message& message : scenery.take_messages()) timeline.add(std::move(message));
    }
    drive::ExternalState at(double seconds) {
        drive::ExternalState external = places.place(timeline.at(seconds));
        world.place(external.actors, external.driver);
        return external;
    }
};

}  // namespace vesper::test
