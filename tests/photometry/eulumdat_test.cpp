// EULUMDAT files: symmetries, lamp sets, the oddities files have. SPDX-License-Identifier: MIT
#include "photometry/eulumdat.h"

#include <sstream>

#include "photometry/distributions.h"

namespace vesper::test {
namespace {

/// A file in the making; gamma 0, 45, 90.
struct File {
    int symmetry = 0;
    std::vector<double> planes{0, 90, 180, 270};
    std::vector<std::string> lamps{"1", "LED", "1000", "4000", "80", "20"};
    std::vector<std::vector<double>> candela;  ///< per plane stored
    std::string conversion = "1.0", gammas = "0\n45\n90\n";
    std::string area = "0\n0\n0\n0\n0\n0\n";

    std::string text() const {
        std::ostringstream out;
        out << "Company\n1\n" << symmetry << "\n" << planes.size() << "\n0\n3\n0\nreport\nLamp\nL-1\nx.ldt\nday\n";
        out << "500\n200\n100\n" << area << "100\n88\n" << conversion << "\n0\n" << lamps.size() / 6 << "\n";
        for (const std::string& line : lamps) out << line << "\n";
        for (int i = 0; i < 10; ++i) out << "0.5\n";
        for (const double plane : planes) out << plane << "\n";
        out << gammas;
        for (const auto& plane : candela)
            for (const double value : plane) out << value << "\n";
        return out.str();
    }
};

photometry::Distribution parsed_ldt(const std::string& text, size_t lamp_set = 0) {
    return photometry::parse_eulumdat(bytes_of(text), "x.ldt", lamp_set);
}
std::string ldt_complaint(const std::string& text, size_t lamp_set = 0) {
    return complaint_of([&] { parsed_ldt(text, lamp_set); });
}

/// A plane that is `value` at gamma 45 and 0 elsewhere.
std::vector<double> ring(double value) { return {0, value, 0}; }

File plain() {
    File file;
    file.candela = {ring(10), ring(20), ring(30), ring(40)};
    return file;
}

TEST(Eulumdat, ReadsUtf16OfBothByteOrders) {
    const std::string text = plain().text();
    for (const bool big : {false, true}) {
        EXPECT_EQ(parsed_ldt(utf16_of(text, big)).candela, parsed_ldt(text).candela);
        EXPECT_TRUE(
            contains(ldt_complaint(utf16_of(replaced(text, "0\n45\n90", "0\nwide\n90"), big)), "'wide' stands"));
    }
}

// With no symmetry stated all planes are there.
TEST(Eulumdat, PlanesGoRound) {
    File file = plain();
    EXPECT_NO_THROW(parsed_ldt(file.text()));
    file.planes = {0, 30, 60, 90};
    EXPECT_TRUE(contains(ldt_complaint(file.text()), "no symmetry is stated, but the C angles do not go round"));
    file.planes = {0, 60, 120, 180};
    EXPECT_TRUE(contains(ldt_complaint(file.text()), "do not go round"));
    file.symmetry = 2;
    EXPECT_NO_THROW(parsed_ldt(file.text()));
    file = plain();
    file.planes = {0, 180}, file.candela.resize(2);
    EXPECT_NO_THROW(parsed_ldt(file.text()));
}

double at(const photometry::Distribution& d, double c) { return photometry::intensity(d, c_gamma(c, 45)); }

TEST(Eulumdat, AnAngleThatIsThereTwiceMustSayTheSame) {
    File file = plain();
    file.gammas = "0\n45\n45\n";
    EXPECT_TRUE(contains(ldt_complaint(file.text()), "gamma angle 45 is there twice, with other intensities"));
    for (auto& plane : file.candela) plane[2] = plane[1];
    EXPECT_EQ(parsed_ldt(file.text()).vertical, (std::vector<double>{0, 45}));
}

TEST(Eulumdat, ExpandsEverySymmetry) {
    const photometry::Distribution none = parsed_ldt(plain().text());
    EXPECT_EQ(none.horizontal, (std::vector<double>{0, 90, 180, 270, 360}));
    EXPECT_NEAR(at(none, 315), 25, 1e-9);

    File file;
    file.symmetry = 1;
    file.candela = {ring(7)};
    EXPECT_EQ(parsed_ldt(file.text()).horizontal, std::vector<double>{0});
    EXPECT_NEAR(at(parsed_ldt(file.text()), 123), 7, 1e-9);

    file.planes = {0, 45, 90, 135, 180, 225, 270, 315};
    file.symmetry = 2;  // C0 to C180
    file.candela = {ring(0), ring(45), ring(90), ring(135), ring(180)};
    for (const auto& [c, wanted] : {std::pair(20.0, 20.0), {340.0, 20.0}, {225.0, 135.0}})
        EXPECT_NEAR(at(parsed_ldt(file.text()), c), wanted, 1e-9) << c;

    file.symmetry = 3;  // C270 over C0 to C90
    file.candela = {ring(270), ring(315), ring(0), ring(45), ring(90)};
    for (const auto& [c, wanted] :
         {std::pair(315.0, 315.0), {225.0, 315.0}, {45.0, 45.0}, {135.0, 45.0}, {180.0, 0.0}, {270.0, 270.0}})
        EXPECT_NEAR(at(parsed_ldt(file.text()), c), wanted, 1e-9) << c;

    file.symmetry = 4;  // C0 to C90
    file.candela = {ring(0), ring(45), ring(90)};
    for (const auto& [c, wanted] : {std::pair(30.0, 30.0), {150.0, 30.0}, {210.0, 30.0}, {330.0, 30.0}})
        EXPECT_NEAR(at(parsed_ldt(file.text()), c), wanted, 1e-9) << c;
}

TEST(Eulumdat, ScalesByFluxAndConversionOnly) {
    File file = plain();
    file.lamps = {"3", "A", "2000", "3000", "80", "20", "-1", "B", "5000", "4000", "70", "50"};
    file.conversion = "1,5";
    const photometry::Distribution first = parsed_ldt(file.text()), second = parsed_ldt(file.text(), 1);
    EXPECT_NEAR(at(first, 0), 10 * 2 * 1.5, 1e-9);
    EXPECT_EQ(first.lamp_flux, 2000);
    EXPECT_NEAR(at(second, 0), 10 * 5 * 1.5, 1e-9);
    EXPECT_EQ(second.lamp_flux, 0);  // absolute
    EXPECT_TRUE(
        contains(ldt_complaint(file.text(), 2), "x.ldt: line 26: there are 2 sets of lamps: none has the number 2"));
}

TEST(Eulumdat, TakesWhatFilesReallyHold) {
    const photometry::Distribution wanted = parsed_ldt(plain().text());
    const auto same = [&](const std::string& text) { EXPECT_EQ(parsed_ldt(text).candela, wanted.candela) << text; };
    const std::string text = plain().text();
    std::string windows;
    for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    same(windows);
    same("\xef\xbb\xbf" + text);
    same(text.substr(0, text.size() - 1));
    same(text + "\n\n\x1a\n17\n18\n");  // another table after a blank line
    same(replaced(text, "0\n45\n90\n", "0,0\n\"45\"\n +90 \n"));
    same(replaced(text, "500\n200\n100\n0\n", "\n\n\n\n"));
    const photometry::Distribution d = parsed_ldt(replaced(text, "\nLamp\n", "\nR\xe9verb\xe8re\n"));
    EXPECT_EQ(d.name, "Réverbère");
}

TEST(Eulumdat, ReadsTheLuminousArea) {
    File file = plain();
    file.area = "800\n200\n0\n30\n0\n0\n";
    photometry::LuminousOpening o = parsed_ldt(file.text()).opening;
    EXPECT_EQ(o.width, 0.8);  // a luminaire is long across C0
    EXPECT_EQ(o.length, 0.2);
    EXPECT_EQ(o.height, 0.03);
    file.area = "200\n0\n0\n0\n0\n0\n";
    o = parsed_ldt(file.text()).opening;
    EXPECT_TRUE(o.round);
    EXPECT_NEAR(o.area(), kPi * 0.01, 1e-12);
}

TEST(Eulumdat, SaysWhereAndWhy) {
    const std::string text = plain().text();
    // 32 lines to the end of the lamps, 10 ratios, 4 planes, 3 gammas, 12 intensities.
    EXPECT_TRUE(
        contains(ldt_complaint(text.substr(0, text.size() - 2)), "x.ldt: line 61: the file ends where an intensity"));
    EXPECT_TRUE(contains(ldt_complaint(text + "5\n"), "line 62: more intensities"));
    EXPECT_TRUE(
        contains(ldt_complaint(replaced(text, "Company\n1\n0\n", "Company\n1\n5\n")), "line 3: the symmetry must be"));
    EXPECT_TRUE(contains(ldt_complaint(replaced(text, "\n0\n4\n0", "\n0\n5000\n0")), "line 4: the number of C planes"));
    EXPECT_TRUE(contains(ldt_complaint(replaced(text, "\n0\n4\n0", "\n0\nfour\n0")), "line 4: 'four' stands where"));
    EXPECT_TRUE(
        contains(ldt_complaint(replaced(text, "0\n45\n90\n", "0\n45\n40\n")), "line 47: gamma angles do not ascend"));
    EXPECT_TRUE(
        contains(ldt_complaint(replaced(text, "0\n90\n180\n270\n", "0\n90\n80\n270\n")), "line 45: the C angles"));
    EXPECT_TRUE(contains(ldt_complaint(replaced(text, "1.0\n0\n1\n", "0\n0\n1\n")), "line 24: the conversion factor"));
    EXPECT_TRUE(contains(ldt_complaint(replaced(text, "1000\n", "0\n")), "line 32: the flux"));
    EXPECT_TRUE(contains(ldt_complaint(""), "x.ldt: line 1: the file ends"));
    File file = plain();
    file.symmetry = 3;
    file.planes = {0, 90, 180, 260};
    EXPECT_TRUE(contains(ldt_complaint(file.text()), "line 43: the symmetry stated needs a plane C270"));
}

}  // namespace
}  // namespace vesper::test
