// The luminous openings of lamps, as seen by one eye. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_LUMINAIRE_H
#define VESPER_SHARED_LUMINAIRE_H
#include "types.h"
SHARED_BEGIN

const uint kLuminaireTile = 4u;            // px, side of the squares that openings are drawn in
const uint kTilesPerRow = 1024u;        // workgroups in a row of the dispatch
const float kLuminaireEdge = 0.1f;         // m of depth over which a surface in front of an opening begins to hide it

// One opening: a convex silhouette in the image. Read as a texel buffer of two rgba32f texels per source.
struct Luminaire {
    vec3 luminance;  // cd/m^2 RGB, of what the silhouette covers
    float hidden;    // depth, m: surfaces nearer than this hide it, those farther by kLuminaireEdge do not
    vec2 origin;     // px, whole: the silhouette's vertices count from here
    float first;     // of its vertices
    float vertices;  // how many
};
SHARED_SIZE(Luminaire, 32)

const uint kTexelsPerLuminaire = 2u;

// An entry of a tile is a source's index and, in this bit, whether it covers all of the tile.
const uint kCoversTile = 0x80000000u;

struct LuminairesPush {
    uvec2 size;   // px
    uint tiles;   // (column, row, first entry, entries) each
};
SHARED_SIZE(LuminairesPush, 12)

SHARED_END
#endif
