// Truncated and changed files give a distribution that is sound, or an Error of one line. SPDX-License-Identifier: MIT
#include <random>

#include "photometry/distributions.h"
#include "photometry/eulumdat.h"
#include "photometry/grid.h"
#include "photometry/ies.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using Parse = std::function<photometry::Distribution(const std::string&)>;

bool sound(const photometry::Distribution& d) {
    if (d.candela.size() != d.horizontal.size() * d.vertical.size() || d.vertical.size() < 2) return false;
    for (const double candela : d.candela)
        if (!(candela >= 0 && std::isfinite(candela))) return false;
    for (const auto* angles : {&d.horizontal, &d.vertical})
        for (size_t i = 1; i < angles->size(); ++i)
            if (!((*angles)[i] > (*angles)[i - 1])) return false;
    if (d.goniometry == photometry::Goniometry::CGamma && d.horizontal.size() > 1)
        if (d.horizontal.front() != 0 || d.horizontal.back() != 360) return false;
    return std::isfinite(photometry::luminous_flux(d)) && std::isfinite(photometry::intensity(d, {0.1, 0.2, -0.5}));
}

void try_one(const Parse& parse, const std::string& text) {
    try {
        EXPECT_TRUE(sound(parse(text))) << text;
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
}

void torment(const Parse& parse, const std::string& text) {
    for (size_t size = 0; size < text.size(); ++size) try_one(parse, text.substr(0, size));
    std::mt19937 random(7);
    const std::string alphabet = "0123456789 -.,;eE\n\r\t[]#\"NaN\xff\x80\x01";
    const std::vector<std::string> words = {"1e308",  "-1e308",  "nan", "4097", "999999999999", "-1", "\n\n", "1e-320",
                                            "TILT=X", "INCLUDE", "0",   "360",  "90",           " ",  ",",    "#"};
    for (int round = 0; round < 4000; ++round) {
        std::string changed = text;
        for (unsigned i = 0; i <= random() % 4; ++i) {
            const size_t at = random() % (changed.size() + 1);
            switch (random() % 4) {
                case 0:
                    if (at < changed.size()) changed[at] = alphabet[random() % alphabet.size()];
                    break;
                case 1:
                    changed.insert(at, words[random() % words.size()]);
                    break;
                case 2:
                    changed.erase(at, random() % 8);
                    break;
                default:
                    changed.insert(at, changed.substr(random() % changed.size(), random() % 40));
            }
            if (changed.empty()) break;
        }
        try_one(parse, changed);
    }
}

TEST(Malformed, Ies) {
    const Parse parse = [](const std::string& text) { return photometry::parse_ies(bytes_of(text), "x.ies"); };
    const std::string header = "IESNA:LM-63-1995\n[TEST] a\n[MORE] b\nTILT=INCLUDE\n1 2 0 90 1 0.5\n";
    torment(parse, header + "1 -1 1 3 3 1 2 0 0 0\n1 1 20\n0 45 90\n0 45 90\n1 2 3\n4 5 6\n7 8 9\n");
    torment(parse, header + "1 -1 1 2 2 3 1 0 0 0\n1 1 20\n-5 5\n0 10\n1 2 3,5 4\n");
    torment(parse, header + "1 -1 1 2 4 1 1 0 0 0\n1 1 20\n0 5\n90 100 200 270\n1 2 3 4 5 6 7 8\n");
}

TEST(Malformed, Eulumdat) {
    const Parse parse = [](const std::string& text) { return photometry::parse_eulumdat(bytes_of(text), "x.ldt"); };
    for (const char* symmetry : {"0", "1", "2", "3", "4"})
        torment(parse, "C\n1\n" + std::string(symmetry) +
                           "\n4\n90\n2\n5\nr\nn\nl\nf\nd\n1\n1\n1\n1\n0\n0\n0\n0\n0\n100\n100\n1\n0\n1\n1\nL\n1000\nw\n"
                           "80\n9\n0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n90\n180\n270\n0\n90\n1\n2\n3\n4\n5\n6\n7\n8\n");
}

TEST(Malformed, Grid) {
    const Parse parse = [](const std::string& text) { return photometry::parse_grid_csv(bytes_of(text), "x.csv"); };
    torment(parse, "# goniometry: A\nA,-10,0,20\n5,4,5,6\n-5,1,2,3\n");
    torment(parse, "gamma\\C;0;45;90\n0;4;5;6\n90;1;2,5;3\n");
    torment(parse, "H_deg,V_deg,cd\n0,5,5\n-10,5,4\n-10,-5,1\n0,-5,2\n");
}

TEST(Malformed, NothingIsAllocatedForWhatIsOnlyStated) {
    const auto message = [](const std::string& counts) {
        return complaint_of([&] {
            photometry::parse_ies(bytes_of("IESNA91\nTILT=NONE\n1 -1 1 " + counts + " 1 2 0 0 0 1 1 1\n0 45 90\n"),
                                  "x.ies");
        });
    };
    EXPECT_TRUE(contains(message("4096 4096"), "more than 8000000 intensities"));
    EXPECT_TRUE(contains(message("4096 1900"), "the file ends"));
}

}  // namespace
}  // namespace vesper::test
