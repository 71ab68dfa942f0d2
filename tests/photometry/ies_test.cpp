// IES files: what each version and symmetry means, the oddities files have, and that writing comes back.
// SPDX-License-Identifier: MIT
#include "photometry/ies.h"

#include <algorithm>
#include <cmath>

#include "photometry/beam.h"
#include "photometry/distributions.h"
#include "support/complaints.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using photometry::Distribution, photometry::Goniometry;

Distribution parsed_ies(const std::string& text) { return photometry::parse_ies(bytes_of(text), "x.ies"); }
std::string ies_complaint(const std::string& text) {
    return complaint_of([&] { parsed_ies(text); });
}

/// A file of 3 gamma angles: 0, 45, 90.
std::string file(const std::string& version, const std::string& horizontal_count, const std::string& horizontal,
                 const std::string& candela, const std::string& ballast = "1 1 20",
                 const std::string& lamps = "1 -1 1") {
    return version + "\n[TEST] 1\n[MANUFAC] M\nTILT=NONE\n" + lamps + " 3 " + horizontal_count + " 1 2 0 0 0\n" +
           ballast + "\n0 45 90\n" + horizontal + "\n" + candela + "\n";
}

const std::string kPlainIes = file("IESNA:LM-63-2002", "1", "0", "100 50 25");

TEST(Ies, ReadsRotationalSymmetry) {
    const Distribution d = parsed_ies(kPlainIes);
    EXPECT_EQ(d.goniometry, Goniometry::CGamma);
    EXPECT_EQ(d.horizontal, std::vector<double>{0});
    EXPECT_EQ(d.vertical, (std::vector<double>{0, 45, 90}));
    EXPECT_EQ(d.candela, (std::vector<double>{100, 50, 25}));
    EXPECT_EQ(d.lamp_flux, 0);
    ASSERT_EQ(d.metadata.size(), 2u);
    EXPECT_EQ(d.metadata[1], (std::pair<std::string, std::string>("MANUFAC", "M")));
}

/// A file of types A (3) or B (2).
std::string file_of_type(int type, const std::string& vertical, const std::string& horizontal,
                         const std::string& candela, const std::string& counts, const std::string& lamps = "1 -1 1") {
    return "IESNA:LM-63-2002\nTILT=NONE\n" + lamps + " " + counts + " " + std::to_string(type) + " 2 0 0 0\n1 1 20\n" +
           vertical + "\n" + horizontal + "\n" + candela + "\n";
}

bool is_noted(const Distribution& d, const std::string& words) {
    return std::any_of(d.notes.begin(), d.notes.end(),
                       [&](const std::string& note) { return note.find(words) != note.npos; });
}

// V from 0 of a luminaire that is bright there: light does not end on a line. All four quadrants are the one.
TEST(Ies, AQuadrantOfTypesAAndBIsMirroredWhereItIsBright) {
    for (const int type : {2, 3}) {
        const Distribution quarter =
            parsed_ies(file_of_type(type, "0 10 20", "0 30", "100 60 10 40 20 0", "3 2", "1 40 1"));
        EXPECT_EQ(quarter.vertical, (std::vector<double>{-20, -10, 0, 10, 20}));
        EXPECT_EQ(quarter.horizontal, (std::vector<double>{-30, 0, 30}));
        EXPECT_EQ(quarter.candela, (std::vector<double>{0, 20, 40, 20, 0, 10, 60, 100, 60, 10, 0, 20, 40, 20, 0}));
        EXPECT_TRUE(is_noted(quarter, "taken for both sides of V = 0"));
        EXPECT_TRUE(is_noted(quarter, "taken for both sides of H = 0"));
        EXPECT_TRUE(is_noted(quarter, " lm in all; the file states 40 lm of lamps"));

        const Distribution whole = parsed_ies(
            file_of_type(type, "-20 -10 0 10 20", "-30 0 30", "0 20 40 20 0 10 60 100 60 10 0 20 40 20 0", "5 3"));
        EXPECT_TRUE(whole.notes.empty());
        EXPECT_NEAR(photometry::luminous_flux(quarter), photometry::luminous_flux(whole), 1e-9);

        const Distribution half = parsed_ies(file_of_type(type, "0 10 20", "-30 30", "100 60 10 40 20 0", "3 2"));
        EXPECT_EQ(half.horizontal, (std::vector<double>{-30, 30}));
        EXPECT_EQ(half.candela, (std::vector<double>{10, 60, 100, 60, 10, 0, 20, 40, 20, 0}));

        const Distribution dark = parsed_ies(file_of_type(type, "0 10 20", "-30 30", "0 60 10 0 20 0", "3 2"));
        EXPECT_EQ(dark.vertical, (std::vector<double>{0, 10, 20}));
        EXPECT_TRUE(is_noted(dark, "below V = 0 there is no light"));
    }
    // A table that is dark below V = 0 comes back as it is.
    Distribution bright = parsed_ies(file_of_type(2, "0 10 20", "-30 30", "0 60 10 0 20 0", "3 2"));
    bright.candela = {100, 60, 10, 40, 20, 0};
    const Distribution back = parsed_ies(photometry::write_ies(bright));
    EXPECT_EQ(back.vertical.front(), -1e-3);
    EXPECT_NEAR(photometry::luminous_flux(back), photometry::luminous_flux(bright), 1e-3);
    for (const double v : {-5.0, 0.0, 7.0})
        EXPECT_NEAR(photometry::intensity_at(back, 10, v), photometry::intensity_at(bright, 10, v), 1e-9) << v;
}

TEST(Ies, TheSharedQuadrantIsMirrored) {
    const auto shared = shared_data("bugs-t3/photometry/type-b-quadrant.ies");
    if (!is_here(shared)) GTEST_SKIP() << "no shared data";
    const Distribution d = photometry::read_distribution(shared);
    EXPECT_NEAR(photometry::luminous_flux(d), 2 * 1044.6, 0.2);
    // On a wall at 5 m: lx at (x, y), m.
    const glm::dvec3 wanted[]{{0, 0, 40.00}, {1, 1, 32.78}, {1, -1, 32.78}, {0, -2, 25.53}, {-2, -1, 26.54}};
    for (const glm::dvec3& each : wanted) {
        const glm::dvec3 way(each.x, each.y, -5);
        EXPECT_NEAR(photometry::intensity(d, way) * 5 / std::pow(glm::length(way), 3), each.z, 0.006) << each.x;
    }
}

// Forms that other programs read in another way are noted, with the light that results.
TEST(Ies, FormsThatReadersDisagreeOnAreNoted) {
    EXPECT_TRUE(parsed_ies(kPlainIes).notes.empty());
    const auto c_file = [](const std::string& gammas, const std::string& planes, const std::string& candela,
                           const std::string& counts, const std::string& lumens) {
        return "IESNA:LM-63-2002\nTILT=NONE\n1 " + lumens + " 1 " + counts + " 1 2 0 0 0\n1 1 20\n" + gammas + "\n" +
               planes + "\n" + candela + "\n";
    };
    const Distribution ends = parsed_ies(c_file("0 40 80", "0", "100 50 25", "3 1", "-1"));
    EXPECT_TRUE(is_noted(ends, "gamma ends at 80 deg with 25 cd"));
    EXPECT_TRUE(is_noted(ends, "states none (absolute)"));
    EXPECT_TRUE(parsed_ies(c_file("0 40 80", "0", "100 50 1", "3 1", "-1")).notes.empty()) << "dark there";
    const Distribution nadir = parsed_ies(c_file("0 45 90", "0 90", "100 50 0 80 40 0", "3 2", "-1"));
    EXPECT_TRUE(is_noted(nadir, "planes differ at the nadir, from 80 to 100 cd"));
    EXPECT_TRUE(parsed_ies(c_file("0 45 90", "0 90", "100 50 0 98 40 0", "3 2", "-1")).notes.empty());
    const std::string four_planes = "100 50 0 100 50 0 100 50 0 100 50 0";
    EXPECT_TRUE(is_noted(parsed_ies(c_file("0 45 90", "0 100 200 250", four_planes, "3 4", "-1")),
                         "C planes end at 250 deg, with a gap"));
    EXPECT_TRUE(parsed_ies(c_file("0 45 90", "0 90 180 270", four_planes, "3 4", "-1")).notes.empty());
    const Distribution more = parsed_ies(c_file("0 45 90", "0", "100 50 25", "3 1", "200"));
    EXPECT_TRUE(is_noted(more, "lm in all; the file states 200 lm of lamps"));
    EXPECT_TRUE(parsed_ies(c_file("0 45 90", "0", "100 50 25", "3 1", "900")).notes.empty());
}

TEST(Ies, MultipliesByWhatTheVersionSays) {
    const auto first = [](const std::string& version, const std::string& ballast) {
        return parsed_ies(file(version, "1", "0", "100 50 25", ballast, "2 500 1.5")).candela[0];
    };
    for (const char* version : {"IESNA:LM-63-1995", "IESNA95", "IESNA91", "IESNA:LM-63-1991", "[TEST] no version"})
        EXPECT_NEAR(first(version, "0.8 0.9 20"), 100 * 1.5 * 0.8 * 0.9, 1e-9) << version;
    for (const char* version : {"IESNA:LM-63-2002", "IES:LM-63-2019"})
        EXPECT_NEAR(first(version, "0.8 1.1 20"), 100 * 1.5 * 0.8, 1e-9) << version;
    EXPECT_EQ(parsed_ies(file("IESNA91", "1", "0", "1 1 1", "1 1 20", "2 500 1.5")).lamp_flux, 1000);
}

TEST(Ies, ExpandsSymmetry) {
    const auto at = [](const Distribution& d, double c) { return photometry::intensity(d, c_gamma(c, 45)); };
    // Values at gamma 45: the plane's angle.
    const std::string three = "1 0 0\n1 45 0\n1 90 0";
    const Distribution quadrant = parsed_ies(file("IESNA:LM-63-2002", "3", "0 45 90", three));
    EXPECT_EQ(quadrant.horizontal, (std::vector<double>{0, 45, 90, 135, 180, 225, 270, 315, 360}));
    for (const auto& [c, wanted] : {std::pair(30.0, 30.0), {150.0, 30.0}, {210.0, 30.0}, {330.0, 30.0}, {90.0, 90.0}})
        EXPECT_NEAR(at(quadrant, c), wanted, 1e-9) << c;
    const Distribution half = parsed_ies(file("IESNA:LM-63-2002", "3", "0 60 180", "1 0 0\n1 60 0\n1 180 0"));
    EXPECT_EQ(half.horizontal, (std::vector<double>{0, 60, 180, 300, 360}));
    for (const auto& [c, wanted] : {std::pair(30.0, 30.0), {330.0, 30.0}, {240.0, 120.0}})
        EXPECT_NEAR(at(half, c), wanted, 1e-9) << c;
    const Distribution across =
        parsed_ies(file("IESNA:LM-63-1995", "4", "90 120 180 270", "1 90 0\n1 120 0\n1 180 0\n1 270 0"));
    EXPECT_EQ(across.horizontal, (std::vector<double>{0, 60, 90, 120, 180, 270, 360}));
    for (const auto& [c, wanted] :
         {std::pair(0.0, 180.0), {45.0, 135.0}, {315.0, 225.0}, {225.0, 225.0}, {100.0, 100.0}})
        EXPECT_NEAR(at(across, c), wanted, 1e-9) << c;
    const Distribution whole = parsed_ies(file("IES:LM-63-2019", "3", "0 120 360", "1 10 0\n1 130 0\n1 10 0"));
    EXPECT_NEAR(at(whole, 240), 70, 1e-9);
    // Without the closing plane.
    const Distribution open = parsed_ies(file("IES:LM-63-2019", "3", "0 120 240", "1 10 0\n1 130 0\n1 250 0"));
    EXPECT_EQ(open.horizontal.back(), 360);
    EXPECT_NEAR(at(open, 300), 130, 1e-9);
    EXPECT_TRUE(contains(ies_complaint(file("IES:LM-63-2019", "2", "0 100", "1 1 1 1 1 1")), "C planes from 0 to 100"));
    // What is missing is no more than a closing plane.
    EXPECT_TRUE(contains(
        ies_complaint(file("IES:LM-63-2019", "3", "0 95 190", "1 1 1\n1 1 1\n1 1 1")),
        "C planes from 0 to 190 are no range that is defined (0 to 90, 180 or 360; 90 to 270), and do not go round"));
    EXPECT_NO_THROW(parsed_ies(file("IES:LM-63-2019", "3", "0 95 240", "1 1 1\n1 1 1\n1 1 1")));
    // Both ends are one plane.
    const std::string ends = file("IES:LM-63-2019", "3", "0 120 360", "1 100 0\n1 50 0\n1 91 0");
    EXPECT_NEAR(at(parsed_ies(ends), 0), 95.5, 1e-9);
    EXPECT_TRUE(contains(ies_complaint(replaced(ends, "1 91 0", "1 89 0")),
                         "line 11: C0 and C360 are one plane, but at gamma 45 have 100 and 89 cd"));
}

TEST(Ies, KnowsVersionLinesFromLabels) {
    const auto first = [](const std::string& start) {
        return parsed_ies(replaced(file("IESNA91", "1", "0", "100 50 25", "1 0.8 20"), "IESNA91\n", start)).candela[0];
    };
    for (const char* old :
         {"", "IES PHOTOMETRIC REPORT NO. 4711\n", "IES 99\n", "IESNA91\n", "IESNA86\n", "iesna:lm-63-1995\n",
          "\n\nIESNA:LM-63-1995\n", "IESNA:LM63-1995\n", "IESNA LM 63 95\n", "IESNA REPORT 2002\n"})
        EXPECT_NEAR(first(old), 80, 1e-9) << old;
    for (const char* since : {"IESNA02\n", "\n \nIES:LM-63-2019\n", "ies:lm-63-2019\n", "IESNA:LM-63-2002\n",
                              "IES:LM-63-2031\n", "IESNA:LM63-2002\n", "IESNA LM 63-2002\n", "IESNA:LM-63\n"})
        EXPECT_NEAR(first(since), 100, 1e-9) << since;
    EXPECT_EQ(parsed_ies(replaced(file("", "1", "0", "1 1 1"), "\n[TEST]", "IES REPORT 12\n[TEST]")).name,
              "IES REPORT 12");
}

// LM-63-2002 and -2019, Table 1: what lies, and what stands, in m.
TEST(Ies, CylindersLieAndDiscsStand) {
    const auto opening = [](const char* version, const char* sizes) {
        return parsed_ies(replaced(file(version, "1", "0", "1 1 1"), "1 2 0 0 0", std::string("1 2 ") + sizes)).opening;
    };
    for (const char* version : {"IESNA:LM-63-2002", "IES:LM-63-2019"}) {
        EXPECT_NEAR(opening(version, "-2 3 -2").area(), 6, 1e-12);
        EXPECT_NEAR(opening(version, "3 -2 -2").area(), 6, 1e-12);
        EXPECT_EQ(opening(version, "-2 0 -2").area(), 0) << "a disc that stands has no area from below";
        EXPECT_NEAR(opening(version, "-2 -2 0").area(), 3.14159265, 1e-6);
        EXPECT_NEAR(opening(version, "-2 -2 -2").area(), 3.14159265, 1e-6) << "a sphere";
    }
    EXPECT_NEAR(opening("IESNA:LM-63-1995", "-2 3 -2").area(), 3.14159265 * 1.5, 1e-6) << "an ellipsoid";
}

TEST(Ies, ReadsTypesBAndA) {
    const std::string mirrored_half =
        replaced(file("IESNA:LM-63-2002", "2", "0 30", "1 2 3\n4 5 6"), "3 2 1 2 0", "3 2 3 2 0");
    const Distribution a = parsed_ies(replaced(mirrored_half, "0 45 90", "-10 0 90"));
    EXPECT_EQ(a.goniometry, Goniometry::TypeA);
    EXPECT_EQ(a.horizontal, (std::vector<double>{-30, 0, 30}));
    EXPECT_EQ(a.candela, (std::vector<double>{4, 5, 6, 1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(a.vertical.front(), -10);
    const Distribution b = parsed_ies(replaced(replaced(mirrored_half, "3 2 3 2 0", "3 2 2 2 0"), "0 30", "-20 30"));
    EXPECT_EQ(b.goniometry, Goniometry::TypeB);
    EXPECT_EQ(b.horizontal, (std::vector<double>{-20, 30}));
    EXPECT_TRUE(contains(ies_complaint(replaced(kPlainIes, "3 1 1 2 0", "3 1 3 2 0")), "one horizontal angle"));
}

TEST(Ies, TakesWhatFilesReallyHold) {
    const auto same = [](const std::string& text) {
        const Distribution d = parsed_ies(text);
        EXPECT_EQ(d.vertical, (std::vector<double>{0, 45, 90})) << text;
        EXPECT_EQ(d.candela, (std::vector<double>{100, 50, 25})) << text;
    };
    std::string windows, mac;
    for (const char c : kPlainIes)
        windows += c == '\n' ? std::string("\r\n") : std::string(1, c), mac += c == '\n' ? '\r' : c;
    same(windows);
    same(mac);
    same("\xef\xbb\xbf" + kPlainIes);
    same(replaced(kPlainIes, "TILT=NONE", "tilt = none"));
    same(replaced(kPlainIes, "0 45 90", "0,45,\n 90,"));
    same(replaced(kPlainIes, "100 50 25", "100 50\n\n 25\nEND OF DATA 3\n\x1a"));
    same(replaced(replaced(replaced(kPlainIes, "3 1 1 2", "4 1 1 2"), "0 45 90", "0 45 90 90"), "50 25", "50 25 25"));
    same(replaced(kPlainIes, "1 -1 1 3", "1 -1 1.0e0 3.0"));
    same(replaced(kPlainIes, "1 -1 1 3", "0 -1 1 3"));
    same(replaced(kPlainIes, "1 -1 1 3", "-1 -1 1 3"));
    same(replaced(kPlainIes, "100 50 25", "100 50" + std::string(70, '0') + "e-70 25." + std::string(400, '0')));
    EXPECT_EQ(parsed_ies(replaced(kPlainIes, "100 50 25", "100 50 1e-400")).candela.back(), 0);
    EXPECT_EQ(parsed_ies(replaced(kPlainIes, "100 50 25", "100 50 0." + std::string(400, '0') + "1")).candela.back(),
              0);
    same(replaced(kPlainIes, "IESNA:LM-63-2002\n", ""));
    same(replaced(kPlainIes, "IESNA:LM-63-2002\n[TEST] 1\n[MANUFAC] M\n", ""));
    // Decimal commas.
    EXPECT_EQ(parsed_ies(replaced(kPlainIes, "100 50 25", "100,5 50 25,25")).candela,
              (std::vector<double>{100.5, 50, 25.25}));
    // Noise below nothing; small negatives only.
    EXPECT_EQ(parsed_ies(replaced(kPlainIes, "50 25", "50 -0.2")).candela.back(), 0);
    EXPECT_TRUE(contains(ies_complaint(replaced(kPlainIes, "50 25", "50 -20")), "x.ies: line 9: a negative intensity"));
}

TEST(Ies, TextBecomesUtf8) {
    const Distribution d =
        parsed_ies(replaced(kPlainIes, "[MANUFAC] M", "[manufac] R\xe9verb\xe8re\n[MORE] SA\n[LUMINAIRE] réseau"));
    EXPECT_EQ(d.metadata[1].first, "MANUFAC");
    EXPECT_EQ(d.metadata[1].second, "Réverbère\nSA");
    EXPECT_EQ(d.name, "réseau");
}

// As Windows programs save "Unicode" text.
TEST(Ies, ReadsUtf16OfBothByteOrders) {
    const TempFolder folder;
    for (const bool big : {false, true}) {
        const std::string text = replaced(kPlainIes, "[MANUFAC] M", "[MANUFAC] R\xe9verb\xe8re");
        const Distribution d = parsed_ies(utf16_of(text, big));
        EXPECT_EQ(d.candela, (std::vector<double>{100, 50, 25}));
        EXPECT_EQ(d.metadata.at(1).second, "R\u00e9verb\u00e8re");
        EXPECT_TRUE(contains(ies_complaint(utf16_of(replaced(kPlainIes, "50 25", "fifty 25"), big)),
                             "x.ies: line 9: 'fifty' stands where an intensity is expected"));
        std::string windows;
        for (const char c : kPlainIes) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
        EXPECT_EQ(parsed_ies(utf16_of(windows, big) + "\x01").candela.size(), 3u) << "an odd byte at the end";
        EXPECT_EQ(photometry::read_distribution(folder.write("profile.txt", utf16_of(text, big))).candela, d.candela);
    }
    // A name of two units, and halves of such pairs.
    const std::string start = utf16_of("TEST\n[LUMINAIRE] ", true), rest = utf16_of(kPlainIes, true).substr(2);
    const auto name = [&](const std::string& units) {
        return parsed_ies(start + units + std::string("\0\n", 2) + rest).name;
    };
    EXPECT_EQ(name(std::string("\xd8\x3d\xde\x00", 4)), "\U0001f600");
    EXPECT_EQ(name("\xd8\x3d"), "\ufffd");
    EXPECT_EQ(name(std::string("\xde\x00", 2)), "\ufffd");
}

TEST(Ies, AppliesTiltForTheLampAsMeasured) {
    const std::string table = "1\n3\n-30 10 20\n0.6 1.0 0.9\n";
    EXPECT_NEAR(parsed_ies(replaced(kPlainIes, "TILT=NONE\n", "TILT=INCLUDE\n" + table)).candela[0], 90, 1e-9);
    EXPECT_NEAR(parsed_ies(replaced(kPlainIes, "TILT=NONE\n", "TILT=INCLUDE\n1 2 0 45 1 0.5\n")).candela[0], 100, 1e-9);
    EXPECT_TRUE(
        contains(ies_complaint(replaced(kPlainIes, "TILT=NONE\n", "TILT=INCLUDE\n1 2 45 0 1 0.5\n")), "do not ascend"));

    const TempFolder folder;
    const auto lamp = folder.write("lamp.ies", replaced(kPlainIes, "TILT=NONE", "TILT=lamp.tlt"));
    EXPECT_TRUE(contains(complaint_of([&] { photometry::read_ies(lamp); }), "line 4: TILT=lamp.tlt"));
    folder.write("lamp.tlt", table);
    EXPECT_NEAR(photometry::read_ies(lamp).candela[0], 90, 1e-9);
    EXPECT_EQ(photometry::read_ies(lamp).name, "lamp");
    const auto outside = folder.write("outside.ies", replaced(kPlainIes, "TILT=NONE", "TILT=../lamp.tlt"));
    EXPECT_TRUE(contains(complaint_of([&] { photometry::read_ies(outside); }), "neither NONE"));
    EXPECT_NEAR(parsed_ies(replaced(kPlainIes, "TILT=NONE", "TILT=lamp.tlt")).candela[0], 100,
                1e-9);  // no folder to look in
}

TEST(Ies, ReadsTheLuminousOpening) {
    const auto opening = [](const std::string& units, const std::string& size) {
        return parsed_ies(replaced(kPlainIes, "2 0 0 0\n", units + " " + size + "\n")).opening;
    };
    photometry::LuminousOpening o = opening("2", "0.3 1.2 0");
    EXPECT_EQ(o.length, 1.2);
    EXPECT_EQ(o.width, 0.3);
    EXPECT_FALSE(o.round);
    o = opening("1", "1 2 -0");
    EXPECT_NEAR(o.length, 0.6096, 1e-12);
    EXPECT_NEAR(o.width, 0.3048, 1e-12);
    for (const char* circle : {"-0.2 -0.2 0", "-0.2 0 0"}) {
        o = opening("2", circle);
        EXPECT_TRUE(o.round);
        EXPECT_NEAR(o.area(), kPi * 0.01, 1e-12) << circle;
    }
    o = opening("2", "0 1.2 -0.1");  // 1995: a tube along the length
    EXPECT_NEAR(o.area(), 0.12, 1e-12);
    EXPECT_EQ(opening("2", "0 0 0").area(), 0);
}

TEST(Ies, SaysWhereAndWhy) {
    const struct {
        const char *what, *with, *wanted;
    } cases[] = {
        {"TILT=NONE", "", "x.ies: line 10: the file ends without a line TILT="},
        {"100 50 25", "100 50", "x.ies: line 10: the file ends where an intensity is expected"},
        {"100 50 25", "100 fifty 25", "x.ies: line 9: 'fifty' stands where an intensity is expected"},
        {"100 50 25", "100 50 25 12", "line 9: more intensities than the 3 x 1 stated"},
        {"100 50 25", "100 1e999 25", "line 9: '1e999'"},
        {"100 50 25", "100 nan 25", "line 9: 'nan'"},
        {"0 45 90", "0 45 40", "line 7: gamma angles do not ascend: 40 follows 45"},
        {"0 45 90", "0 45 190", "line 7: gamma angle 190 is not in 0 to 180"},
        {"1 -1 1 3 1", "1 -1 1 3.5 1", "line 5: 3.5 vertical angles"},
        {"1 -1 1 3 1", "1 -1 1 3 99999999", "line 5: 1e+08 horizontal angles"},
        {"1 -1 1 3 1", "1 -1 1 1 1", "line 5: one vertical angle"},
        {"1 -1 1 3 1", "1 -1 0 3 1", "line 5: the candela multiplier must be more than 0"},
        {"1 -1 1 3 1 1 2 0 0 0\n1", "1 -1 -1 3 1 1 2 0 0 0\n-1", "line 5: the candela multiplier"},
        {"0 0 0\n1 1 20", "0 0 0\n-1 1 20", "line 6: the ballast factor must be more than 0"},
        {"1 1 20\n", "", "line 6: the electrical line is missing (ballast factor, ballast-lamp factor, input watts)"},
        {"1 1 20\n0 45 90", "-90 0 90", "line 6: the electrical line is missing"},
        {"1 1 20\n0 45 90", "90 120 180", "line 6: the electrical line is missing"},
        {"1 1 20\n0 45 90\n0\n100 50 25", "", "line 6: the electrical line is missing"},
        {"\n0\n100 50 25", "", "line 8: the file ends where a horizontal angle is expected"},
        {"100 50 25", "", "line 10: the file ends where an intensity is expected"},
        {"1 -1 1 3 1", "1 -1 1e9 3 1", "line 6: multiplier"},
        {"1 -1 1 3 1", "-7 -1 1 3 1", "line 5: the number of lamps"},
        {"1 -1 1 3 1", "1.5 -1 1 3 1", "line 5: the number of lamps"},
        {"TILT=NONE", "TILT=INCLUDE\n7\n2\n0 45\n1 0.9",
         "line 5: the lamp-to-luminaire geometry is none of 1, 2 and 3"},
        {"0 45 90", "0 45 45", "line 7: gamma angle 45 is there twice, with other intensities"},
        {"1 -1 1 3 1 1 2", "1 -1 1 3 1 4 2", "line 5: the photometric type"},
        {"1 -1 1 3 1 1 2", "1 -1 1 3 1 1 3", "line 5: the type of units"},
    };
    for (const auto& c : cases)
        EXPECT_TRUE(contains(ies_complaint(replaced(kPlainIes, c.what, c.with)), c.wanted)) << c.with;
    EXPECT_TRUE(contains(ies_complaint(file("IES:LM-63-2019", "2", "0 0", "100 50 25 100 60 25")),
                         "line 8: C angle 0 is there twice, with other intensities"));
    EXPECT_EQ(parsed_ies(file("IES:LM-63-2019", "2", "0 0", "100 50 25 100 50 25")).horizontal.size(), 1u);
    EXPECT_TRUE(contains(ies_complaint(""), "x.ies: line 1: the file ends"));
    const std::string many(60'000, '\n');
    EXPECT_TRUE(contains(ies_complaint(many + kPlainIes), "no line TILT= in the first"));
}

TEST(Ies, WritingComesBack) {
    const auto candela = [](double h, double v) { return 1234.5678 / (1 + std::abs(h) + v * v / 3); };
    std::vector<Distribution> all = {
        tabulate(Goniometry::CGamma, {0}, {0, 22.5, 90.125}, candela),
        tabulate(Goniometry::CGamma, {0, 90.5, 180, 270, 360}, {0, 90, 180},
                 [&](double h, double v) { return candela(std::fmod(h, 360), v); }),
        tabulate(Goniometry::TypeA, {-12.25, 0, 3, 20}, {-90, -0.57, 1e-3, 12}, candela),
        tabulate(Goniometry::TypeB, {-12.25, 0, 3, 20}, {-90, 0, 12}, candela),
    };
    all[0].opening = {0.2, 0.2, 0.1, true};
    all[0].lamp_flux = 850;
    all[1].opening = {1.2, 0.3, 0, false};
    all[1].metadata = {{"MANUFAC", "Réverbère\nSA"}, {"LUMINAIRE", "made"}};
    for (const Distribution& d : all) {
        const std::string text = photometry::write_ies(d);
        const Distribution back = parsed_ies(text);
        EXPECT_EQ(back.goniometry, d.goniometry);
        EXPECT_EQ(back.name, d.name);
        EXPECT_EQ(back.lamp_flux, d.lamp_flux);
        EXPECT_EQ(back.horizontal, d.horizontal);
        EXPECT_EQ(back.vertical, d.vertical);
        ASSERT_EQ(back.candela.size(), d.candela.size());
        for (size_t i = 0; i < d.candela.size(); ++i)
            EXPECT_EQ(static_cast<float>(back.candela[i]), static_cast<float>(d.candela[i]));
        EXPECT_NEAR(back.opening.area(), d.opening.area(), 1e-12);
        EXPECT_EQ(back.opening.height, d.opening.height);
        EXPECT_EQ(photometry::write_ies(back), text);  // nothing drifts
        for (size_t at = 0; at < text.size();) {
            const size_t end = text.find("\r\n", at);
            EXPECT_LE(end - at, 256u);
            at = end + 2;
        }
    }
    // A range that begins at H = 0 is not taken for a half.
    const Distribution right = tabulate(Goniometry::TypeA, {0, 10}, {-5, 5}, [](double, double) { return 7.0; });
    const Distribution back = parsed_ies(photometry::write_ies(right));
    EXPECT_EQ(photometry::intensity(back, type_a(5, 0)), 7);
    EXPECT_EQ(photometry::intensity(back, type_a(-5, 0)), 0);
    EXPECT_NEAR(photometry::luminous_flux(back), photometry::luminous_flux(right),
                1e-3 * photometry::luminous_flux(right));
}

}  // namespace
}  // namespace vesper::test
