// r-tables: the standard ones against what CIE 144:2001 publishes of them, interpolation, extension, damaged files.
// SPDX-License-Identifier: MIT
#include "photometry/reflection_table.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "photometry/distributions.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using photometry::ReflectionTable, photometry::find_reflection_table, photometry::reduced_luminance_coefficient;

ReflectionTable parse(std::string_view text) {
    return photometry::parse_reflection_table({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, "t.csv");
}

/// q the same in all directions.
ReflectionTable lambert(double q) {
    ReflectionTable table{.name = "lambert", .beta = {0, 180}};
    for (int i = 0; i <= 4000; ++i) {
        const double t = i * 0.005;
        table.tan_gamma.push_back(t);
        for (int b = 0; b < 2; ++b) table.r.push_back(q * std::pow(1 + t * t, -1.5));
    }
    return table;
}

TEST(ReflectionTable, StandardTablesHaveTheirPublishedFactors) {
    // Q0, S1 and S2 = Q0 / q(0) of CIE 144:2001.
    const struct {
        const char* name;
        double q0, s1, s2;
    } published[] = {{"R1", 0.10, 0.25, 1.53}, {"R2", 0.07, 0.58, 1.80}, {"R3", 0.07, 1.11, 2.38},
                     {"R4", 0.08, 1.55, 3.03}, {"C1", 0.10, 0.24, 0},    {"C2", 0.07, 0.97, 0},
                     {"W3", 0.20, 8.65, 0},    {"W4", 0.25, 10.84, 0}};
    EXPECT_EQ(photometry::standard_reflection_tables().size(), std::size(published));
    for (const auto& p : published) {
        const ReflectionTable table = find_reflection_table(p.name);
        EXPECT_EQ(table.tan_gamma.size(), 29u) << p.name;
        EXPECT_EQ(table.beta.size(), 20u) << p.name;
        EXPECT_EQ(table.stated_q0, p.q0) << p.name;
        EXPECT_NEAR(photometry::average_luminance_coefficient(table) / p.q0, 1.015, 0.015) << p.name;
        EXPECT_NEAR(photometry::specular_factor(table), p.s1, 0.006) << p.name;
        if (p.s2 > 0) {
            EXPECT_NEAR(table.stated_q0 / table.r.front(), p.s2, 0.006) << p.name;
        }
        EXPECT_EQ(photometry::rescaled(table, p.q0), table) << p.name;
    }
}

TEST(ReflectionTable, R3HasTheNumbersOfTheStandard) {
    const ReflectionTable r3 = find_reflection_table("R3");
    EXPECT_DOUBLE_EQ(reduced_luminance_coefficient(r3, 0, 77), 294e-4);
    EXPECT_DOUBLE_EQ(reduced_luminance_coefficient(r3, 2, 0), 326e-4);
    EXPECT_DOUBLE_EQ(reduced_luminance_coefficient(r3, 2, 30), 71e-4);
    EXPECT_DOUBLE_EQ(reduced_luminance_coefficient(r3, 12, 15), 1.8e-4);
    EXPECT_DOUBLE_EQ(reduced_luminance_coefficient(r3, 5, 180), 7.1e-4);
    EXPECT_DOUBLE_EQ(photometry::luminance_coefficient(r3, 2, 0), 326e-4 * std::pow(5, 1.5));
}

TEST(ReflectionTable, IsBilinear) {
    const ReflectionTable table = parse("t,0,90,180\n0,10,10,10\n1,8,4,\n");
    EXPECT_NEAR(reduced_luminance_coefficient(table, 0.5, 45), 8e-4, 1e-15);   // (10 + 6) / 2
    EXPECT_NEAR(reduced_luminance_coefficient(table, 0.5, -45), 8e-4, 1e-15);  // the other side of the road
    EXPECT_NEAR(reduced_luminance_coefficient(table, 0.5, 315), 8e-4, 1e-15);
    EXPECT_NEAR(reduced_luminance_coefficient(table, 1, 135), 2e-4, 1e-15);  // towards the empty field
    EXPECT_EQ(reduced_luminance_coefficient(table, 1.0001, 0), 0);
    EXPECT_NEAR(reduced_luminance_coefficient(photometry::extended(table), 1.0001, 0), 8e-4, 1e-6);
}

TEST(ReflectionTable, AverageOfLambertIsItsCoefficient) {
    EXPECT_NEAR(photometry::average_luminance_coefficient(lambert(0.05)), 0.05, 1e-5);
    const ReflectionTable half = photometry::rescaled(lambert(0.05), 0.025);
    EXPECT_NEAR(photometry::luminance_coefficient(half, 3, 10), 0.025, 1e-6);
    EXPECT_EQ(half.stated_q0, 0.025);
    EXPECT_THROW(photometry::rescaled(lambert(0.05), 0), Error);
    EXPECT_THROW(photometry::rescaled(lambert(0.05), std::numeric_limits<double>::quiet_NaN()), Error);
}

// A sum over directions of its own, 0.5 degrees apart.
TEST(ReflectionTable, LightFromAllSidesIsReflectedByQd) {
    EXPECT_NEAR(photometry::diffuse_luminance_coefficient(photometry::extended(lambert(0.05))), 0.05,
                2e-4);  // what is beyond tan 20 is not Lambert's
    for (const std::string& name : photometry::standard_reflection_tables()) {
        const ReflectionTable table = photometry::extended(find_reflection_table(name)),
                              plain = photometry::without_sheen(table);
        EXPECT_EQ(reduced_luminance_coefficient(plain, 3.3, 17), reduced_luminance_coefficient(table, 3.3, 90)) << name;
        const double radian = std::numbers::pi / 180;
        for (const ReflectionTable& t : {table, plain}) {
            double luminance = 0, illuminance = 0;  // of a sky of 1 cd/m^2
            for (double gamma = 0.25; gamma < 90; gamma += 0.5)
                for (double beta = 0.25; beta < 360; beta += 0.5) {
                    const double solid = std::sin(gamma * radian) * 0.25 * radian * radian,
                                 horizontal = solid * std::cos(gamma * radian);
                    luminance += horizontal * photometry::luminance_coefficient(t, std::tan(gamma * radian), beta);
                    illuminance += horizontal;
                }
            EXPECT_NEAR(luminance / illuminance / photometry::diffuse_luminance_coefficient(t), 1, 2e-3) << name;
        }
    }
    // Sheen is seen flat, where lamps that count for Q0 are: less of it comes from the whole sky.
    EXPECT_NEAR(photometry::diffuse_luminance_coefficient(photometry::extended(find_reflection_table("R3"))), 0.0543,
                1e-4);
    EXPECT_NEAR(photometry::diffuse_luminance_coefficient(photometry::extended(find_reflection_table("W4"))), 0.1259,
                1e-4);
}

TEST(ReflectionTable, ExtensionLeavesCoveredCellsAndFallsSmoothly) {
    for (const std::string& name : photometry::standard_reflection_tables()) {
        const ReflectionTable table = find_reflection_table(name), smooth = photometry::extended(table);
        size_t filled = 0;
        for (size_t i = 0; i < table.r.size(); ++i) {
            if (table.r[i] == 0) ++filled;
            EXPECT_EQ(table.r[i] == 0 ? 0 : smooth.r[i], table.r[i]);
            EXPECT_GT(smooth.r[i], 0);
        }
        EXPECT_GT(filled, 100u) << name;
        // Without steps: neighbouring directions differ by little, over the old edge and beyond the last row.
        for (const double beta : {3.0, 17.0, 22.0, 33.0, 47.0, 90.0, 170.0})
            for (double t = 5; t < 40; t += 0.01) {
                const double here = reduced_luminance_coefficient(smooth, t, beta);
                const double there = reduced_luminance_coefficient(smooth, t + 0.01, beta);
                EXPECT_LE(std::abs(there - here), 0.03 * here) << name << " " << t << " " << beta;
            }
        EXPECT_LT(reduced_luminance_coefficient(smooth, 1000, 0), 1e-5);
        // L per illuminance facing the lamp stays beyond the table.
        EXPECT_NEAR(photometry::luminance_coefficient(smooth, 30, 40) * std::sqrt(145.0),
                    photometry::luminance_coefficient(smooth, 12, 40) * std::sqrt(901.0), 1e-9);
    }
}

TEST(ReflectionTable, ReadsWhatSpreadsheetsWrite) {
    const ReflectionTable table =
        parse("\xef\xbb\xbf# made up\r\n# Q0 0.09\r\n\"tan\", 0, 180\r\n\r\n0, 300, 300\r\n2, 30,\r\n");
    EXPECT_EQ(table.stated_q0, 0.09);
    EXPECT_EQ(table.name, "t.csv");
    EXPECT_EQ(table.beta, (std::vector<double>{0, 180}));
    EXPECT_EQ(table.at(1, 1), 0);
    for (const char* q0 : {"# Q0: 0.09", "#q0=0.09", "# q0\t0.09", "# Q0 = 0.09"})
        EXPECT_EQ(parse(std::string(q0) + "\nt,0,180\n0,3,3\n2,1,1\n").stated_q0, 0.09) << q0;
    EXPECT_EQ(parse("# Q0: nominal value of the class\nt,0,180\n0,3,3\n2,1,1\n").stated_q0, 0);
    EXPECT_FALSE(table.wet);
    EXPECT_TRUE(parse("# Wet\nbeta\\tan(gamma),0,180\n0,3,3\n2,1,1\n").wet);
    EXPECT_TRUE(find_reflection_table("W3").wet);
    for (const char* start : {"tan_gamma,0,180\n", "\xef\xbb\xbf# x\r\"tan gamma\",0\r", "\n#\n TG ,0,180"})
        EXPECT_TRUE(photometry::is_reflection_table(bytes_of(start))) << start;
    for (const char* start : {"", "# tan_gamma\n", "gamma,0,90\ntan_gamma\n", "A,0,1\n", "T,0,180\n"})
        EXPECT_FALSE(photometry::is_reflection_table(bytes_of(start))) << start;
    const TempFolder folder;
    folder.write("mine.csv", "t,0,180\n0,3,3\n1,2,1");
    EXPECT_EQ(find_reflection_table("mine.csv", folder.path()).name, "mine");
    EXPECT_EQ(find_reflection_table("mine.csv", folder.path()).at(1, 0), 2e-4);
}

// The published layout of DIAL: tan gamma is the fastest.
std::string rtb_of(const ReflectionTable& table) {
    std::string text = "RTable.v1\nCIE " + table.name + "\n" + std::to_string(table.tan_gamma.size()) + "\n";
    for (const double t : table.tan_gamma) text += std::to_string(t) + "\n";
    text += std::to_string(table.beta.size()) + "\n";
    for (const double b : table.beta) text += std::to_string(b) + "\n";
    text += std::to_string(table.stated_q0) + "\n";
    for (size_t b = 0; b < table.beta.size(); ++b)
        for (size_t t = 0; t < table.tan_gamma.size(); ++t) text += std::to_string(table.at(t, b) * 1e4) + "\n";
    return text;
}

TEST(ReflectionTable, ReadsTablesForDialux) {
    const ReflectionTable r3 = find_reflection_table("R3");
    const std::string text = rtb_of(r3);
    const auto expect_r3 = [&](std::string_view file) {
        ReflectionTable table = parse(file);
        EXPECT_EQ(table.tan_gamma, r3.tan_gamma);
        EXPECT_EQ(table.beta, r3.beta);
        EXPECT_EQ(table.stated_q0, 0.07);
        EXPECT_NEAR(table.at(4, 3), 326e-4, 1e-12) << "tan gamma 1, beta 10";
        ASSERT_EQ(table.r.size(), r3.r.size());
        for (size_t i = 0; i < table.r.size(); ++i) ASSERT_NEAR(table.r[i], r3.r[i], 1e-12);
    };
    expect_r3(text);
    std::string comma = text, windows, one_line_each = text, wide;
    for (char& c : comma) c = c == '.' ? ',' : c;
    comma.replace(0, 9, "RTABLE.V1");
    for (const char c : text) windows += c == '\n' ? "\r\n" : std::string(1, c);
    const size_t numbers = text.find('\n', text.find('\n') + 1) + 1;
    for (size_t i = numbers; i < one_line_each.size(); ++i)
        if (one_line_each[i] == '\n') one_line_each[i] = i % 3 == 0 ? '\t' : ';';
    wide = "\xff\xfe";
    for (const char c : text) wide += c, wide += '\0';
    expect_r3(comma), expect_r3("\xef\xbb\xbf" + windows + "\r\n\r\n"), expect_r3(one_line_each), expect_r3(wide);

    const TempFolder folder;
    folder.write("ring road.rtb", text);
    const ReflectionTable found = find_reflection_table("ring road.rtb", folder.path());
    EXPECT_EQ(found.name, "ring road");
    EXPECT_TRUE(photometry::is_reflection_table(bytes_of(text)));
}

TEST(ReflectionTable, RefusesDamagedTablesForDialux) {
    const std::string small = "RTable.v1\nmine\n2\n0\n1\n2\n0\n180\n0.07\n3\n2\n3\n";
    EXPECT_EQ(parse(small + "1\n").at(1, 1), 1e-4);
    EXPECT_EQ(parse(small + "1\n").at(1, 0), 2e-4);
    const std::pair<std::string, std::string> cases[] = {
        {small, "t.csv: line 13: is the end: r is missing"},
        {small + "1\n5\n", "line 14: '5' is more than the table has"},
        {small + "x\n", "line 13: 'x' is not r"},
        {small + "-1\n", "line 13: '-1' is not r"},
        {"RTable.v1\nmine\n2.5\n", "line 3: has no number of tan gamma"},
        {"RTable.v1\nmine\n100000\n", "line 3: '100000' is not the number of tan gamma, a number from 0 to 512"},
        {"RTable.v1\nmine\n2\n0\n1\n2\n0\n360\n", "line 8: '360' is not beta 2, a number from 0 to 180"},
        {"RTable.v1\nmine\n2\n0\n1\n2\n0\n180\n700\n", "line 9: '700' is not Q0"},
        {"RTable.v1\nmine\n2\n0\n1\n2\n0\n90\n0.07\n3\n2\n3\n1\n", "beta must ascend from 0 to 180"},
        {"RTable.v1\nmine\n2\n0\n1\n2\n0\n180\n0.07\n0.03\n0.02\n0.03\n0.01\n", "no value reaches 1"},
        {"RTable.v1", "is missing"}};
    for (const auto& each : cases) {
        const std::string said = complaint_of([&] { parse(each.first); });
        EXPECT_TRUE(contains(said, each.second)) << each.first;
    }
}

TEST(ReflectionTable, RefusesWhatIsDamaged) {
    const struct {
        std::string text, reason;
    } cases[] = {
        {"", "t.csv: a reflection table has at least two"},
        {"t,0,180\n0,3,3\n", "t.csv: a reflection table has at least two"},
        {"gamma_deg,0,180\n0,3,3\n45,2,2\n", "line 1: begins with 'gamma_deg'"},
        {"C,0,180\n0,3,3\n45,2,2\n", "line 1: begins with 'C'"},
        {"# Q0\tx\n", "line 1: 'x' is not a number"},
        {"t,0,180\n0,0.03,0.03\n2,0.001,0.001\n", "t.csv: no value reaches 1"},
        {"t\n0,3,3\n", "line 1: is not a row of beta"},
        {"t,0,180\n0,3,3\n1,2\n", "line 3: has 2 fields, 3 are wanted"},
        {"t,0,180\n0,3,3\n1,2,2,2\n", "line 3: has 4 fields, 3 are wanted"},
        {"t,0,180\n0,3,3\n1,2,x\n", "line 3: 'x' is not a number"},
        {"t,0,180\n0,3,3\n1,2,nan\n", "line 3: 'nan' is not a number"},
        {"t,0,180\n0,3,3\n1,2,-2\n", "line 3: '-2' is not a number"},
        {"t,0,180\n0,3,3\n1,2,1e400\n", "line 3: '1e400' is not a number"},
        {"t,0,180\n0,3,3\n,2,2\n", "line 3: '' is not a number"},
        {"# Q0 x\n", "line 1: 'x' is not a number"},
        {"t,0,180\n0,3,3\n1,2,1e9\n", "r must be from 0"},
        {"t,0,90\n0,3,3\n1,2,2\n", "beta must ascend from 0 to 180"},
        {"t,0,180\n0,3,3\n0,2,2\n", "tan gamma must ascend"},
        {"t,0,180\n1,3,3\n2,2,2\n", "tan gamma must ascend"},
        {"t,0,180\n0,0,3\n1,2,2\n", "r at tan gamma 0"},
        {"t" + std::string(600, ',') + "\n", "line 1: has more than 512 values"},
    };
    for (const auto& c : cases) {
        try {
            parse(c.text);
            ADD_FAILURE() << c.text << " was accepted";
        } catch (const Error& error) {
            EXPECT_TRUE(contains(error.what(), c.reason));
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
    EXPECT_THROW(find_reflection_table("R5"), Error);
    EXPECT_THROW(find_reflection_table("missing.csv"), Error);
    std::string many = "t,0,180\n0,3,3\n";
    for (int i = 1; i < 600; ++i) many += std::to_string(i) + ",2,2\n";
    EXPECT_THROW(parse(many), Error);
}

}  // namespace
}  // namespace vesper::test
