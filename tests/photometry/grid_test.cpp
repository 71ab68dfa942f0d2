// Grids of intensity in CSV and OpenEXR. SPDX-License-Identifier: MIT
#include "photometry/grid.h"

#include <random>

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include "photometry/distributions.h"
#include "photometry/eulumdat.h"
#include "photometry/ies.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using photometry::Distribution, photometry::Goniometry, photometry::read_distribution;

Distribution parsed_grid(const std::string& text) { return photometry::parse_grid_csv(bytes_of(text), "x.csv"); }
std::string grid_complaint(const std::string& text) {
    return complaint_of([&] { parsed_grid(text); });
}

const std::string kPlain = "# a beam\n,-10,0,20\n-5,1,2,3\n5,4,5,6\n";

TEST(Grid, ReadsRowsAndColumns) {
    const Distribution d = parsed_grid(kPlain);
    EXPECT_EQ(d.goniometry, Goniometry::TypeA);
    EXPECT_EQ(d.horizontal, (std::vector<double>{-10, 0, 20}));
    EXPECT_EQ(d.vertical, (std::vector<double>{-5, 5}));
    EXPECT_EQ(d.candela, (std::vector<double>{1, 4, 2, 5, 3, 6}));
    EXPECT_NEAR(photometry::intensity(d, type_a(20, 5)), 6, 1e-9);
}

TEST(Grid, TakesWhatLaboratoriesWrite) {
    const Distribution wanted = parsed_grid(kPlain);
    for (const char* text : {
             "V\\H,-10,0,20\r\n5,4,5,6\r\n-5,1,2,3\r\n",                             // from the top
             "type A,20,0,-10\n5,6,5,4\n-5,3,2,1\n",                                 // from the right, too
             ";-10;0;20\n\n-5;1,0;2,0;3\n5;4;5;6;\n",                                // semicolons and decimal commas
             "\t-10\t0\t20\n-5\t1\t2\t3\n5\t4\t5\t6\n",                              // tabs
             "H_deg,V_deg,cd\n0,5,5\n-10,5,4\n20,5,6\n-10,-5,1\n0,-5,2\n20,-5,3\n",  // a list
             "V_deg,H_deg,cd\n5,0,5\n5,-10,4\n5,20,6\n-5,-10,1\n-5,0,2\n-5,20,3\n",  // in another order, and by other
                                                                                     // names
             "I [cd],\"Vertical angle (deg)\",horizontal [°]\n5,5,0\n4,5,-10\n6,5,20\n1,-5,-10\n2,-5,0\n3,-5,20\n",
             "Luminous intensity/cd;V (\xb0);H\xb0\n5;5;0\n4;5;-10\n6;5;20\n1;-5;-10\n2;-5;0\n3;-5;20\n",
         }) {
        const Distribution d = parsed_grid(text);
        EXPECT_EQ(d.horizontal, wanted.horizontal) << text;
        EXPECT_EQ(d.vertical, wanted.vertical) << text;
        EXPECT_EQ(d.candela, wanted.candela) << text;
        EXPECT_EQ(d.goniometry, Goniometry::TypeA) << text;
    }
    EXPECT_EQ(parsed_grid("B,-10,0\n-5,1,2\n5,4,5\n").goniometry, Goniometry::TypeB);
    EXPECT_EQ(parsed_grid("# goniometry: B\n,-10,0\n-5,1,2\n5,4,5\n").goniometry, Goniometry::TypeB);
    const Distribution c = parsed_grid("gamma\\C,0,90\n0,1,1\n90,4,5\n");
    EXPECT_EQ(c.goniometry, Goniometry::CGamma);
    EXPECT_EQ(c.horizontal, (std::vector<double>{0, 90, 180, 270, 360}));
    for (const char* text : {"C_deg,gamma_deg,cd\n0,0,1\n0,90,0\n", "γ,C-plane,cd\n0,0,1\n90,0,0\n"}) {
        const Distribution list = parsed_grid(text);
        EXPECT_EQ(list.goniometry, Goniometry::CGamma);
        EXPECT_EQ(list.vertical, (std::vector<double>{0, 90})) << text;
    }
}

TEST(Grid, SaysWhereAndWhy) {
    const struct {
        std::string text, wanted;
    } cases[] = {
        {"", "x.csv: line 1: no row of horizontal angles"},
        {replaced(kPlain, "4,5,6", "4,5"), "x.csv: line 4: 2 intensities under 3 horizontal angles"},
        {replaced(kPlain, "4,5,6", "4,five,6"), "line 4: 'five' stands where an intensity"},
        {replaced(kPlain, "4,5,6", "4,inf,6"), "line 4: 'inf'"},
        {replaced(kPlain, "-10,0,20", "-10,20,0"), "line 2: horizontal angles do not ascend"},
        {replaced(kPlain, "-5,1", "-95,1"), "line 3: vertical angle -95 is not in -90 to 90"},
        {replaced(kPlain, ",-10", "7,-10"), "line 2: the corner cell"},
        {"# goniometry: D\n" + kPlain, "line 1: the goniometry"},
        {"H_deg,V_deg,cd\n0,0,1\n0,5,1\n1,0,1\n", "line 2: 2 horizontal and 2 vertical angles, but only 3"},
        {"H_deg,V_deg,cd\n0,0,1\n0,5,1\n1,0,1\n0,0,1\n", "line 5: this pair"},
        {",-10,0,20\n0,1,2,3\n", "one vertical angle"},
        {"," + std::string(10'000, ',') + "\n", "line 1: more columns"},
        {"H_deg,V_deg,lx\n0,0,1\n", "line 1: the heading 'lx' is none of"},
        {"H_deg,V_deg,I [kcd]\n0,0,1\n", "line 1: the heading 'I [kcd]'"},
        {"H_rad,V_rad,cd\n0,0,1\n", "line 1: the heading 'H_rad'"},
        {"H,V,cd/klm\n0,0,1\n", "line 1: the heading 'cd/klm'"},
        {"H,H,cd\n0,0,1\n", "line 1: the headings are not"},
        {"H,gamma,cd\n0,0,1\n", "line 1: the headings are not"},
        {"tan_gamma,0,180\n0,3,3\n2,2,2\n", "line 1: the corner cell is tan gamma"},
        {"H\\V,-10,0\n-5,1,2\n5,4,5\n", "line 1: the corner cell 'H\\V' says that each row has one horizontal angle"},
        {"C_deg/gamma,0,45\n0,1,2\n90,4,5\n", "line 1: the corner cell 'C_deg/gamma' says"},
        {"# lx at 25 m\nE [lx],-10,0\n-5,1,2\n5,4,5\n", "line 2: the corner cell names 'lx'"},
    };
    for (const auto& c : cases) EXPECT_TRUE(contains(grid_complaint(c.text), c.wanted)) << c.text.substr(0, 60);
}

/// Writes a picture of 3 x 2 cd, rows from the top.
void write_picture(const std::filesystem::path& file, const std::string& goniometry, bool numbers = true) {
    Imf::Header header(3, 2);
    header.channels().insert("cd", Imf::Channel(Imf::FLOAT));
    header.insert("horizontalFirst", Imf::FloatAttribute(-10));
    header.insert("horizontalLast", Imf::StringAttribute("30"));
    if (numbers) header.insert("verticalTop", Imf::FloatAttribute(5));
    header.insert("verticalBottom", Imf::FloatAttribute(-5));
    if (!goniometry.empty()) header.insert("goniometry", Imf::StringAttribute(goniometry));
    const float pixels[] = {4, 5, 6, 1, 2, 3};
    Imf::FrameBuffer frame;
    frame.insert("cd", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(pixels)), 4, 12));
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(frame);
    out.writePixels(2);
}

TEST(Grid, ReadsOpenExr) {
    const TempFolder folder;
    write_picture(folder / "a.exr", "");
    const Distribution d = read_distribution(folder / "a.exr");
    EXPECT_EQ(d.goniometry, Goniometry::TypeA);
    EXPECT_EQ(d.name, "a");
    EXPECT_EQ(d.horizontal, (std::vector<double>{-10, 10, 30}));
    EXPECT_EQ(d.vertical, (std::vector<double>{-5, 5}));
    EXPECT_EQ(d.candela, (std::vector<double>{1, 4, 2, 5, 3, 6}));
    write_picture(folder / "b.exr", "B");
    EXPECT_EQ(photometry::read_grid_exr(folder / "b.exr").goniometry, Goniometry::TypeB);
    write_picture(folder / "d.exr", "D");
    EXPECT_TRUE(contains(complaint_of([&] { photometry::read_grid_exr(folder / "d.exr"); }),
                         "d.exr: OpenEXR: its header attribute gonio"));
    write_picture(folder / "e.exr", "", false);
    EXPECT_TRUE(contains(complaint_of([&] { photometry::read_grid_exr(folder / "e.exr"); }), "verticalTop"));

    for (const char* name : {"a.exr", "d.exr", "e.exr"})
        EXPECT_TRUE(photometry::is_grid_exr(bytes_of(read_text(folder / name)))) << name;
    EXPECT_TRUE(photometry::is_grid_exr(bytes_of(read_text(folder / "a.exr").substr(0, 300))));
    EXPECT_FALSE(photometry::is_grid_exr(bytes_of("no OpenEXR file at all")));
    // A header that states more than is there is refused before anything is allocated for it.
    std::string huge = read_text(folder / "a.exr");
    const size_t window = huge.find("dataWindow");
    ASSERT_NE(window, huge.npos);
    huge.replace(window + 11 + 6 + 4 + 8, 4, "\xff\xff\xff\x7f", 4);
    EXPECT_TRUE(
        contains(complaint_of([&] { photometry::parse_grid_exr(bytes_of(huge), "huge.exr"); }), "horizontal angles"));
}

TEST(Grid, DamagedOpenExrGivesAnError) {
    const TempFolder folder;
    write_picture(folder / "a.exr", "B");
    const std::string picture = read_text(folder / "a.exr");
    const auto attempt = [](const std::string& bytes) {
        try {
            const Distribution d = photometry::parse_grid_exr(bytes_of(bytes), "x.exr");
            EXPECT_TRUE(std::isfinite(photometry::luminous_flux(d)));
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    };
    for (size_t size = 0; size < picture.size(); ++size) attempt(picture.substr(0, size));
    std::mt19937 random(3);
    for (int round = 0; round < 3000; ++round) {
        std::string changed = picture;
        for (unsigned i = 0; i <= random() % 3; ++i)
            changed[random() % changed.size()] = static_cast<char>(random() % 3 ? random() : 0xff);
        attempt(changed);
    }
}

TEST(Grid, FilesAreKnownByNameOrContents) {
    const TempFolder folder;
    EXPECT_EQ(read_distribution(folder.write("x.CSV", kPlain)).vertical.size(), 2u);
    EXPECT_EQ(read_distribution(folder.write("grid", kPlain)).vertical.size(), 2u);
    const std::string ies = photometry::write_ies(parsed_grid(kPlain));
    EXPECT_EQ(read_distribution(folder.write("x.IES", ies)).goniometry, Goniometry::TypeA);
    EXPECT_EQ(read_distribution(folder.write("profile.txt", ies)).goniometry, Goniometry::TypeA);
    write_picture(folder / "x.exr", "");
    std::filesystem::rename(folder / "x.exr", folder / "picture");
    EXPECT_EQ(read_distribution(folder / "picture").horizontal.size(), 3u);
    EXPECT_TRUE(contains(complaint_of([&] { read_distribution(folder.write("x.ldt", kPlain)); }), "x.ldt: line "));
    EXPECT_TRUE(contains(complaint_of([&] { read_distribution(folder / "none.ies"); }), "none.ies: cannot be opened"));
}

}  // namespace
}  // namespace vesper::test
