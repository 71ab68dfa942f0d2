// Studies of the tone operators: what their settings do to pictures. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "arguments/command_line.h"
#include "arguments/tone_arguments.h"
#include "plots/line_plot.h"
#include "progress.h"
#include "render/tone_mapper.h"
#include "study_page.h"
#include "study_picture.h"

namespace vesper::commands {

struct StudyArguments {
    std::vector<std::string> inputs;
    std::string folder, device;
    unsigned threads = 0;
    PictureSource source;
    double outside = 5000, inside = 50, seconds = 300;  ///< cd/m^2, s; of the tunnel
    double contrast = 0.3, minutes = 10;                ///< of the target: (Lt - Lb) / Lb; diameter, arc minutes
    std::vector<std::string> displays;                  ///< names or files; none: that of `tone`
    apps::ToneArguments tone;
};

/// What one condition adds to a study: an operator, with a picture or over time.
struct StudyPart {
    std::vector<std::vector<std::string>> rows;
    std::vector<apps::PlotLine> lines;
    std::vector<StudyPage::Figure> shown;
    std::vector<double> numbers;
};

/// What every study works with.
struct Study {
    const StudyArguments& arguments;
    render::ToneChainSettings settings;
    gpu::Device& device;
    render::ToneMapper& mapper;
    const std::vector<StudyPicture>& pictures;
    StudyPage page;

    std::string file(const std::string& name) const { return arguments.folder + "/" + name; }
    /// The picture as an eye adapted to it sees it.
    render::ToneMapped map(const StudyPicture& picture, const render::ToneChainSettings& with) const;
    /// The parts of so many conditions, in order. Each rank makes every size-th of them, with their files; the first
    /// one has all, and others have none and are done.
    std::vector<StudyPart> parts(const std::string& what, size_t conditions,
                                 const std::function<StudyPart(size_t)>& make) const;
};

/// Operators that a study compares: the one given, which has to be among `candidates`, or all of those. Throws Error.
std::vector<render::Operator> studied_operators(const StudyArguments&, const std::vector<render::Operator>& candidates,
                                                const std::string& why);
/// Those that adjust the histogram.
std::vector<render::Operator> histogram_operators();

/// Luminances that a picture holds, cd/m^2, in equal steps of the logarithm.
std::vector<double> luminances_of(const StudyPicture&);

/// Codes that greys of these luminances are shown with, fractions of a code included.
std::vector<double> curve_codes(const render::ToneMapped&, render::Operator, const vision::Display&,
                                const std::vector<double>& luminances);

/// What changes between two settings.
struct Difference {
    double curve = 0;  ///< largest difference of the curves over the luminances of the picture, codes
    double largest = 0, percentile = 0,
           mean = 0;         ///< of the pixels (their worst channel): largest, 99th percentile, mean, codes
    std::vector<float> map;  ///< of every pixel, codes
};
Difference difference(const render::ToneMapped& from, const render::ToneMapped& to, const vision::Display&);
std::string describe(const Difference&);
double largest_difference(const std::vector<double>&, const std::vector<double>&);

/// Throws Error if the folder of a page cannot be one; ends it without a slash. And makes it.
void check_folder(std::string& folder);
void make_folder(const std::string& folder);

/// vesper study headlamps.
void add_headlamps(apps::Command studies);

/// Each study writes its files and fills the page.
void study_bins(Study&);
void study_adaptation(Study&);
void study_mip(Study&);
void study_operators(Study&);
void study_fidelity(Study&);

}  // namespace vesper::commands
