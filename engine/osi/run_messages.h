// Runs that esmini recorded, as messages. SPDX-License-Identifier: MIT
#pragma once

#include "osi/message.h"
#include "roads/esmini_run.h"

namespace vesper::osi {

/// A message for each time of the table, with the entities that are there; ids count them from 0. No lamp is stated.
std::vector<Message> messages_of(const roads::EsminiRun&);

}  // namespace vesper::osi
