#version 460

// Clipmaps, vertices: mesh frame to the square of a level (shared/clipmap.h).

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
layout(location = 3) in vec4 row_x;  // of the matrix to the square, -1 to 1, and to depth, 0 farthest along the light
layout(location = 4) in vec4 row_y;
layout(location = 5) in vec4 row_z;

layout(location = 0) out vec2 texture_uv;
layout(location = 1) out float opacity;

void main() {
    const vec4 p = vec4(position, 1.0);
    gl_Position = vec4(dot(row_x, p), dot(row_y, p), dot(row_z, p), 1.0);
    texture_uv = uv;
    opacity = colour.a;
}
