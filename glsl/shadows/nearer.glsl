// Texels of shadow maps, written as they are drawn: of what is drawn the nearest stays, whatever its order. Whole maps are drawn
// as floats, kMapNear / distance as bits, for which store_shadow_maps.comp puts halves in their place. Over maps (kOver) halves
// are drawn at once, and tiles that change are listed (ChangedTile). Needs buffers `words` and `changed`, and the constant kOver.

// Lists a tile as changed, once in a frame.
void list_changed(uint first, uint side, uvec2 texel) {
    const uvec2 at = texel / kRegion;
    const uint tile = first / kTileTexels + at.y * (side / kRegion) + at.x;
    const uint flag = kChangedHead + tile;
    if (changed[flag] != 0u) return;
    if (atomicExchange(changed[flag], 1u) != 0u) return;
    const uint place = kChangedHead + changed[3] + 3u * atomicAdd(changed[0], 1u);
    changed[place] = tile;
    changed[place + 1u] = (first + (at.y * side + at.x) * kRegion) / 2u;
    changed[place + 2u] = side / 2u;
}

// `inverse`: kMapNear / distance, the distance in the norm of the maps.
void keep_nearer(bool covered, uint texel, float inverse) {
    if (kOver == 0u) {
        // Reading what is there takes less than an atomic operation, which what is hidden can do without.
        if (covered && words[texel] < floatBitsToUint(inverse)) atomicMax(words[texel], floatBitsToUint(inverse));
        return;
    }
    const uint shift = (texel & 1u) * 16u, at = texel >> 1u,
               mine = packHalf2x16(vec2(min(kMapNear / inverse, kMapFar), 0.0)) & 0xffffu;
    uint word = words[at];
    bool open = covered && mine < (word >> shift & 0xffffu);
    do {  // a CPU driver goes through the body of a loop once before it asks
        if (open) {
            const uint was = atomicCompSwap(words[at], word, (word & ~(0xffffu << shift)) | mine << shift);
            open = was != word && mine < (was >> shift & 0xffffu);
            word = was;
        }
    } while (open);
}
