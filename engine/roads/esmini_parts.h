// What the parts of reading a run share. Not a public header. SPDX-License-Identifier: MIT
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

    /// An element of a catalog and its parameters, as a CatalogReference asks for.
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

/// Parameters declared in an element, over those around it; `assigned` wins.
Parameters declared(const XmlElement& element, const Parameters& around);
/// The value of an expression, truth as 1 and 0; nothing where it is none of known parameters or not finite.
std::optional<double> expression_value(std::string_view text, const Parameters& scope);
/// An attribute with its parameters and expressions ($name, ${$a * 2}) put in; nothing where missing.
std::optional<std::string> resolved(const XmlElement& element, const char* attribute, const Parameters& scope);
bool flag_in(const XmlElement& element, const char* attribute, const Parameters& scope);
double number_in(const XmlElement& element, const char* attribute, const Parameters& scope, double fallback);

/// Goes through the storyboard at the run's steps and enters what it sets.
void play_storyboard(ScenarioFile& scenario, const RoadNetwork* roads, EsminiRun& run);

}  // namespace vesper::roads
