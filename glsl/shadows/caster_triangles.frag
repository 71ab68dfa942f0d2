#version 460

// Shadow maps, opaque triangles: their depth is all.

void main() {}
