// Shadow maps: how far a lamp sees in each direction. SPDX-License-Identifier: MIT
// A hemisphere around an axis (z) is a square of texels. A direction p lies at o = p / (|x| + |y| + |z|), and o at
// (u, v) = zoom (o.x + o.y, o.x - o.y), from -1 to 1 over the square. Within a quadrant of x and y this is a
// perspective projection, so that triangles are drawn as they are. With a zoom above 1 the square holds the middle of the
// hemisphere alone. The other hemisphere of a lamp that has it follows, with z mirrored. The map of a narrow beam is flat:
// |x| + |y| + |z| is replaced by z in all that follows from it, so that the whole square is one perspective projection.
// A texel holds the distance to the first surface along its middle as the norm |x| + |y| + |z|, m; kMapFar without one.
#ifndef VESPER_SHARED_DISTANCE_MAP_H
#define VESPER_SHARED_DISTANCE_MAP_H
#include "types.h"
SHARED_BEGIN

const uint kShadowMapTexels = 2u;  // rgba32f per lamp, see ShadowMap
const uint kMapUnit = 64u;         // maps begin at multiples of that many texels
const uint kRegion = 64u;          // texels, side of what a workgroup stores; the smallest side of a map
const uint kGroup = 4u;            // texels, side of what an invocation stores
const uint kNotSaved = 0x7fffffffu;
const uint kSaveNow = 0x80000000u; // the texels of the map are to be saved first
// How far a surface may be off its plane, or a distance off the truth, before it counts as before the surface: kMapBias (m)
// and, times the distance, half a texel and kMapRounding, what halves take. Nothing nearer than this to a surface shades it.
const float kMapBias = 0.015625;
const float kMapRounding = 0.0009765625;
const float kMapFar = 6e4;            // m: what texels hold where there is nothing
const float kMapNear = 0.03125;       // m in the norm above: nothing nearer to a lamp is drawn

// The map of a lamp, as a frame sees it.
struct ShadowMap {
    vec4 rotation;     // quaternion from the view frame to that of the map
    float first;       // texel, in units of kMapUnit
    float side;        // texels; 0: nothing hides the lamp; negative: the map is flat
    float zoom;        // negative: there are two hemispheres
    float radius;      // of the luminous opening, m; 0: a point
};
SHARED_SIZE(ShadowMap, 32)

// One square of kRegion texels of a hemisphere that was drawn. Where moving casters alone were drawn, over still ones, the
// texels without them are saved in a tile.
struct MapRegion {
    uint drawn_x, drawn_y;    // its corner in the image, texels
    uint x, y;                // and in the hemisphere, texels
    uint side;                // of the hemisphere, texels
    uint first;               // texel of the hemisphere, in units of kMapUnit
    uint saved;               // kNotSaved: all was drawn; or the first texel of those saved, in units of kMapUnit, and kSaveNow
    uint unused;
};
SHARED_SIZE(MapRegion, 32)

// One instance of a part, drawn into a quadrant of a hemisphere.
struct MapInstance {
    vec4 row_x;        // rows of the matrix from its mesh to the frame of the map, m
    vec4 row_y;
    vec4 row_z;
    vec4 place;        // clip space: scale of (u, v); middle of the square (2); zoom, negative in quadrants of x < 0
    vec4 window;       // least and greatest (u, v) of what is drawn of the square
    float y_sign;      // of the quadrant; 0: the map is flat and has no quadrants
    float overlap;     // part of the norm by which quadrants overlap, so that no texel on their borders is left to neither side
};
SHARED_SIZE(MapInstance, 88)

// Opaque parts are drawn by their triangles. A quadrant of a hemisphere, or of a tile of it, in the image:
struct MapQuadrant {
    vec4 place;        // as in MapInstance
    vec4 window;
    float y_sign;
    uint first;        // its first triangle among those that are kept
    float mirror;      // -1 in the second hemisphere: z is mirrored there; 1
    float side;        // of the image, texels
    vec2 corner;       // of the hemisphere or tile in the image, texels
    float width;       // its own side, texels
    float overlap;     // as in MapInstance
};
SHARED_SIZE(MapQuadrant, 64)

// Triangles of one part, for one quadrant; at most kTrianglesOfRun.
struct TriangleRun {
    uint rows;         // of the matrix from its mesh to the frame of the map, m, in a list of mat3x4
    uint quadrant;
    uint first_index;
    uint first_vertex;
    uint triangles;
};
SHARED_SIZE(TriangleRun, 20)
const uint kTrianglesOfRun = 128u;
const uint kSmallTriangle = 16u;  // texels: triangles in boxes of that side are drawn by cull_triangles.comp itself

SHARED_END
#endif
