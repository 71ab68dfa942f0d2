// Resampling and blurring of skies. SPDX-License-Identifier: MIT
#include "photometry/sky_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/angle.h"

namespace vesper::photometry {
namespace {

constexpr uint32_t kLobeSamples = 512;

/// The i-th of `count` points of Hammersley's sequence.
glm::dvec2 hammersley(uint32_t i, uint32_t count) {
    uint32_t bits = 0;
    for (uint32_t b = 0; b < 32; ++b) bits |= (i >> b & 1) << (31 - b);
    return {(i + 0.5) / count, bits * 0x1p-32 + 0x1p-33};
}

/// Facet normal of the GGX distribution about z (Walter et al. 2007, eq. 35 and 36).
glm::dvec3 facet(glm::dvec2 u, double a) {
    const double cosine = std::sqrt((1 - u.x) / (1 + (a * a - 1) * u.x)),
                 sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return {sine * std::cos(2 * kPi * u.y), sine * std::sin(2 * kPi * u.y), cosine};
}

/// Facet normal among those that `v` sees (E. Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018).
glm::dvec3 visible_facet(glm::dvec2 u, glm::dvec3 v, double a) {
    const glm::dvec3 stretched = glm::normalize(glm::dvec3(a * v.x, a * v.y, v.z));
    const double across = std::hypot(stretched.x, stretched.y);
    const glm::dvec3 t1 = across > 0 ? glm::dvec3(-stretched.y, stretched.x, 0) / across : glm::dvec3(1, 0, 0);
    const double r = std::sqrt(u.x), x = r * std::cos(2 * kPi * u.y), s = 0.5 * (1 + stretched.z);
    const double y = (1 - s) * std::sqrt(1 - x * x) + s * r * std::sin(2 * kPi * u.y);
    const glm::dvec3 h =
        t1 * x + glm::cross(stretched, t1) * y + stretched * std::sqrt(std::max(0.0, 1 - x * x - y * y));
    return glm::normalize(glm::dvec3(a * h.x, a * h.y, std::max(0.0, h.z)));
}

double alpha_of(double roughness) { return std::max(roughness * roughness, 1e-3); }

/// Texel (x, y), whose border lies at -1 and at `side`.
glm::vec4& at(OctahedralMap& map, int x, int y) {
    return map.texels[static_cast<size_t>(y + 1) * map.pitch() + static_cast<size_t>(x + 1)];
}

/// Beyond an edge the map goes on upside down: (1 + d, v) is (1 - d, -v).
void fill_border(OctahedralMap& map) {
    const int last = static_cast<int>(map.side) - 1;
    for (int y = -1; y <= last + 1; ++y)
        for (int x = -1; x <= last + 1; ++x) {
            if (x >= 0 && x <= last && y >= 0 && y <= last) continue;
            int from_x = x, from_y = y;
            if (x < 0 || x > last) from_x = std::clamp(x, 0, last), from_y = last - from_y;
            if (from_y < 0 || from_y > last) from_y = std::clamp(from_y, 0, last), from_x = last - from_x;
            at(map, x, y) = at(map, from_x, from_y);
        }
}

template <class F>
OctahedralMap filled(uint32_t side, F luminance) {
    OctahedralMap map{side, std::vector<glm::vec4>(static_cast<size_t>(side + 2) * (side + 2))};
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const glm::dvec2 place((x + 0.5) * 2 / side - 1, (y + 0.5) * 2 / side - 1);
            at(map, static_cast<int>(x), static_cast<int>(y)) = glm::vec4(glm::vec3(luminance(place)), 1);
        }
    fill_border(map);
    return map;
}

/// A texel is the mean of 2 x 2 places within it.
OctahedralMap sharp_map(const Environment& e, uint32_t side) {
    return filled(side, [&](glm::dvec2 place) {
        glm::dvec3 sum(0);
        for (const double dy : {-0.5, 0.5})
            for (const double dx : {-0.5, 0.5})
                sum += luminance_of(e, octahedral_direction(place + glm::dvec2(dx, dy) / double(side)));
        return sum * 0.25;
    });
}

/// Half the side: means of four, weighted by their solid angles, 4 |p|^-3 per area with p on the octahedron.
OctahedralMap half_of(OctahedralMap& map) {
    const auto weight = [&](int x, int y) {
        const glm::dvec2 place = (glm::dvec2(x, y) + 0.5) * 2.0 / double(map.side) - 1.0;
        const double u = std::abs(place.x), v = std::abs(place.y), w = std::abs(1 - u - v);
        const double s = u + v > 1 ? (1 - v) * (1 - v) + (1 - u) * (1 - u) : u * u + v * v;
        return std::pow(s + w * w, -1.5);
    };
    return filled(map.side / 2, [&](glm::dvec2 place) {
        const glm::ivec2 first = glm::ivec2(glm::floor((place + 1.0) * 0.25 * double(map.side))) * 2;
        glm::dvec3 sum(0);
        double weights = 0;
        for (const glm::ivec2 t : {first, first + glm::ivec2(1, 0), first + glm::ivec2(0, 1), first + 1}) {
            sum += glm::dvec3(at(map, t.x, t.y)) * weight(t.x, t.y);
            weights += weight(t.x, t.y);
        }
        return sum / weights;
    });
}

/// Directions of one lobe, with their weights and the map whose texels are about as large as what each stands for (M.
/// Colbert and J. Krivanek, GPU Gems 3, chapter 20).
struct LobeSample {
    glm::dvec3 direction;  // about z
    double weight;
    size_t map;
};

std::vector<LobeSample> lobe_samples(double roughness, uint32_t side, size_t maps) {
    const double a2 = alpha_of(roughness) * alpha_of(roughness);
    std::vector<LobeSample> samples;
    double weights = 0;
    for (uint32_t i = 0; i < kLobeSamples; ++i) {
        const glm::dvec3 h = facet(hammersley(i, kLobeSamples), alpha_of(roughness));
        const glm::dvec3 l(2 * h.z * h.x, 2 * h.z * h.y, 2 * h.z * h.z - 1);
        if (!(l.z > 0)) continue;
        const double q = h.z * h.z * (a2 - 1) + 1, density = a2 / (kPi * q * q) / 4;  // of l
        const double level = 0.5 * std::log2(double(side) * side / (kLobeSamples * density * 4 * kPi));
        samples.push_back({l, l.z, static_cast<size_t>(std::clamp(level, 0.0, double(maps) - 1))});
        weights += l.z;
    }
    for (LobeSample& s : samples) s.weight /= weights;
    return samples;
}

}  // namespace

glm::dvec3 octahedral_direction(glm::dvec2 p) {
    const glm::dvec2 a = glm::abs(p), sign(p.x < 0 ? -1 : 1, p.y < 0 ? -1 : 1);
    const double z = 1 - a.x - a.y;
    return glm::normalize(z < 0 ? glm::dvec3((1 - a.y) * sign.x, (1 - a.x) * sign.y, z) : glm::dvec3(p, z));
}

glm::dvec2 octahedral_place(glm::dvec3 d) {
    const glm::dvec2 p = glm::dvec2(d) / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    const glm::dvec2 sign(p.x < 0 ? -1 : 1, p.y < 0 ? -1 : 1);
    return d.z < 0 ? (1.0 - glm::abs(glm::dvec2(p.y, p.x))) * sign : p;
}

glm::dvec3 luminance_of(const OctahedralMap& map, glm::dvec3 direction) {
    const glm::dvec2 place =
        (octahedral_place(direction) * 0.5 + 0.5) * double(map.side) + 0.5;  // the border is texel 0
    const glm::dvec2 corner = glm::clamp(glm::floor(place), glm::dvec2(0), glm::dvec2(map.side)), t = place - corner;
    const auto texel = [&](size_t dx, size_t dy) {
        return glm::dvec3(map.texels[(size_t(corner.y) + dy) * map.pitch() + size_t(corner.x) + dx]);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), t.x), glm::mix(texel(0, 1), texel(1, 1), t.x), t.y);
}

SkyMap make_sky_map(const Environment& e) {
    SkyMap map{
        irradiance_polynomial(e), sharp_map(e, std::clamp(std::bit_ceil(2 * e.height), kSkyLobeSide, kSkyMaxSide)), {}};
    std::vector<OctahedralMap> halves{map.sharp};
    while (halves.back().side > 4) halves.push_back(half_of(halves.back()));
    for (uint32_t i = 1; i <= kSkyLobes; ++i) {
        const auto samples = lobe_samples(double(i) / kSkyLobes, map.sharp.side, halves.size());
        map.lobes.push_back(filled(kSkyLobeSide, [&](glm::dvec2 place) {
            const glm::dvec3 z = octahedral_direction(place);
            const glm::dvec3 x =
                glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), z));
            const glm::dmat3 frame(x, glm::cross(z, x), z);
            glm::dvec3 sum(0);
            for (const LobeSample& s : samples) sum += luminance_of(halves[s.map], frame * s.direction) * s.weight;
            return sum;
        }));
    }
    return map;
}

Reflected specular_reflectance(double normal_eye, double roughness, uint32_t samples) {
    const double nv = std::clamp(normal_eye, 1e-4, 1.0), a = alpha_of(roughness), a2 = a * a;
    const glm::dvec3 v(std::sqrt(1 - nv * nv), 0, nv);
    const double smith_eye = std::sqrt(nv * nv * (1 - a2) + a2), seen = 2 * nv / (nv + smith_eye);  // G1
    Reflected sum;
    for (uint32_t i = 0; i < samples; ++i) {
        const glm::dvec3 h = visible_facet(hammersley(i, samples), v, a);
        const double vh = glm::dot(v, h), nl = 2 * vh * h.z - nv;
        if (!(nl > 0 && vh > 0)) continue;
        const double both = 2 * nl * nv / (nl * smith_eye + nv * std::sqrt(nl * nl * (1 - a2) + a2));  // G2
        const double weight = both / seen / samples, schlick = std::pow(1 - vh, 5);
        sum.scale += weight * (1 - schlick), sum.offset += weight * schlick;
    }
    return sum;
}

std::vector<Reflected> specular_table() {
    std::vector<Reflected> table;
    for (uint32_t row = 0; row < kSpecularSide; ++row)
        for (uint32_t column = 0; column < kSpecularSide; ++column)
            table.push_back(specular_reflectance(std::pow(double(column) / (kSpecularSide - 1), 2),
                                                 double(row) / (kSpecularSide - 1), 512));
    return table;
}

}  // namespace vesper::photometry
