// Lines in place of the stairs that edges of shadows have where texels of a map are wider than pixels: along each run of texels
// beside an edge a line from the middle of the step at one end to that at the other (Reshetov 2009, of pixels). Needs
// shadows/lookup.glsl, lanes.glsl, and kLanes invocations.

// The texels about a block of pixels, compared with the plane of its middle: a bit each, by rows and by columns, 1 where the lamp sees it.
const int kWindow = 16;
shared uint window_rows[kWindow], window_columns[kWindow];

// A plane as a map sees it, in all quadrants of a hemisphere.
struct MapPlane {
    vec3 inverse;   // times a direction of norm 1: the inverse distance of the plane, 1/m
    float least;    // 1/m: at most twice as far as its point is it compared
    int first;      // texel of the hemisphere
};

// `p`: map_point() of the same.
MapPlane map_plane(FetchedMap map, MapPoint p, vec3 from, vec3 normal) {
    const vec3 q = map.rotation * from, n = map.rotation * normal;
    const float away = dot(n, q);
    const vec3 inverse = abs(away) > 1e-4 * p.norm ? n / away : vec3(0.0);
    return MapPlane(vec3(inverse.xy, q.z < 0.0 ? -inverse.z : inverse.z), 0.5 / p.norm, p.first);
}

bool sees_plane(FetchedMap map, MapPlane plane, ivec2 texel) {
    const ivec2 at = clamp(texel, ivec2(0), ivec2(max(map.side, 1) - 1));
    const float seen = half_at(distances, plane.first + at.y * map.side + at.x);
    const vec2 square = ((vec2(at) + 0.5) * (2.0 / float(map.side)) - 1.0) / map.zoom;
    const vec2 place = 0.5 * vec2(square.x + square.y, square.x - square.y);
    const float inverse = dot(plane.inverse, vec3(place, 1.0 - map.fold * (abs(place.x) + abs(place.y))));
    return (seen + kMapBias) * max(inverse, plane.least) + map.bias >= 1.0;
}

// All invocations fill the window, whose first texel is `first`.
void fill_window(FetchedMap map, MapPlane plane, ivec2 first) {
    const uint lane = gl_LocalInvocationID.x;
    uint low = 0u, high = 0u;
    int x = 0;
    do {
        low |= (sees_plane(map, plane, first + ivec2(x, lane)) ? 1u : 0u) << x;
        high |= (sees_plane(map, plane, first + ivec2(x, lane + kLanes)) ? 1u : 0u) << x;
        ++x;
    } while (x < kWindow);
    lanes_wait();
    window_rows[lane] = low, window_rows[lane + kLanes] = high;
    lanes_wait();
    uint left = 0u, right = 0u;
    [[unroll]] for (int y = 0; y < kWindow; ++y) {
        left |= (window_rows[y] >> lane & 1u) << y;
        right |= (window_rows[y] >> (lane + kLanes) & 1u) << y;
    }
    window_columns[lane] = left, window_columns[lane + kLanes] = right;
    lanes_wait();
}

// The edge between two rows of texels, or columns.
struct EdgeLine {
    int run;       // texels; 0: there is no edge
    float height;  // of the line above the border between the rows, texels
    float slope;
};

// At a place along the rows, where the middle of the i-th texel, the nearest one, is at i. The line reaches half a run from each
// end, at most half the way to the window's border, and goes on at height 0.
EdgeLine edge_line(uint row, uint next, float at, int i) {
    const uint differ = row ^ next, alike = (row >> i & 1u) != 0u ? row : ~row;
    const uint run = differ & alike, below = ~run & (1u << i) - 1u;
    const int begin = findMSB(below) + 1, end = i + findLSB(~(run >> i));
    // Beyond an end the edge goes on a row higher or lower. It stays where light and dark change sides.
    const int before = max(begin - 1, 0), behind = min(end, kWindow - 1);
    const float sign_before = (alike >> before & 1u) != 0u ? 0.5 : -0.5, sign_behind = (alike >> behind & 1u) != 0u ? 0.5 : -0.5;
    const float step_before = begin > 0 && (differ >> before & 1u) == 0u ? sign_before : 0.0;
    const float step_behind = end < kWindow && (differ >> behind & 1u) == 0u ? sign_behind : 0.0;
    const float margin = min(at, float(kWindow - 1) - at), reach = max(0.5 * min(float(end - begin), margin), 0.5);
    const float from_begin = at - float(begin) + 0.5, to_end = float(end) - 0.5 - at;
    const float near_begin = max(1.0 - from_begin / reach, 0.0), near_end = max(1.0 - to_end / reach, 0.0);
    return EdgeLine((differ >> i & 1u) != 0u ? end - begin : 0, step_before * near_begin + step_behind * near_end,
                    ((near_end > 0.0 ? step_behind : 0.0) - (near_begin > 0.0 ? step_before : 0.0)) / reach);
}

// As visibility(), of a point of the plane.
float visibility_by_lines(FetchedMap map, MapPoint p, mat2 per_pixel, ivec2 first) {
    const vec2 at = clamp(p.texel - 0.5 - vec2(first), 1.0, float(kWindow) - 2.001);
    const ivec2 low_end = ivec2(1), high_end = ivec2(kWindow - 2);  // for places that are not finite
    const ivec2 corner = clamp(ivec2(floor(at)), low_end, high_end), middle = clamp(ivec2(floor(at + 0.5)), low_end, high_end);
    const uint low = window_rows[corner.y], high = window_rows[corner.y + 1];
    const uint left = window_columns[corner.x], right = window_columns[corner.x + 1];
    const EdgeLine along = edge_line(low, high, at.x, middle.x), up = edge_line(left, right, at.y, middle.y);
    const bool level = along.run >= up.run;
    const vec2 beyond = at - vec2(corner) - 0.5 - vec2(up.height, along.height);
    const bool lit_beyond = level ? (high >> middle.x & 1u) != 0u : (right >> middle.y & 1u) != 0u;
    const float distance = level ? beyond.y : beyond.x;
    const vec2 across = level ? vec2(-along.slope, 1.0) : vec2(1.0, -up.slope);
    const float share = max(along.run, up.run) > 0 ? edge_share(lit_beyond ? distance : -distance, length(across * per_pixel))
        : (low >> middle.x & 1u) != 0u ? 1.0 : 0.0;
    return p.inside ? floor(15.0 * share + 0.5) / 15.0 : 1.0;
}
