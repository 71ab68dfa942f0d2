// Small OpenDRIVE files for tests. SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

#include "roads/opendrive.h"

namespace vesper::test {
inline std::string quantity(const char* name, double value) {
    char text[64];
    std::snprintf(text, sizeof text, " %s=\"%.17g\"", name, value);
    return text;
}

/// A geometry element; `shape` is its child.
inline std::string geometry(double s, double x, double y, double heading, double length, const std::string& shape) {
    return "<geometry" + quantity("s", s) + quantity("x", x) + quantity("y", y) + quantity("hdg", heading) +
           quantity("length", length) + ">" + shape + "</geometry>\n";
}

inline std::string lane(int id, double width, const std::string& type = "driving", const std::string& inside = "") {
    return "<lane id=\"" + std::to_string(id) + "\" type=\"" + type + "\">" + inside + "<width sOffset=\"0\"" +
           quantity("a", width) + "/></lane>\n";
}

/// Two driving lanes of 3.5 m, each with a pavement of 2 m, 0.12 m high.
inline std::string two_way_section(double s = 0, const std::string& left_link = "",
                                   const std::string& right_link = "") {
    const std::string high = "<height sOffset=\"0\" inner=\"0.12\" outer=\"0.12\"/>";
    return "<laneSection" + quantity("s", s) + "><left>" + lane(2, 2, "sidewalk", high) +
           lane(1, 3.5, "driving", left_link) + "</left><center><lane id=\"0\"/></center><right>" +
           lane(-1, 3.5, "driving", right_link) + lane(-2, 2, "sidewalk", high) + "</right></laneSection>\n";
}

inline std::string road(const std::string& id, double length, const std::string& plan, const std::string& lanes,
                        const std::string& rest = "", const std::string& attributes = "") {
    return "<road id=\"" + id + "\"" + quantity("length", length) + " " + attributes + ">\n" + rest + "<planView>" +
           plan + "</planView>\n<lanes>" + lanes + "</lanes></road>\n";
}

inline std::string opendrive(const std::string& inside) {
    return "<?xml version=\"1.0\"?>\n<OpenDRIVE>\n<header revMajor=\"1\" revMinor=\"7\"/>\n" + inside +
           "</OpenDRIVE>\n";
}

inline roads::RoadNetwork network_of(const std::string& inside) {
    return roads::parse_opendrive(opendrive(inside), "test.xodr");
}

}  // namespace vesper::test
