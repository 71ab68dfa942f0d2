// Names that say lamp, by whole words. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "scene/apply_rules.h"

namespace vesper::test {
namespace {

TEST(LampWords, WholeWordsSayLamp) {
    for (const char* name :
         {"StreetLight_03", "street_light", "Lampe.001",   "HeadLight",      "lamp_glass",     "headlights",
          "STREETLIGHT",    "HDRLight",     "Headlamp.L",  "LED_strip",      "neon sign",      "Lamppost2",
          "lightbulb",      "Tail-Lights",  "ceilinglamp", "Straßenlaterne", "Strassenlampen", "Emissive_01",
          "light",          "Light3",       "windowGlow",  "headl_01",       "streetlamppost", "LEDs",
          "LEDlight",       "lamplight",    "lightbars"})
        EXPECT_TRUE(scene::sounds_like_light(name)) << name;
    for (const char* name :
         {"FlightHelmet", "flight_deck", "SLIGHT", "delight",   "Clamp_02", "hose_clamps", "highlighter", "skylight",
          "twilight",     "blight",      "Ledge",  "neonatal",  "polite",   "Lighthouse",  "wall",        "",
          "003",          "LEDGE",       "post",   "clamppost", "polite"})
        EXPECT_FALSE(scene::sounds_like_light(name)) << name;
}

}  // namespace
}  // namespace vesper::test
