// Road marks: paint along the borders of lanes. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "roads/lit_road_parts.h"

namespace vesper::roads {
namespace {

constexpr double kInsideLane = 0.25;  // m that paint must lie inside another road's lane to be left out
constexpr double kLongestPiece = 2;   // m, in junctions, where each piece is asked for
constexpr size_t kMaxDashes = 400'000;

RoadMaterial stuff_of(MarkColour colour) {
    switch (colour) {
        case MarkColour::Yellow:
        case MarkColour::Orange:
            return RoadMaterial::MarkYellow;
        case MarkColour::Red:
            return RoadMaterial::MarkRed;
        case MarkColour::Blue:
            return RoadMaterial::MarkBlue;
        case MarkColour::Green:
            return RoadMaterial::MarkGreen;
        case MarkColour::Black:
            return RoadMaterial::MarkBlack;
        default:
            return RoadMaterial::MarkWhite;
    }
}

struct MarkBuilder {
    RoadBuild& build;
    const CutSection& cut;
    const Road& road;
    RoadMesh& mesh;
    size_t dashes = 0;

    /// The border at s, on the chord between stations that the surface has too.
    RoadPoint border(size_t lane, double s) const {
        const auto after = std::upper_bound(cut.stations.begin() + 1, cut.stations.end() - 1, s);
        const auto i = static_cast<size_t>(after - cut.stations.begin());
        const double span = cut.stations[i] - cut.stations[i - 1], f = span > 0 ? (s - cut.stations[i - 1]) / span : 0;
        const RoadPoint &a = cut.rows[i - 1][lane].outer, &b = cut.rows[i][lane].outer;
        RoadPoint point = a;
        point.position = glm::mix(a.position, b.position, f);
        point.left = glm::normalize(glm::mix(a.left, b.left, f));
        point.up = glm::normalize(glm::mix(a.up, b.up, f));
        return point;
    }

    void piece(size_t lane, const MarkLine& line, double from, double to) {
        const RoadPoint a = border(lane, from), b = border(lane, to);
        if (is_driven_over(build, cut.road, (a.position + b.position) / 2.0, kInsideLane)) return;
        const double right = line.t_offset - line.width / 2, left = line.t_offset + line.width / 2;
        // Over the lift of lanes in junctions as well.
        const double lift = kMarkHeight + (road.junction != kNoRoad ? 0.003 : 0);
        const auto at = [&](const RoadPoint& p, double t) {
            return RoadMesh::Corner{p.position + p.left * t + p.up * lift, p.up};
        };
        mesh.quad(stuff_of(line.colour), at(a, right), at(b, right), at(b, left), at(a, left));
    }

    /// One painted stretch, cut where the surface has stations.
    void stretch(size_t lane, const MarkLine& line, double from, double to) {
        if (++dashes > kMaxDashes) return;
        std::vector<double> cuts{from};
        for (auto each = std::upper_bound(cut.stations.begin(), cut.stations.end(), from);
             each != cut.stations.end() && *each < to; ++each)
            cuts.push_back(*each);
        cuts.push_back(to);
        for (size_t i = 0; i + 1 < cuts.size(); ++i) {
            const int parts = road.junction == kNoRoad
                                  ? 1
                                  : std::max(1, static_cast<int>(std::ceil((cuts[i + 1] - cuts[i]) / kLongestPiece)));
            for (int p = 0; p < parts; ++p)
                piece(lane, line, glm::mix(cuts[i], cuts[i + 1], double(p) / parts),
                      glm::mix(cuts[i], cuts[i + 1], double(p + 1) / parts));
        }
    }

    void mark(size_t lane, const RoadMark& mark, double end) {
        const double first = std::max(mark.s, cut.stations.front());
        for (const MarkLine& line : mark.lines) {
            const double begin = first + line.s_offset;
            if (line.once > 0) {
                if (begin < end) stretch(lane, line, begin, std::min(begin + line.once, end));
            } else if (line.length <= 0) {
                if (begin < end) stretch(lane, line, begin, end);
            } else {
                const double period = std::max(line.length + line.space, 0.2);
                for (double s = begin; s < end && dashes <= kMaxDashes; s += period)
                    stretch(lane, line, s, std::min(s + line.length, end));
            }
        }
    }
};

}  // namespace

void build_marks(RoadBuild& build, const std::vector<CutSection>& cuts) {
    RoadMesh mesh(build.network);
    size_t dashes = 0;
    for (const CutSection& cut : cuts) {
        const Road& road = build.network.roads[cut.road];
        MarkBuilder builder{build, cut, road, mesh, dashes};
        const auto& lanes = road.sections[cut.section].lanes;
        for (size_t l = 0; l < lanes.size(); ++l)
            for (size_t m = 0; m < lanes[l].marks.size(); ++m)
                builder.mark(l, lanes[l].marks[m],
                             m + 1 < lanes[l].marks.size() ? lanes[l].marks[m + 1].s : cut.stations.back());
        dashes = builder.dashes;
        mesh.place(build.scene, build.materials, "marks of road " + road.id);
    }
    if (dashes > kMaxDashes)
        build.notes.push_back("markings: more than " + std::to_string(kMaxDashes) +
                              " pieces of paint: the rest is left out");
}

}  // namespace vesper::roads
