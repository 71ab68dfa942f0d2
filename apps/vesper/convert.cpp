#include "scene/convert.h"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "commands.h"

namespace vesper {
namespace {

struct ConvertArguments {
    std::string input, photometry, output;
    bool srgb = false;
};

void run(const ConvertArguments& arguments) {
    std::optional<Transfer> transfer;
    if (arguments.srgb) transfer = Transfer{Transfer::Kind::Srgb};
    const ConversionReport report = convert(arguments.input, arguments.photometry, arguments.output, transfer);
    for (const std::string& line : report.changes) std::printf("%s\n", line.c_str());
    for (const std::string& line : report.warnings) std::fprintf(stderr, "warning: %s\n", line.c_str());
    std::printf("wrote %s\n", arguments.output.c_str());
}

}  // namespace

void add_convert(CLI::App& program) {
    CLI::App* command = program.add_subcommand("convert", "Make a daytime glTF database photometric");
    const auto arguments = std::make_shared<ConvertArguments>();
    command->add_option("input", arguments->input, "The database: .gltf or .glb")->required();
    command->add_option("--photometry,-p", arguments->photometry, "Which nodes are lamps, which materials shine (docs/photometry.md)")->required();
    command->add_option("--output,-o", arguments->output, "One self-contained .gltf or .glb")->required();
    command->add_flag("--srgb", arguments->srgb, "Decode textures as sRGB instead of with the gamma of the photometry file");
    command->footer("Example:\n  vesper convert data/rivoli/rivoli.gltf --photometry data/rivoli/rivoli.photometry.json -o out/night.gltf\n");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace vesper
