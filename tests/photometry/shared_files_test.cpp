// The photometric files of the shared set: their flux and largest intensity, as its README states them.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "photometry/distributions.h"
#include "photometry/eulumdat.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
const fs::path kFolder = shared_data("photometry");

TEST(SharedPhotometry, FluxIsWhatIsStated) {
    if (!is_here(kFolder)) GTEST_SKIP() << "the shared set is not here";
    // Of the first set of lamps: flux of the set times the light output ratio by integration. (For files of several
    // sets the README states the sum of all of them as intensity; sets are alternatives.) no_symmetry.ldt states planes
    // every 90 deg but lists them every 15: the list counts.
    const struct {
        const char* file;
        double flux, candela;
    } rows[] = {
        {"eulumdat-py/sample1.ldt", 1983 * 1.000, 0.3543 * 1983},
        {"eulumdat-py/sample3.ldt", 12800 * 1.001, 5936},
        {"eulumdat-py/sample5.ldt", 611.9, 471.3},
        {"eulumdat-py/sample8.ldt", 400 * 0.886, 157.3},
        {"eulumdat-py/sample9.ldt", 10002, 2862},
        {"photometric-viewer/ies95/absolute_photometry.ies", 906.6, 2200},
        {"photometric-viewer/ies95/relative_photometry.ies", 906.6, 2200},
        {"photometric-viewer/ies95/relative_photometry_with_multiplier.ies", 1359.9, 3300},
        {"photometric-viewer/ies95/imperial_units.ies", 906.6, 2200},
        {"photometric-viewer/ies95/label_lines.ies", 906.6, 2200},
        {"photometric-viewer/ies95/point_opening.ies", 906.6, 2200},
        {"photometric-viewer/ies95/rectangular_opening.ies", 906.6, 2200},
        {"photometric-viewer/ies95/horizontal_cylinder_opening_along_length.ies", 906.6, 2200},
        {"photometric-viewer/ldt/absolute.ldt", 500 * 0.907, 1100},
        {"photometric-viewer/ldt/relative.ldt", 500 * 0.907, 1100},
        {"photometric-viewer/ldt/multiple_lamp_sets.ldt", 500 * 0.907, 1100},
        {"photometric-viewer/ldt/symmetry_about_vertical_axis.ldt", 1000 * 0.907, 2200},
        {"photometric-viewer/ldt/symmetry_to_c0c180.ldt", 1000 * 3.143, 2866},
        {"photometric-viewer/ldt/no_symmetry.ldt", 1000 * 3.724, 3051},
        {"radiance/examp1.ies", 5297.4, 1065},
        {"lighting/0_CIE-2010-Table7.ldt", 1000 * 0.650, 265},
    };
    for (const auto& row : rows) {
        const photometry::Distribution d = photometry::read_distribution(kFolder / row.file);
        EXPECT_NEAR(photometry::luminous_flux(d), row.flux, 0.01 * row.flux) << row.file;
        EXPECT_NEAR(photometry::largest_intensity(d), row.candela, 1e-3 * row.candela) << row.file;
    }
    size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(kFolder))
        files += entry.path().extension() == ".ies" || entry.path().extension() == ".ldt";
    EXPECT_EQ(files, std::size(rows));
    EXPECT_NEAR(photometry::luminous_flux(
                    photometry::read_eulumdat(kFolder / "photometric-viewer/ldt/multiple_lamp_sets.ldt", 1)),
                1200 * 0.907, 0.01 * 1200);
}

TEST(SharedPhotometry, BothFormatsOfOneLuminaireAgree) {
    const fs::path folder = kFolder.parent_path().parent_path() / "reference/data";
    if (!is_here(folder / "synthetic_road.ies")) GTEST_SKIP() << "the shared set is not here";
    const photometry::Distribution ies = photometry::read_distribution(folder / "synthetic_road.ies");
    const photometry::Distribution ldt = photometry::read_distribution(folder / "synthetic_road.ldt");
    EXPECT_NEAR(photometry::luminous_flux(ies), 8803.2, 0.01 * 8803.2);
    ASSERT_EQ(ies.candela.size(), ldt.candela.size());
    EXPECT_EQ(ies.horizontal, ldt.horizontal);
    for (size_t i = 0; i < ies.candela.size(); ++i) EXPECT_NEAR(ies.candela[i], ldt.candela[i], 1e-6);
}

}  // namespace
}  // namespace vesper::test
