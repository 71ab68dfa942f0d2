// A list of pixels. Each is a word whose halves are its column and row: a CPU device divides lane by lane.

uint edge_of(ivec2 pixel) { return uint(pixel.y) << 16u | uint(pixel.x); }
ivec2 edge_at(uint word) { return ivec2(word & 0xffffu, word >> 16u); }
