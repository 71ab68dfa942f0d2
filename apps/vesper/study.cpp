// `vesper study`: what settings of the tone operators do to pictures. SPDX-License-Identifier: MIT
#include "study.h"

#include <cstdio>
#include <filesystem>
#include <functional>
#include <set>

#include "arguments/arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/thread_arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "commands.h"
#include "io/file_gate.h"
#include "print.h"
#include "ranks/ranks.h"

namespace vesper::commands {
namespace {

using apps::Command;
namespace fs = std::filesystem;

/// Checks names and folder before anything takes time. Gives the names of the pictures.
std::vector<std::string> check_arguments(const StudyArguments& arguments) {
    std::vector<std::string> names;
    std::set<std::string> seen;
    for (const std::string& input : arguments.inputs) {
        names.push_back(fs::path(input).stem().string());
        if (!seen.insert(names.back()).second)
            throw Error(one_line(input) + ": a second picture of the name " + one_line(names.back()));
        io::announce_read(input);
        if (!fs::is_regular_file(input)) throw Error(one_line(input) + ": there is no such file");
    }
    apps::parse_size(arguments.source.size);
    check_source(arguments.source, arguments.inputs);
    return names;
}

void run(const StudyArguments& arguments, const std::string& what, const std::string& title,
         const std::function<void(Study&)>& study) {
    const render::ToneChainSettings settings = apps::tone_settings(arguments.tone);
    const std::vector<std::string> names = check_arguments(arguments);
    gpu::Device device({.select = arguments.device});
    std::vector<StudyPicture> pictures;
    for (size_t i = 0; i < names.size(); ++i) {
        pictures.push_back(read_study_picture(arguments.source, device, settings, arguments.inputs[i]));
        pictures.back().name = names[i];
    }
    make_folder(arguments.folder);
    apps::Ranks::all().agree_on_start();
    render::ToneMapper mapper(device);
    Study all{arguments, settings, device, mapper, pictures, StudyPage(title)};
    if (arguments.displays.empty())
        all.page.paragraph(apps::format("Display from %.4g to %.4g cd/m\u00b2, %u bits.",
                                        double(settings.display.low()), double(settings.display.high()),
                                        settings.display.bits));
    study(all);
    if (!apps::Ranks::all().is_first()) return;
    apps::write_text(all.file(what + ".html"), all.page.html());
    apps::print("%s\n", all.file(what + ".html").c_str());
}

void add_pictures(Command command, StudyArguments& a) {
    command.add_option("pictures", a.inputs, "OpenEXR or Radiance pictures, or a .gltf or .glb to render once")
        .required();
    add_source_options(command, a.source);
}

Command add_one(Command studies, const std::shared_ptr<StudyArguments>& a, const std::string& name,
                const std::string& title, const std::string& help, const std::string& example, void (*study)(Study&)) {
    Command command = studies.add_command(name, help);
    command.add_option("--output,-o", a->folder, "Folder of the page, its pictures, CSV and plots").required();
    command.add_option("--device", a->device,
                       "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    apps::add_thread_option(command, a->threads);
    apps::add_tone_options(command, a->tone);
    command.footer("Example:\n  vesper study " + name + " " + example + "\n");
    command.callback_of_ranks([a, name, title, study] {
        apps::use_threads(a->threads);
        check_folder(a->folder);
        run(*a, name, title, study);
    });
    return command;
}

}  // namespace

void check_folder(std::string& folder) {
    while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
    if (fs::is_directory(folder)) return;
    io::announce_write("-o", fs::path(folder).lexically_normal().string());
    if (fs::exists(folder)) throw Error("-o " + one_line(folder) + ": is not a folder");
}

void make_folder(const std::string& folder) {
    std::error_code error;
    fs::create_directory(folder, error);  // another rank may have made it
    if (!fs::is_directory(folder)) throw Error("-o " + one_line(folder) + ": cannot be made a folder");
}

void add_study(Command program) {
    Command studies = program.add_command(
        "study", "Study settings of the tone operators, or headlamps: CSV, plots and a page (docs/study.md)");
    studies.requires_command();
    const auto mip = std::make_shared<StudyArguments>(), bins = std::make_shared<StudyArguments>(),
               tunnel = std::make_shared<StudyArguments>(), ops = std::make_shared<StudyArguments>(),
               fidelity = std::make_shared<StudyArguments>();
    mip->source.angle_matters = fidelity->source.angle_matters = true;
    add_pictures(add_one(studies, mip, "mip", "The foveal level",
                         "Foveal levels 1 to 8: what they do to curve and picture, against level 1",
                         "night.gltf --camera driver -o out/mip", study_mip),
                 *mip);
    add_pictures(add_one(studies, bins, "bins", "Bins of the histogram",
                         "16 to 256 bins, with shared and with whole votes: how few come within 1 code of 256",
                         "night.gltf --camera driver -o out/bins", study_bins),
                 *bins);
    Command compared =
        add_one(studies, ops, "operators", "Operators side by side",
                "All operators: contrast and visibility of a target, scene against display",
                "night.gltf --camera driver --contrast 0.3 --minutes 10 -o out/operators", study_operators);
    add_pictures(compared, *ops);
    compared.add_option("--contrast", ops->contrast, "Of the target: (Lt - Lb) / Lb")
        .check(apps::between(0.001, 100.0))
        .shows_default();
    compared.add_option("--minutes", ops->minutes, "Diameter of the target, arc minutes")
        .check(apps::between(1.0, 60.0))
        .shows_default();
    Command shown =
        add_one(studies, fidelity, "fidelity", "What displays show of the scene",
                "All operators: contrast that the display loses, invents or amplifies, and saliency it keeps",
                "night.gltf --camera driver --displays desk,projector -o out/fidelity", study_fidelity);
    add_pictures(shown, *fidelity);
    shown.add_option("--displays", "Several in place of --display: NAMES or FILES, separated by commas")
        .takes_list(fidelity->displays);
    Command adaptation = add_one(studies, tunnel, "adaptation", "Into a tunnel and out of it",
                                 "Step responses of every operator that adapts over time",
                                 "--outside 5000 --inside 50 -o out/tunnel", study_adaptation);
    adaptation.add_option("--outside", tunnel->outside, "Luminance before the tunnel, cd/m^2")
        .check(apps::between(1e-3, 1e6))
        .shows_default();
    adaptation.add_option("--inside", tunnel->inside, "Luminance in the tunnel, cd/m^2")
        .check(apps::between(1e-3, 1e6))
        .shows_default();
    adaptation.add_option("--seconds", tunnel->seconds, "How long each response is followed, s")
        .check(apps::between(0.1, 3600.0))
        .shows_default();
    add_headlamps(studies);
    studies.footer(
        "Examples:\n  vesper study bins night.gltf --camera driver -o out/bins\n"
        "  vesper study bins *.hdr --unit 179 --operator irawan -o out/bins\n"
        "  vesper study adaptation --outside 5000 --inside 50 -o out/tunnel\n"
        "  vesper study headlamps night.gltf --camera driver --obstacle pedestrian_00 --beam low.csv -o out/beams\n");
}

}  // namespace vesper::commands
