// Buffers whose length depends on the scene or the image. They are texel buffers, which CPU drivers read fastest; compiled
// once more with STORAGE_TEXELS they are storage buffers, for devices with short texel buffers (gpu/kernel_cache.h).
// TEXELS(binding, type of an element, name) is read with texel_at(name, index), which has four components as texelFetch;
// HALVES with half_at; WRITTEN_TEXELS with written_texel_at and write_texel. What is read beyond the end of a buffer is not used,
// but must not be a read beyond the end of memory either, as it may be of storage buffers.

#ifdef STORAGE_TEXELS

#define TEXELS(slot, type, name) layout(binding = slot, std430) readonly buffer Block_##name { type name[]; }
#define HALVES(slot, name) layout(binding = slot, std430) readonly buffer Block_##name { uint name[]; }
#define WRITTEN_TEXELS(slot, type, name) layout(binding = slot, std430) buffer Block_##name { type name[]; }

vec4 as_texel(float x) { return vec4(x, 0.0, 0.0, 1.0); }
vec4 as_texel(vec2 v) { return vec4(v, 0.0, 1.0); }
vec4 as_texel(vec4 v) { return v; }
uvec4 as_texel(uint x) { return uvec4(x, 0u, 0u, 1u); }
uvec4 as_texel(uvec4 v) { return v; }
float half_of(uint word, int index) {
    const vec2 both = unpackHalf2x16(word);
    return (index & 1) == 0 ? both.x : both.y;
}

#define WITHIN(name, index) min(uint(index), uint(name.length()) - 1u)
#define texel_at(name, index) as_texel(name[WITHIN(name, index)])
#define half_at(name, index) half_of(name[WITHIN(name, (index) >> 1)], index)
#define written_texel_at(name, index) as_texel(name[WITHIN(name, index)])
#define write_texel(name, index, value) name[index] = value

#else

#define SAMPLER_float samplerBuffer
#define SAMPLER_vec2 samplerBuffer
#define SAMPLER_vec4 samplerBuffer
#define SAMPLER_uint usamplerBuffer
#define SAMPLER_uvec4 usamplerBuffer
#define IMAGE_vec4 imageBuffer
#define IMAGE_uint uimageBuffer
#define FORMAT_vec4 rgba32f
#define FORMAT_uint r32ui

#define TEXELS(slot, type, name) layout(binding = slot) uniform SAMPLER_##type name
#define HALVES(slot, name) layout(binding = slot) uniform samplerBuffer name
#define WRITTEN_TEXELS(slot, type, name) layout(binding = slot, FORMAT_##type) uniform IMAGE_##type name

vec4 as_texel(vec4 v) { return v; }
uvec4 as_texel(uint x) { return uvec4(x); }

#define texel_at(name, index) texelFetch(name, index)
#define half_at(name, index) texelFetch(name, index).r
#define written_texel_at(name, index) imageLoad(name, index)
#define write_texel(name, index, value) imageStore(name, index, as_texel(value))

#endif
