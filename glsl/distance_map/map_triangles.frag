#version 460

// Distance maps, opaque triangles: their depth is all.

void main() {}
