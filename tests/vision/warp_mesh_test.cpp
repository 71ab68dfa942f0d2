// Warp meshes: what is read, and where others are refused. SPDX-License-Identifier: MIT
#include "vision/warp_mesh.h"

#include <gtest/gtest.h>

#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test::warp_mesh_test {
namespace {

using vision::WarpMesh;

WarpMesh parse(const std::string& text) {
    return vision::parse_warp_mesh({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, "x.data");
}

const std::string kNodes = "-1.6 -1 0 0 1\n1.6 -1 1 0 0.5\n-1.6 1 0 1 1\n1.6 1 1 1 -1\n-1.6 3 0 1 0\n1.6 3 1 1 1\n";

TEST(WarpMesh, IsReadInItsOrder) {
    const TempFolder folder;
    const WarpMesh mesh = vision::read_warp_mesh(folder.write("a.data", "2\n2 3\n" + kNodes));
    EXPECT_EQ(mesh.name, (folder / "a.data").string());
    EXPECT_EQ(mesh.columns, 2u);
    EXPECT_EQ(mesh.rows, 3u);
    ASSERT_EQ(mesh.nodes.size(), 6u);
    const vision::WarpNode& second = mesh.nodes[1];
    EXPECT_EQ(second.x, 1.6);
    EXPECT_EQ(second.y, -1);
    EXPECT_EQ(second.u, 1);
    EXPECT_EQ(second.v, 0);
    EXPECT_EQ(second.intensity, 0.5);
    EXPECT_EQ(mesh.nodes[3].intensity, -1);
    EXPECT_EQ(mesh.nodes[5].y, 3) << "beyond the picture, as of screens that are overshot";
}

TEST(WarpMesh, BlanksAndEndsOfLinesDoNotCount) {
    const WarpMesh plain = parse("2\n2 3\n" + kNodes);
    std::string text =
                    "\xef\xbb\xbf"
                    "2\n2 3\n" +
                    kNodes,
                other;
    for (const char c : text) other += c == '\n' ? "  \r\n\r\n" : c == ' ' ? "\t  " : std::string(1, c);
    const WarpMesh spaced = parse(other);
    ASSERT_EQ(spaced.nodes.size(), plain.nodes.size());
    for (size_t i = 0; i < plain.nodes.size(); ++i) {
        EXPECT_EQ(spaced.nodes[i].x, plain.nodes[i].x);
        EXPECT_EQ(spaced.nodes[i].intensity, plain.nodes[i].intensity);
    }
    EXPECT_NO_THROW(parse("2\n2 3\n" + kNodes.substr(0, kNodes.size() - 1))) << "no end of the last line";
}

// Nodes that are not drawn have any place in the rendered picture.
TEST(WarpMesh, NodesThatAreNotDrawnMayShowNothing) {
    EXPECT_NO_THROW(parse("2\n2 2\n0 0 0 0 1\n1 0 1 0 1\n0 1 0 1 1\n1 1 -7 9 -1\n"));
    EXPECT_NE(complaint_of([] { parse("2\n2 2\n0 0 0 0 1\n1 0 1 0 1\n0 1 0 1 1\n1 1 -7 9 1\n"); }), "");
}

TEST(WarpMesh, OthersAreRefusedWhereTheyAreWrong) {
    const std::string start = "2\n2 2\n0 0 0 0 1\n";
    const std::vector<std::pair<std::string, std::string>> faults{
        {"", "x.data: line 1: the file ends where the type of the mesh stands"},
        {"1\n2 2\n", "line 1: meshes of type 1 are not read"},
        {"2 2\n", "line 1: the type of the mesh has no more than 1 numbers"},
        {"2\n2\n", "line 2: the size of the mesh has 2 numbers, not 1"},
        {"2\n1 2\n", "line 2: a mesh has 2 to 1024 columns, not 1"},
        {"2\n2 1025\n", "line 2: a mesh has 2 to 1024 rows, not 1025"},
        {"2\n2.5 2\n", "2 to 1024 columns, not 2.5"},
        {"2\n1e9 2\n", "2 to 1024 columns"},
        {start, "line 4: the file ends where node 2 of 4 stands"},
        {start + "1 0 1 0\n", "line 4: node 2 of 4 has 5 numbers, not 4"},
        {start + "1 0 1 0 1 1\n", "line 4: node 2 of 4 has no more than 5 numbers"},
        {start + "1 x 1 0 1\n", "line 4: 'x' is no number; node 2 of 4 is expected"},
        {start + "1 0,5 1 0 1\n", "'0,5' is no number"},
        {start + "1 nan 1 0 1\n", "'nan' is no number"},
        {start + "1 inf 1 0 1\n", "'inf' is no number"},
        {start + "101 0 1 0 1\n", "line 4: x is 101, not -100 to 100"},
        {start + "1 -101 1 0 1\n", "y is -101, not -100 to 100"},
        {start + "1 0 1.01 0 1\n", "u is 1.01, not 0 to 1"},
        {start + "1 0 1 -0.01 1\n", "v is -0.01, not 0 to 1"},
        {start + "1 0 101 0 -1\n", "u is 101, not -100 to 100"},
        {start + "1 0 1 0 1.01\n", "the intensity is 1.01, not 0 to 1"},
        {"2\n2 3\n" + kNodes + "\n0 0 0 0 1\n", "line 10: the mesh ends before this line"},
    };
    for (const auto& [text, wanted] : faults)
        EXPECT_TRUE(contains(complaint_of([&, &text = text] { parse(text); }), wanted)) << text;
    EXPECT_TRUE(contains(complaint_of([] { vision::read_warp_mesh("/no/such/mesh.data"); }), "/no/such/mesh.data"));
}

}  // namespace
}  // namespace vesper::test::warp_mesh_test
