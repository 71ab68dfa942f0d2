// Makes a list of pixels, the words of edges_list.glsl. Wants `counts`, of kEdgeCounts words, and `edges`.

#include "edges_list.glsl"

// The first of some places at its end, and the groups of a dispatch that reads them.
uint take_places(uint count) {
    const uint place = atomicAdd(counts[3], count), most = kEdgesPerGroup * kMostEdgeGroups;
    const uint before = min(place, most) + kEdgesPerGroup - 1u, after = min(place + count, most) + kEdgesPerGroup - 1u;
    const uint groups = after / kEdgesPerGroup - before / kEdgesPerGroup;
    if (groups > 0u) atomicAdd(counts[0], groups);
    return place;
}

void list_edge(uint place, ivec2 pixel) {
    if (place < kEdgesPerGroup * kMostEdgeGroups) edges[place] = edge_of(pixel);
}
