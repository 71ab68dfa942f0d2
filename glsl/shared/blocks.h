// Lamps added up over blocks of pixels. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_BLOCKS_H
#define VESPER_SHARED_BLOCKS_H
#include "shade.h"
SHARED_BEGIN

// Over a block that is one matt plane, or one plane of road, the illuminance of a lamp that is not too near is smooth. Such lamps
// are taken off the block's list, and their sum is kept at 3 x 3 nodes, the centres of the block's outermost pixels and what lies
// halfway between: RGB of luminance lx, on a road by what its table has in place of a cosine. Between
// nodes it is the polynomial through them, quadratic along either side. Node (i, j) has its components at 3 (3 j + i).
const uint kMergedTexels = 7u;  // rgba32f per block; 27 components and one unused

// Blocks are shaded class by class, each by a shader that knows nothing else: by what is drawn, and by whether lamps are left
// on the list. Class k has words k * kClassWords of the counts: the workgroups that it takes (three words) and its
// blocks; and entries k * blocks of the list of all blocks.
const uint kClassEmpty = 0u;          // nothing is drawn
const uint kClassMatt = 1u;           // no lamp left
const uint kClassMattListed = 2u;
const uint kClassPaved = 3u;          // roads with a table and matt surfaces
const uint kClassPavedListed = 4u;
const uint kClassGlossy = 5u;         // surfaces with a specular lobe and matt ones
const uint kClassGlossyPaved = 6u;
const uint kClassRetro = 7u;          // and any of the others; and, with shadow maps, blocks that look at every lamp
const uint kBlockClasses = 8u;
const uint kClassWords = 4u;
const uint kBlocksPerGroup = 4u;      // that a workgroup of the shading does, side by side

struct MergePush {
    ClusterPush view;
    uvec2 size;      // px
    uint blocks_x;   // as in CullPush
    uint blocks_y;
    uint capacity;
    uint roads;      // as in ShadePush
    float merge_error; // largest relative error of a lamp at the pixels between the nodes; 0: every lamp stays where it is
};
SHARED_SIZE(MergePush, 92)

SHARED_END
#endif
