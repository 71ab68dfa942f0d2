// OpenSCENARIO files: parameters and catalogs. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/decimal.h"
#include "base/error.h"
#include "io/named_file.h"
#include "io/read_file.h"
#include "photometry/table.h"
#include "roads/esmini_parts.h"

namespace vesper::roads {
namespace {

constexpr uint64_t kMaxScenarioBytes = 64ull << 20;
constexpr size_t kMaxCatalogs = 500;

std::unique_ptr<XmlFile> read_xml(const std::filesystem::path& path) {
    const std::vector<uint8_t> bytes = io::read_file(path, kMaxScenarioBytes);
    return std::make_unique<XmlFile>(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                                     path.string());
}

}  // namespace

std::optional<std::string> resolved(const XmlElement& element, const char* attribute, const Parameters& scope) {
    const auto text = element.attribute(attribute);
    if (!text) return std::nullopt;
    if ((*text)[0] != '$') return std::string(*text);
    if (text->starts_with("${") && text->ends_with("}")) {
        const auto value = expression_value(text->substr(2, text->size() - 3), scope);
        if (!value)
            element.fail(std::string(attribute) + " " + photometry::quoted(*text) +
                         " is no expression of known parameters");
        return decimal(*value, 17);
    }
    const auto found = scope.find(text->substr(1));
    if (found == scope.end())
        element.fail(std::string(attribute) + ": there is no parameter " + photometry::quoted(*text));
    return found->second;
}

bool flag_in(const XmlElement& element, const char* attribute, const Parameters& scope) {
    const std::string text = resolved(element, attribute, scope).value_or("");
    return text == "true" || text == "1";
}

double number_in(const XmlElement& element, const char* attribute, const Parameters& scope, double fallback) {
    const auto text = resolved(element, attribute, scope);
    if (!text) return fallback;
    const auto value = photometry::number_of(*text, false);
    if (!value || std::abs(*value) > kMaxNumber)
        element.fail(std::string(attribute) + " " + photometry::quoted(*text) + " is no number that can be");
    return *value;
}

Parameters declared(const XmlElement& element, const Parameters& around) {
    Parameters made = around;
    for (const XmlElement& each : element.children_of("ParameterDeclarations", "ParameterDeclaration")) {
        const std::string name = each.text_or("name", "");
        if (const auto value = resolved(each, "value", made))
            made.insert_or_assign(name.starts_with('$') ? name.substr(1) : name, *value);
    }
    return made;
}

ScenarioFile::ScenarioFile(const std::filesystem::path& file) : folder_(file.parent_path()), file_(read_xml(file)) {
    if (root().name() != "OpenSCENARIO") root().fail("the root of an OpenSCENARIO file must be OpenSCENARIO");
    parameters_ = declared(root(), {});
}

void ScenarioFile::look_for_catalogs() {
    looked_ = true;
    const auto locations = root().child("CatalogLocations");
    if (!locations) return;
    std::vector<std::filesystem::path> files;
    for (const XmlElement& location : locations->children())
        for (const XmlElement& directory : location.children("Directory")) {
            const auto path = resolved(directory, "path", parameters_);
            if (!path) continue;
            std::filesystem::path named;
            try {
                named = io::named_file(folder_, *path);
            } catch (const Error& error) {
                directory.fail(error.what());
            }
            std::error_code none;
            if (std::filesystem::is_regular_file(named, none)) files.push_back(named);
            for (std::filesystem::directory_iterator entry(named, none), end; !none && entry != end;
                 entry.increment(none))
                if (entry->path().extension() == ".xosc") files.push_back(entry->path());
        }
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    if (files.size() > kMaxCatalogs) locations->fail("name more than " + std::to_string(kMaxCatalogs) + " catalogs");
    for (const auto& file : files) {
        catalogs_.push_back(read_xml(file));
        for (const XmlElement& catalog : catalogs_.back()->root().children("Catalog")) {
            const std::string_view name = catalog.attribute("name").value_or("");
            for (const XmlElement& each : catalog.children()) {
                const std::string_view entry = each.attribute("name").value_or("");
                for (const std::string_view of : {name, std::string_view()})
                    for (const std::string_view called : {entry, std::string_view()})
                        entries_.try_emplace({of, called}, each);
            }
        }
    }
}

std::optional<ScenarioFile::Entry> ScenarioFile::find(const XmlElement& reference, const Parameters& scope) {
    if (!looked_) look_for_catalogs();
    const std::string catalog = resolved(reference, "catalogName", scope).value_or(""),
                      entry = resolved(reference, "entryName", scope).value_or("");
    const auto found = entries_.find({catalog, entry});
    if (found == entries_.end()) return std::nullopt;
    Parameters parameters = declared(found->second, parameters_);
    for (const XmlElement& assignment : reference.children_of("ParameterAssignments", "ParameterAssignment")) {
        const std::string name = assignment.text_or("parameterRef", "");
        if (const auto value = resolved(assignment, "value", scope))
            parameters.insert_or_assign(name.starts_with('$') ? name.substr(1) : name, *value);
    }
    return Entry{found->second, std::move(parameters)};
}

}  // namespace vesper::roads
