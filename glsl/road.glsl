// Roads with a table (shared/maps.h). Needs `samplerBuffer maps`.

#include "maps.glsl"

const float kTableSine = 0.0261769, kNoSheenSine = 0.1736482;  // of 1.5 and of 10 degrees

// What a point of a road needs: the direction of sight along its plane, what draws beta towards 90 degrees, and its table.
struct Road {
    vec3 sight;
    float fade, tan_cells, last_tan, beta_cells, first_cell;  // cells per unit of tan(gamma), 0: no road; of beta, per rad
    vec2 last_cell;                                           // the middle of it
};

// `metallic` of the G-buffer tells the table. Tables hold for sight at 1 degree to their plane; towards 10 degrees beta is drawn to
// 90, which takes away the sheen. `roads`: texel of the first table's head.
Road road_at(float metallic, vec3 normal, vec3 toward_eye, uint roads) {
    const bool paved = metallic <= kRoadKind;
    const vec4 head = texelFetch(maps, int(roads) + (paved ? int(-1.0 - metallic) : 0));
    const float sine = dot(normal, toward_eye);
    return Road((normal * sine - toward_eye) * inversesqrt(max(1.0 - sine * sine, 1e-12)), 1.0 - smoothstep(kTableSine, kNoSheenSine, sine),
                paved ? head.x : 0.0, head.y, head.z, head.w, round(vec2(head.x * head.y, head.z * kPi)) - 0.5);
}

// L pi lambert / E of a lamp on the plane that faces it, times sr: q cos(gamma) = r / cos^2(gamma) (CIE 144:2001). Beyond
// the last tan(gamma) it keeps the value it has there. Written for a light's direction times its distance.
float road_coefficient(Road road, vec3 to, float inverse, float normal_light) {
    const float cosine = max(normal_light, 1e-6), sine = sqrt(max(1.0 - cosine * cosine, 1e-12));
    const float t = min(sine / cosine, road.last_tan);
    const float cos_beta = clamp(dot(road.sight, to) * inverse / sine, -1.0, 1.0) * road.fade;
    const vec2 at = vec2(t * road.tan_cells, arccos(cos_beta) * road.beta_cells);
    const vec2 cell = floor(min(at, road.last_cell));
    const vec4 corners = texelFetch(maps, int(road.first_cell + cell.x * (road.last_cell.y + 0.5) + cell.y));
    return interpolate(corners, at.x - cell.x, at.y - cell.y) * (1.0 + t * t);
}
