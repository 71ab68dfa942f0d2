// How a road with a table looks under another angle of sight than the table's.

#ifndef VESPER_SHEEN_GLSL
#define VESPER_SHEEN_GLSL

const float kTableSine = 0.0261769, kNoSheenSine = 0.1736482;  // of 1.5 and of 10 degrees

// How much is seen of a road's sheen, which is what its table has beyond its value at beta 90 degrees: tables hold for sight at 1 degree to
// their plane. By the sine of the angle of sight.
float sheen_seen(float sine) { return 1.0 - smoothstep(kTableSine, kNoSheenSine, sine); }

// Of light from all sides a road reflects its colour where it is seen at 1 degree, and `plain` of that without sheen (shared/shade.h).
float road_in_diffuse(float plain, float sine) { return mix(plain, 1.0, sheen_seen(sine)); }

#endif
