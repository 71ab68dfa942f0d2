// Shared parts of the reader of runs. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "roads/esmini_run.h"
#include "roads/xml.h"

namespace vesper::roads {

void read_table(const std::filesystem::path& file, EsminiRun& run);

/// Values of parameters, by name.
using Parameters = std::map<std::string, std::string, std::less<>>;

/// An OpenSCENARIO file and the catalogs it names.
class ScenarioFile {
public:
    explicit ScenarioFile(const std::filesystem::path& file);

    XmlElement root() const { return file_->root(); }
    const Parameters& parameters() const { return parameters_; }

    /// An element of a catalog and its parameters, for a CatalogReference.
    struct Entry {
        XmlElement element;
        Parameters parameters;
    };
    std::optional<Entry> find(const XmlElement& reference, const Parameters& scope);

private:
    std::filesystem::path folder_;
    std::unique_ptr<XmlFile> file_;
    Parameters parameters_;
    std::vector<std::unique_ptr<XmlFile>> catalogs_;
    std::map<std::pair<std::string_view, std::string_view>, XmlElement> entries_;  ///< by catalog and name; "": any
    bool looked_ = false;
    void look_for_catalogs();
};

/// Parameters of an element and of its parents; the inner ones override.
Parameters declared(const XmlElement& element, const Parameters& around);
/// The value of an expression (truth: 1 and 0); empty if it is invalid, has unknown parameters, or is not finite.
std::optional<double> expression_value(std::string_view text, const Parameters& scope);
/// An attribute with evaluated parameters and expressions ($name, ${$a * 2}); empty if missing.
std::optional<std::string> resolved(const XmlElement& element, const char* attribute, const Parameters& scope);
bool flag_in(const XmlElement& element, const char* attribute, const Parameters& scope);
double number_in(const XmlElement& element, const char* attribute, const Parameters& scope, double fallback);

/// Plays the storyboard at the steps of the run and adds its events of lamps, traffic lights and time of day.
void play_storyboard(ScenarioFile& scenario, const RoadNetwork* roads, EsminiRun& run);

}  // namespace vesper::roads
