// Light of a pixel, lx on a plane at the eye that faces it. The image is declared before.

vec3 light_of_pixel(ivec2 pixel, vec2 scale, vec2 offset, float pixel_area) {
    const vec3 luminance = imageLoad(picture, pixel).rgb;
    const vec2 ray = scale * (vec2(pixel) + 0.5) + offset;
    const float cosine = inversesqrt(1.0 + dot(ray, ray)), steradians = pixel_area * cosine * cosine * cosine;
    const bool finite = abs(luminance.r + luminance.g + luminance.b) <= 3.4e38;
    return finite ? steradians * luminance : vec3(0.0);
}
