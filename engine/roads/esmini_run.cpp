// Reading the table of a run, and what it says at times between its rows. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <new>
#include <optional>
#include <string_view>

#include "base/angle.h"
#include "base/error.h"
#include "base/lower.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "photometry/table.h"
#include "roads/esmini_run.h"

namespace vesper::roads {
namespace {

constexpr uint64_t kMaxEsminiBytes = 1ull << 30;
constexpr size_t kMaxRows = 20'000'000, kMaxEntities = 10'000, kMaxColumns = 100'000;

/// What is read, and what dat2csv calls it.
enum class Field : uint8_t {
    Time,
    Id,
    Name,
    X,
    Y,
    Z,
    H,
    P,
    R,
    Speed,
    BoxX,
    BoxY,
    BoxZ,
    BoxLength,
    BoxWidth,
    BoxHeight,
    Count
};
constexpr size_t kFields = static_cast<size_t>(Field::Count);
constexpr std::array<const char*, kFields> kFieldNames{"time", "id",        "name",     "x",        "y",    "z",
                                                       "h",    "p",         "r",        "speed",    "bb_x", "bb_y",
                                                       "bb_z", "bb_length", "bb_width", "bb_height"};

/// Where the columns of an entity are, by the names dat2csv has for them.
struct Columns {
    std::map<std::string, size_t, std::less<>> index;
    std::array<std::optional<size_t>, kFields> of{};  ///< the same by what is read
    size_t count = 0;                                 ///< fields that a row has at least
    size_t stride = 0;  ///< columns from one entity to the next in the same row; 0: a row for each entity

    void find_fields() {
        for (size_t i = 0; i < kFields; ++i)
            if (const auto found = index.find(kFieldNames[i]); found != index.end()) of[i] = found->second;
    }
};

/// What the CSV logger calls them, without number and unit.
constexpr std::array<std::pair<std::string_view, const char*>, 17> kLogged{{{"Entity_Name", "name"},
                                                                            {"Entitity_Name", "name"},
                                                                            {"Entity_ID", "id"},
                                                                            {"Entitity_ID", "id"},  // before 2.37.5
                                                                            {"World_Position_X", "x"},
                                                                            {"World_Position_Y", "y"},
                                                                            {"World_Position_Z", "z"},
                                                                            {"World_Heading_Angle", "h"},
                                                                            {"World_Pitch_Angle", "p"},
                                                                            {"World_Roll_Angle", "r"},
                                                                            {"Current_Speed", "speed"},
                                                                            {"bb_x", "bb_x"},
                                                                            {"bb_y", "bb_y"},
                                                                            {"bb_z", "bb_z"},
                                                                            {"bb_length", "bb_length"},
                                                                            {"bb_width", "bb_width"},
                                                                            {"bb_height", "bb_height"}}};

/// The header of the CSV logger: `Index [-], TimeStamp [s], #1 Entity_Name [-], ..., #2 Entity_Name [-], ...`.
std::optional<Columns> logged_header_of(const std::vector<std::string_view>& fields) {
    Columns columns;
    size_t last = 0;  // column of the first entity
    for (size_t i = 0; i < fields.size(); ++i) {
        const std::string_view name = photometry::trimmed(fields[i].substr(0, fields[i].find('[')));
        if (name == "TimeStamp") columns.index.try_emplace("time", i);
        if (name.starts_with("#2 ") && columns.stride == 0) columns.stride = i;
        if (!name.starts_with("#1 ")) continue;
        last = i;
        for (const auto& [logged, known] : kLogged)
            if (name.substr(3) == logged) columns.index.try_emplace(known, i);
    }
    const auto first = columns.index.find("name");
    if (first == columns.index.end() || !columns.index.contains("time")) return std::nullopt;
    columns.count = std::max(last, columns.index.at("time")) + 1;
    columns.stride = columns.stride > first->second ? columns.stride - first->second : last + 1 - first->second;
    return columns;
}

std::optional<Columns> header_of(std::string_view line) {
    constexpr std::string_view kByteOrder = "\xEF\xBB\xBF";
    if (line.starts_with(kByteOrder)) line.remove_prefix(kByteOrder.size());
    std::vector<std::string_view> fields = photometry::fields_of(line, ',', kMaxColumns);
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    Columns columns;
    for (const std::string_view field : fields) columns.index.try_emplace(std::string(field), columns.count++);
    if (columns.index.contains("time") && columns.index.contains("x")) return columns;
    return logged_header_of(fields);
}

RunEntity::Kind kind_by_name(const std::string& name) {
    const auto has = [kind = lower(name)](const char* word) { return kind.find(word) != kind.npos; };
    if (has("pedestrian") || has("walker")) return RunEntity::Kind::Pedestrian;
    if (has("truck") || has("semi")) return RunEntity::Kind::Truck;
    if (has("bus")) return RunEntity::Kind::Bus;
    if (has("bicycle") || has("cyclist") || has("bike")) return RunEntity::Kind::Bicycle;
    if (has("cone") || has("barrier") || has("obstacle")) return RunEntity::Kind::Object;
    return RunEntity::Kind::Car;
}

/// An empty cell, or the NaN that C's printf writes.
bool is_none(std::string_view cell) { return cell.empty() || cell == "nan" || cell == "-nan"; }

/// Rows of a table on their way to entities.
struct TableReader {
    const photometry::LineReader& lines;
    EsminiRun& run;
    std::map<int, size_t> by_id{};
    size_t rows = 0;

    /// One entity of a row, `shift` columns to the right of the first.
    void take(const Columns& columns, const std::vector<std::string_view>& fields, size_t shift) {
        if (++rows > kMaxRows) lines.fail("more than " + std::to_string(kMaxRows) + " rows");
        const auto text = [&](Field field) {
            return fields[*columns.of[static_cast<size_t>(field)] + (field == Field::Time ? 0 : shift)];
        };
        const auto refuse = [&](Field field, const char* reason) {
            const size_t column = *columns.of[static_cast<size_t>(field)] + (field == Field::Time ? 0 : shift) + 1;
            lines.fail("column " + std::to_string(column) + ": " + kFieldNames[static_cast<size_t>(field)] + " " +
                       photometry::quoted(text(field)) + reason);
        };
        const auto number = [&](Field field) {
            if (!columns.of[static_cast<size_t>(field)]) return 0.0;
            const auto value = photometry::number_of(text(field), false);
            if (!value || std::abs(*value) > 1e9) refuse(field, " is no number that can be");
            return *value;
        };
        // Some have no value: an empty cell, or none that a program could tell.
        const auto number_or_none = [&](Field field) {
            return columns.of[static_cast<size_t>(field)] && is_none(text(field)) ? 0.0 : number(field);
        };
        if (const double id = number(Field::Id); id != std::floor(id)) refuse(Field::Id, " is no whole number");
        const int id = static_cast<int>(number(Field::Id));
        const auto [found, is_new] = by_id.try_emplace(id, run.entities.size());
        if (is_new) {
            if (run.entities.size() >= kMaxEntities)
                lines.fail("more than " + std::to_string(kMaxEntities) + " entities");
            RunEntity entity;
            entity.name = photometry::readable(text(Field::Name));
            entity.id = id;
            entity.kind = kind_by_name(entity.name);
            const auto size = [&](Field field) { return std::max(0.0, number_or_none(field)); };
            entity.length = size(Field::BoxLength), entity.width = size(Field::BoxWidth),
            entity.height = size(Field::BoxHeight);
            entity.centre = {number_or_none(Field::BoxX), number_or_none(Field::BoxY), number_or_none(Field::BoxZ)};
            run.entities.push_back(std::move(entity));
        }
        RunPose pose;
        pose.time = number(Field::Time);
        pose.position = {number(Field::X), number(Field::Y), number(Field::Z)};
        pose.heading = number(Field::H), pose.pitch = number(Field::P), pose.roll = number(Field::R);
        pose.speed = number_or_none(Field::Speed);
        std::vector<RunPose>& poses = run.entities[found->second].poses;
        if (!poses.empty() && pose.time < poses.back().time)
            lines.fail("the times of '" + run.entities[found->second].name + "' do not ascend");
        if (!poses.empty() && pose.time == poses.back().time)
            poses.back() = pose;
        else
            poses.push_back(pose);
        run.duration = std::max(run.duration, pose.time);
    }
};

/// From the way between the rows before and after, where a table has no speeds.
void find_speeds(RunEntity& entity) {
    std::vector<RunPose>& poses = entity.poses;
    for (size_t i = 0; poses.size() > 1 && i < poses.size(); ++i) {
        const RunPose &a = poses[i > 0 ? i - 1 : 0], &b = poses[std::min(i + 1, poses.size() - 1)];
        const glm::dvec3 way = b.position - a.position;
        const double ahead = way.x * std::cos(poses[i].heading) + way.y * std::sin(poses[i].heading);
        poses[i].speed = std::copysign(glm::length(way) / (b.time - a.time), ahead);
    }
}

}  // namespace

EsminiRun read_esmini_run(const std::filesystem::path& file) try {
    EsminiRun run;
    const std::vector<uint8_t> bytes = io::read_file(file, kMaxEsminiBytes);
    photometry::LineReader lines(bytes, one_line(file.string()));
    std::optional<Columns> columns;
    TableReader reader{lines, run};
    while (const auto line = lines.next()) {
        if (photometry::trimmed(*line).empty()) continue;
        if (!columns) {
            columns = header_of(*line);
            // Some versions say first which files the run was made with.
            if (!columns && lines.line() > 20) break;
            if (!columns) continue;
            for (const char* needed : {"id", "name", "x", "y", "z", "h"})
                if (!columns->index.contains(needed))
                    lines.fail(std::string("the table has no column '") + needed + "'");
            columns->find_fields();
            continue;
        }
        const auto fields = photometry::fields_of(*line, ',', kMaxColumns);
        if (fields.size() < columns->count && columns->stride == 0)
            lines.fail(std::to_string(fields.size()) + " fields, " + std::to_string(columns->count) + " columns");
        // Entities that are gone leave a row of the CSV logger shorter, ones that came later make it longer than its
        // header.
        for (size_t shift = 0; fields.size() >= columns->count + shift; shift += columns->stride) {
            if (columns->stride > 0 && fields[*columns->of[static_cast<size_t>(Field::Name)] + shift].empty()) break;
            reader.take(*columns, fields, shift);
            if (columns->stride == 0) break;
        }
    }
    if (!columns)
        throw Error(one_line(file.string()) +
                    ": is no table of esmini: no line has the columns time, id, name, x, y, z, h of dat2csv, nor those "
                    "of its CSV logger");
    if (run.entities.empty())
        throw Error(one_line(file.string()) + ": no row of the table has all columns of an entity");
    if (!columns->index.contains("speed"))
        for (RunEntity& entity : run.entities) find_speeds(entity);
    return run;
} catch (const std::bad_alloc&) {
    throw OutOfHostMemory(one_line(file.string()) + ": not enough memory");
}

RunPose pose_at(const RunEntity& entity, double time) {
    const auto after = std::upper_bound(entity.poses.begin(), entity.poses.end(), time,
                                        [](double at, const RunPose& pose) { return at < pose.time; });
    if (after == entity.poses.begin()) return entity.poses.front();
    if (after == entity.poses.end()) return entity.poses.back();
    const RunPose &a = *(after - 1), &b = *after;
    const double f = (time - a.time) / (b.time - a.time);
    RunPose pose;
    pose.time = time;
    pose.position = glm::mix(a.position, b.position, f);
    pose.heading = mix_angles(a.heading, b.heading, f), pose.pitch = mix_angles(a.pitch, b.pitch, f),
    pose.roll = mix_angles(a.roll, b.roll, f);
    pose.speed = glm::mix(a.speed, b.speed, f);
    return pose;
}

}  // namespace vesper::roads
