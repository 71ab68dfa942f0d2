// A world as another program's messages have it. SPDX-License-Identifier: MIT
#pragma once

#include "external/external_places.h"
#include "traffic/world.h"

namespace vesper::drive {

/// What moves at the present time: objects of another program as they are, and the driver's car (the host, where that
/// program has none), traffic and walkers with their nodes' names as models and usual heights. The time is 0.
osi::Message message_of(const traffic::World&, const ExternalState&, const MessageFrame&);

}  // namespace vesper::drive
