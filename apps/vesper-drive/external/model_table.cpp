#include "external/model_table.h"

#include "base/error.h"
#include "base/lower.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "scene/json_value.h"
#include "scene/uri.h"

namespace vesper::drive {
namespace {

constexpr uint64_t kMostBytes = 1 << 20;
constexpr size_t kMostModels = 100, kMostPlaces = 200;

}  // namespace

bool Model::is_meant_by(const std::string& model_reference) const {
    const std::string wanted = lower(reference), text = lower(model_reference);
    // The last * that was met, and the text behind what it stands for, to try again from there.
    size_t w = 0, t = 0, star = wanted.npos, after = 0;
    while (t < text.size()) {
        if (w < wanted.size() && wanted[w] == '*')
            star = w++, after = t;
        else if (w < wanted.size() && wanted[w] == text[t])
            ++w, ++t;
        else if (star != wanted.npos)
            w = star + 1, t = ++after;
        else
            return false;
    }
    return wanted.find_first_not_of('*', w) == wanted.npos;
}

std::vector<Model> read_models(const std::filesystem::path& file) {
    const scene::JsonFile json = scene::parse_json(io::read_file(file, kMostBytes), file.string());
    const scene::JsonValue root(json);
    root.allow_only({"$schema", "version", "models"});
    if (root.at("version").integer() != 1) root.at("version").fail("this version of Vesper reads models of version 1");
    const auto beside = [&](const scene::JsonValue& name) {
        try {
            return scene::resolve_uri(file.parent_path(), name.text());
        } catch (const Error& error) {
            name.fail(error.what());
        }
    };
    std::vector<Model> models;
    for (const scene::JsonValue& value : root.at("models").elements()) {
        value.allow_only({"reference", "scene", "photometry", "front", "places", "lamps"});
        Model model{.place = one_line(file.string()) + ": /models/" + std::to_string(models.size()),
                    .reference = value.at("reference").text(),
                    .scene = beside(value.at("scene"))};
        if (const auto photometry = value.find("photometry")) model.photometry = beside(*photometry);
        model.turn = traffic::read_front(value);
        model.places = value.integer_or("places", model.places, kMostPlaces);
        if (const auto lamps = value.find("lamps")) model.roles = traffic::read_roles(*lamps);
        models.push_back(std::move(model));
    }
    if (models.size() > kMostModels) root.at("models").fail("more than " + std::to_string(kMostModels));
    return models;
}

}  // namespace vesper::drive
