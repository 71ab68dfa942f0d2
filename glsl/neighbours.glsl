// The pixel itself, those beside it, those at its corners.
ivec2 neighbour(uint k) {
    const uint place = k == 0u ? 4u : k <= 4u ? 2u * k - 1u : k == 5u ? 0u : k == 6u ? 2u : k == 7u ? 6u : 8u;
    return ivec2(place % 3u, place / 3u) - 1;
}
