// Roads with a table (shared/tables.h). Needs TEXELS tables.

#include "tables.glsl"
#include "sheen.glsl"

// What a point of a road needs: the direction of sight along its plane, how much of its sheen is seen, and its table.
struct Road {
    vec3 sight;
    float sheen, tan_cells, last_tan, beta_cells, first_cell;  // cells per unit of tan(gamma), 0: no road; of beta, per rad
    vec2 last_cell;                                            // the middle of it
    vec2 plain;                                                // beta 90 degrees: the cell, and where in it
};

// `metallic` of the G-buffer tells the table. `roads`: texel of the first table's head.
Road road_at(float metallic, vec3 normal, vec3 toward_eye, uint roads) {
    const bool paved = metallic <= kRoadKind;
    const vec4 head = texel_at(tables, int(roads) + (paved ? int(-1.0 - metallic) : 0));
    const float sine = dot(normal, toward_eye);
    const vec2 last_cell = round(vec2(head.x * head.y, head.z * kPi)) - 0.5;
    const float plain = 0.5 * kPi * head.z, cell = floor(min(plain, last_cell.y));
    return Road((normal * sine - toward_eye) * inversesqrt(max(1.0 - sine * sine, 1e-12)), sheen_seen(sine),
                paved ? head.x : 0.0, head.y, head.z, head.w, last_cell, vec2(cell, plain - cell));
}

// What takes the place of a matt surface's cosine: L / E of a lamp on the plane that faces it, q cos(gamma) = r / cos^2(gamma) (CIE 144:2001),
// over Qd. Beyond the last tan(gamma) it keeps the value it has there. Written for a lamp's direction times its distance.
float road_coefficient(Road road, vec3 to, float inverse, float normal_lamp) {
    const float cosine = max(normal_lamp, 1e-6), sine = sqrt(max(1.0 - cosine * cosine, 1e-12));
    const float t = min(sine / cosine, road.last_tan);
    const float cos_beta = clamp(dot(road.sight, to) * inverse / sine, -1.0, 1.0);
    const vec2 at = vec2(t * road.tan_cells, arccos(cos_beta) * road.beta_cells);
    const vec2 cell = floor(min(at, road.last_cell));
    const float row = road.first_cell + cell.x * (road.last_cell.y + 0.5);
    const float shown = interpolate(texel_at(tables, int(row + cell.y)), at.x - cell.x, at.y - cell.y);
    const float plain = interpolate(texel_at(tables, int(row + road.plain.x)), at.x - cell.x, road.plain.y);
    return mix(plain, shown, road.sheen) * (1.0 + t * t);
}
