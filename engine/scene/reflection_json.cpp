// Reflection tables in JSON. SPDX-License-Identifier: MIT
#include "scene/reflection_json.h"

#include "base/error.h"
#include "io/named_file.h"

namespace vesper::scene {
namespace {

constexpr double kMaxQ0 = 10;  // 1/sr

std::vector<double> numbers_from_zero(const JsonValue& list) {
    std::vector<double> numbers;
    for (const JsonValue& element : list.elements()) numbers.push_back(element.number(0));
    return numbers;
}

}  // namespace

photometry::ReflectionTable read_named_table(const JsonValue& holder, const std::filesystem::path& folder) {
    const JsonValue name = holder.at("reflection_table");
    const auto q0 = holder.find("q0");
    const double wanted = q0 ? q0->number(0.001, kMaxQ0) : 0;
    if (name.text().empty()) name.fail("must not be empty");
    try {
        io::named_file(folder, name.text());  // refuses others
        const photometry::ReflectionTable table = photometry::find_reflection_table(name.text(), folder);
        return q0 ? photometry::rescaled(table, wanted) : table;
    } catch (const Error& error) {
        name.fail(error.what());
    }
}

nlohmann::json json_of(const photometry::ReflectionTable& table) {
    nlohmann::json json = {
        {"name", table.name}, {"tan_gamma", table.tan_gamma}, {"beta_deg", table.beta}, {"r", table.r}};
    if (table.stated_q0 > 0) json["q0"] = table.stated_q0;
    if (table.wet) json["wet"] = true;
    return json;
}

photometry::ReflectionTable read_whole_table(const JsonValue& source) {
    source.allow_only({"name", "q0", "tan_gamma", "beta_deg", "r", "wet"});
    photometry::ReflectionTable table{.name = source.text_or("name", "")};
    table.stated_q0 = source.number_or("q0", 0, 0, 100);
    table.wet = source.boolean_or("wet", false);
    table.tan_gamma = numbers_from_zero(source.at("tan_gamma"));
    table.beta = numbers_from_zero(source.at("beta_deg"));
    table.r = numbers_from_zero(source.at("r"));
    photometry::check_reflection_table(table, source.place());
    return table;
}

}  // namespace vesper::scene
