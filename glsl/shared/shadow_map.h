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
const uint kRegion = 64u;          // texels, side of a tile, and the smallest side of a map
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

// A quadrant of a hemisphere that is drawn into.
struct MapQuadrant {
    float zoom;        // negative in quadrants of x < 0
    float y_sign;      // of the quadrant; 0: the map is flat and has no quadrants
    float mirror;      // -1 in the second hemisphere: z is mirrored there; 1
    float overlap;     // part of the norm by which quadrants overlap, so that no texel on their borders is left to neither side
    uint side;         // of the hemisphere, texels
    uint first;        // its first texel, of those that are drawn into
    uint lamp;         // its number in the list of lamps; kCastsAlways: it casts shadows in any case
};
SHARED_SIZE(MapQuadrant, 28)
const uint kCastsAlways = 0xffffffffu;

// One instance of a part that is rasterized, in a quadrant.
struct MapInstance {
    vec4 row_x;        // rows of the matrix from its mesh to the frame of the map, mirrored as the quadrant is, m
    vec4 row_y;
    vec4 row_z;
    uint quadrant;
};
SHARED_SIZE(MapInstance, 52)

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

// A corner of one of the others, which are rasterized.
struct LargeCorner {
    vec3 position;     // in the frame of the map, mirrored as the quadrant is, m
    uint quadrant;
};
SHARED_SIZE(LargeCorner, 16)

// A tile of a map that moving casters were drawn into. The list of them has kChangedHead words before its flags, one for each
// tile of all maps, and the tiles; the first word of the head is their number, and the workgroups that put them back.
struct ChangedTile {
    uint tile;         // number of its flag: its first texel over the texels of a tile, as if they were side by side
    uint word;         // of its corner, of all maps
    uint stride;       // words from row to row
};
SHARED_SIZE(ChangedTile, 12)
const uint kChangedHead = 4u;
const uint kTileTexels = kRegion * kRegion;
const uint kRasterSide = 2048u;  // texels, of the square in whose corner a hemisphere is rasterized: of the largest

// Texels of a whole map, as many as a tile has, that were drawn.
struct DrawnTexels {
    uint from;         // first, of those that were drawn
    uint to;           // word of all maps
};
SHARED_SIZE(DrawnTexels, 8)

SHARED_END
#endif
