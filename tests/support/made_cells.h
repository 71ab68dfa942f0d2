// Cells of radiosity that no scene has, made up one by one. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <vector>

#include "transport/radiosity.h"

namespace vesper::test {

/// Cells with a value each, in any order; as a Radiosity they have numbers, heights, normals, walls and cuts, and
/// nothing else.
struct MadeCells {
    transport::CellGrid grid;
    struct Cell {
        float height;  // m
        glm::vec3 light;
        uint8_t walls;  // bits, as in Radiosity
        glm::vec3 normal;
        transport::CellCut cut;
    };
    std::map<uint32_t, Cell> cells;  // by number

    static glm::vec3 normal_of(uint32_t facing) { return glm::vec3(transport::direction_of(facing)); }
    void add(glm::dvec3 cube, uint32_t facing, double height, glm::vec3 light, uint8_t walls = 0) {
        add(cube, facing, normal_of(facing), height, light, walls);
    }
    void add(glm::dvec3 cube, uint32_t facing, glm::vec3 normal, double height, glm::vec3 light, uint8_t walls = 0,
             transport::CellCut cut = {}) {
        cells[grid.cell(cube, facing).value()] = {float(height), light, walls, normal, cut};
    }
    void add_air(glm::dvec3 cube, uint32_t side, glm::vec3 light) {
        cells[grid.air_cell(cube, side).value()] = {0, light, 0, normal_of(side), {}};
    }

    transport::Radiosity radiosity() const {
        transport::Radiosity radiosity;
        radiosity.grid = grid;
        for (const auto& [number, cell] : cells) {
            radiosity.numbers.push_back(number), radiosity.heights.push_back(cell.height);
            radiosity.walls.push_back(cell.walls), radiosity.cuts.push_back(cell.cut);
            radiosity.normals.push_back(cell.normal);
        }
        return radiosity;
    }
    std::vector<glm::vec3> light() const {
        std::vector<glm::vec3> light;
        for (const auto& [number, cell] : cells) light.push_back(cell.light);
        return light;
    }
};

}  // namespace vesper::test
