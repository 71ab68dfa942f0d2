// A world as another program's messages have it. SPDX-License-Identifier: MIT
#pragma once

#include "guest_places.h"
#include "traffic/world.h"

namespace vesper::drive {

/// What moves at the present time: the driver's car as host, traffic, walkers and guests, each with its node's name as
/// model. Heights are usual ones, the time is 0.
osi::Message message_of(const traffic::World&, const Outside&, const MessageFrame&);

}  // namespace vesper::drive
